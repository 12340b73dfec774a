# Loops for ever.
# expect: SketchTimeout line 4: one call of gen_plan took longer
def gen_plan(state, x):
    while True: x += 1

def gen_domain(state):
    return {"x": ContinuousSampler(0, 1)}
