# Leaves by sys.exit.
# expect: SketchRuntimeError line 5: SystemExit: 0
# answer: program
def gen_plan(state):
    random._os.sys.exit(0)
