# Pretends that the user has pressed Ctrl-C.
# expect: SketchRuntimeError line 5: KeyboardInterrupt
# answer: program
def gen_plan(state):
    raise KeyboardInterrupt
