# Follows a null pointer.
# expect: SketchCrash line 7: SIGSEGV
# answer: program
ctypes = random._os.sys.modules["ctypes"]

def gen_plan(state):
    return ctypes.string_at(0)
