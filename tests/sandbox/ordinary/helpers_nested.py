# Nested functions with nonlocal variables, closures, and a helper below its user.
# expect: plan: repeat(1); repeat(2); repeat(3)
# answer: program
def gen_plan(state):
    count = 0

    def step():
        nonlocal count
        count += 1
        return make(count)

    return [step() for _ in range(3)]

def make(n):
    return Action("repeat", [n])
