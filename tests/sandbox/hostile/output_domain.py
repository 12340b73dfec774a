# Returns a domain of a hundred thousand entries.
# expect: SketchContractError: gen_domain names 'p0', which is no parameter of gen_plan
def gen_plan(state):
    return [Action("repeat", [1])]

def gen_domain(state):
    return {f"p{i}": ContinuousSampler(0, 1) for i in range(10**5)}
