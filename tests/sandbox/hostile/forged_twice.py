# Answers its own sample before the server does.
# expect: SketchCrash: tampered with its process
# answer: program
os, struct = random._os, random._os.sys.modules["struct"]

calls = 0

def gen_plan(state):
    global calls
    calls += 1
    if calls == 1:
        return [Action("repeat", [1])]
    os.write(4, struct.pack("<IHHIBd", 0, 4, 1, 9, 1, 1.0))
    return [Action("repeat", [1])]
