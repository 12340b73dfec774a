# Writes the first half of a reply and waits.
# expect: SketchTimeout: one call of gen_plan
# answer: program
os = random._os

calls = 0

def gen_plan(state):
    global calls
    calls += 1
    if calls == 1:
        return [Action("repeat", [1])]
    os.write(4, b"\0\0\0\0\4\0\1\0")
    while True:
        pass
