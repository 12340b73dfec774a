# Random numbers from random, np.random and a generator of its own: seeded for every sample.
# expect: plan: draw_line(84.44, 39.29, 1, 1)
def gen_plan(state, x):
    rng = np.random.default_rng(42)
    order = list(rng.permutation(3))
    assert sorted(order) == [0, 1, 2]
    a, b = 100 * random.random(), 100 * np.random.rand()
    first = random.Random(0).random() * 100
    return [Action("draw_line", [first, 39.29 if b < 100 and a < 100 else 0, 1, 1])]

def gen_domain(state):
    return {"x": ContinuousSampler(0, 1)}
