# Leaves without a word.
# expect: SketchCrash: process died (exit code 0)
# answer: program
def gen_plan(state):
    random._os._exit(0)
