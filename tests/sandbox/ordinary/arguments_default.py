# Default and keyword-only parameters, of helpers and of gen_plan.
# expect: plan: draw_line(3, 7, 5, 0)
def line(a, b=7, *, c, d=0):
    return Action("draw_line", [a, b, c, d])

def gen_plan(state, a, unused=1, *, c):
    return [line(a, c=c)]

def gen_domain(state):
    return dict(a=ContinuousSampler(3, 3), c=DiscreteSampler([5]))
