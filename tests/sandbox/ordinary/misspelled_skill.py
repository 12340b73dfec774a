# Misspells a skill: the message knows which was meant.
# expect: SketchContractError line 4: step 0: unknown skill 'drawline'; did you mean 'draw_line'?
def gen_plan(state, x):
    return [Action("drawline", [0, 0, x, 0])]

def gen_domain(state):
    return {"x": ContinuousSampler(0, 1)}
