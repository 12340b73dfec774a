# Answers a sample that nobody has asked for yet.
# expect: SketchCrash: a reply is out of order
# answer: program
os = random._os

calls = 0

def gen_plan(state):
    global calls
    calls += 1
    if calls == 1:
        return [Action("repeat", [1])]
    os.write(4, b"\7\0\0\0\4\0\1\0\0\0\0\0")
    return [Action("repeat", [1])]
