def gen_plan(initial, at):
    return [Action("put", [at])]


def gen_domain(initial):
    return {"at": ContinuousSampler(-0.0002, 0.0002)}
