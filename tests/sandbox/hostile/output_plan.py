# Returns a plan of ten million actions.
# expect: SketchContractError: the plan has more than 500 actions
# answer: program
def gen_plan(state):
    return [Action("repeat", [1])] * 10**7
