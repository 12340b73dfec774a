# Generators that yield from one another; the plan itself is one.
# expect: plan: repeat(1); repeat(2); repeat(3)
# answer: program
def numbers(n):
    if n:
        yield from numbers(n - 1)
        yield n

def gen_plan(state):
    yield from (Action("repeat", [n]) for n in numbers(3))
