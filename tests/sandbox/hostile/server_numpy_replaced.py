# Replaces numpy's functions for all who come after: that is only itself.
# expect: plan
def gen_plan(state, x):
    np.array = np.zeros = np.linalg.norm = np.float64 = None
    random.random = lambda: 0.5
    math.sqrt = math.pi = "three"
    return [Action("draw_line", [x, x, 1, 1])]

def gen_domain(state):
    return {"x": ContinuousSampler(0, 100)}
