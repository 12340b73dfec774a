# Walks up the stack to the server and lifts its limits.
# expect: SketchCrash: a plan has the wrong size
# answer: program
sys = random._os.sys

calls = 0

def gen_plan(state):
    global calls
    calls += 1
    if calls == 1:
        return [Action("repeat", [1])]
    frame = sys._getframe()
    while "encode" not in frame.f_locals:
        frame = frame.f_back
    frame.f_locals["self"].program.encoder.longest = 10**9
    return [Action("repeat", [1])] * 5000
