# A parameter whose name nobody can see: a letter to Python, blank to a reader.
# expect: SketchCrash: a reply is not what it should be
def gen_plan(state, ᅟ):
    return [Action("repeat", [1])]

def gen_domain(state):
    return {"ᅟ": ContinuousSampler(0, 1)}
