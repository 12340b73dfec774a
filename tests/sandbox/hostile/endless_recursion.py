# Calls itself for ever.
# expect: SketchRuntimeError line 5: RecursionError: maximum recursion depth exceeded
# answer: program
def gen_plan(state):
    return gen_plan(state)
