# Sends printed text without end instead of a plan.
# expect: SketchCrash: a reply is of an unknown kind
# answer: program
os, struct = random._os, random._os.sys.modules["struct"]

calls = 0

def gen_plan(state):
    global calls
    calls += 1
    if calls == 1:
        return [Action("repeat", [1])]
    while True:
        os.write(4, struct.pack("<IHHI", 0, 6, 0, 2) + b'""')
