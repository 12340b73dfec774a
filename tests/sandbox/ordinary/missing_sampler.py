# Forgets a parameter in gen_domain.
# expect: SketchContractError line 3: parameter 'y' of gen_plan has no sampler in gen_domain
def gen_plan(state, x, y):
    return [Action("draw_line", [0, 0, x, y])]

def gen_domain(state):
    return {"x": ContinuousSampler(0, 1)}
