# Points of a line on the table, as tuples, lists and arrays.
# scene: tabletop
# expect: plan: move((-0.3, -0.5, 0.1)); move((0, -0.5, 0.1)); push(0.3, -0.5, 0.1)
def gen_plan(initial, height):
    (low, high), y = TABLE_BOUNDS[0], TABLE_CENTER[1]
    xs = np.linspace(low, high, 3)
    return [
        Action("move", [(xs[0], y, height)]),
        Action("move", [np.array([xs[1], y, height])]),
        Action("push", [xs[2], y, height]),
    ]

def gen_domain(initial):
    return {"height": ContinuousSampler(0.1, 0.1)}
