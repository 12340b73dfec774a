# Uses a skill that does not exist.
# expect: SketchCrash: a plan does not fit its skills
# answer: program
os, struct = random._os, random._os.sys.modules["struct"]

calls = 0

def gen_plan(state):
    global calls
    calls += 1
    if calls == 1:
        return [Action("repeat", [1])]
    for sample in range(3):
        os.write(4, struct.pack("<IHHIBd", sample, 4, 1, 9, 200, 1.0))
    while True:
        pass
