# Aborts.
# expect: SketchCrash line 5: process died
# answer: program
def gen_plan(state):
    random._os.abort()
