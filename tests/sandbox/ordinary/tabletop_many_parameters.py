# One parameter an object, with names made in a loop.
# scene: tabletop
# expect: plan: push(0.1, 0.2, 0.3)
def gen_plan(initial, a_x, a_y, a_z, mode="slow", tries=3, flip=False):
    assert isinstance(tries, int) and isinstance(flip, bool) and mode in ("slow", "fast")
    return [Action("push", [a_x, a_y, a_z])]

def gen_domain(initial):
    domain = {f"a_{axis}": ContinuousSampler(v, v) for axis, v in zip("xyz", (0.1, 0.2, 0.3))}
    domain |= {"mode": DiscreteSampler(["slow", "fast"]), "tries": DiscreteSampler(range(3))}
    domain["flip"] = DiscreteSampler([True, False])
    return domain
