# Finds the server among all objects and teaches it a skill.
# expect: SketchCrash: a plan does not fit its skills
# answer: program
gc = random._os.sys.modules["gc"]

calls = 0

def gen_plan(state):
    global calls
    calls += 1
    if calls == 1:
        return [Action("repeat", [1])]
    gc.unfreeze()
    for found in gc.get_objects():
        if type(found).__name__ == "Encoder":
            found._fast["teleport"] = (99, 1, None)
    return [Action("teleport", [1])]
