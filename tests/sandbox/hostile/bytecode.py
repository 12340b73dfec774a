# Runs bytecode that no compiler makes.
# expect: SketchCrash: process died
# answer: program
def gen_plan(state):
    pass

gen_plan.__code__ = gen_plan.__code__.replace(co_code=bytes([151, 0]) + bytes([1, 0]) * 5000 + bytes([83, 0]), co_stacksize=1)
