# Gives a sampler values without end.
# expect: SketchContractError line 8: gen_domain: x has more than 1000 values
import itertools
def gen_plan(state, x):
    return [Action("repeat", [1])]

def gen_domain(state):
    return {"x": DiscreteSampler(itertools.count())}
