# Yields actions without end.
# expect: SketchContractError: the plan has more than 500 actions
# answer: program
def gen_plan(state):
    while True:
        yield Action("repeat", [1])
