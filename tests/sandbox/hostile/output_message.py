# Raises an exception with a message of ten megabytes.
# expect: SketchRuntimeError line 5: ValueError: yyyyyyyyyy
# answer: program
def gen_plan(state):
    raise ValueError("y" * 10**7)
