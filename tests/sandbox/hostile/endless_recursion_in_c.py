# Calls itself until the C stack is used up.
# expect: SketchCrash: SIGSEGV
# answer: program
random._os.sys.setrecursionlimit(10**9)

class Nested:
    def __repr__(self):
        return repr([self])

def gen_plan(state):
    return repr(Nested())
