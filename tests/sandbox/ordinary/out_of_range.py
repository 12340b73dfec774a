# Leaves the canvas in some samples: the message names step, skill, parameter and range.
# expect: SketchContractError: step 1, draw_line: x2 must lie between 0 and 100
def gen_plan(state, x):
    return [Action("repeat", [1]), Action("draw_line", [0, 0, x, 0])]

def gen_domain(state):
    return {"x": ContinuousSampler(101, 200)}
