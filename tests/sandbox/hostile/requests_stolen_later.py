# Reads the rows of later samples before the server does.
# expect: SketchTimeout line 13: one call of gen_plan
# answer: program
os = random._os

calls = 0

def gen_plan(state):
    global calls
    calls += 1
    if calls == 1:
        return [Action("repeat", [1])]
    os.read(3, 10)
