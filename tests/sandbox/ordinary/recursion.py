# Recursion with a cache.
# expect: plan: repeat(8)
# answer: program
from functools import lru_cache

@lru_cache(maxsize=None)
def fibonacci(n):
    return n if n < 2 else fibonacci(n - 1) + fibonacci(n - 2)

def gen_plan(state):
    return [Action("repeat", [fibonacci(6)])]
