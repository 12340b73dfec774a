# Pretends to have a million parameters.
# expect: SketchContractError: gen_plan has 999 parameters, at most 256 are possible
import functools
inspect = random._os.sys.modules["inspect"]

def gen_plan(state):
    return [Action("repeat", [1])]

kind = inspect.Parameter.POSITIONAL_OR_KEYWORD
gen_plan.__signature__ = inspect.Signature([inspect.Parameter(f"p{i}", kind) for i in range(1000)])

def gen_domain(state):
    return {}
