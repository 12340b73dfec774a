# Prints a gigabyte.
# expect: plan: repeat(1)
# answer: program
def gen_plan(state):
    for _ in range(100):
        print("x" * 10**6)
    return [Action("repeat", [1])]
