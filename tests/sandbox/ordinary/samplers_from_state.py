# Samplers made by lambdas and comprehensions, from the state.
# expect: plan: draw_line(50, 20, 2, 3)
near = lambda value: ContinuousSampler(value, value)

def gen_plan(state, x_0, x_1, pick):
    return [Action("draw_line", [x_0, x_1, *pick_pair(pick)])]

def pick_pair(index):
    return [(2, 3), (4, 5)][index]

def gen_domain(state):
    domain = {f"x_{i}": near(o.x) for i, o in enumerate(state.obstacles)}
    domain.update(pick=DiscreteSampler([0]))
    return domain
