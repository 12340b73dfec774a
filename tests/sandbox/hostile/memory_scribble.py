# Overwrites the interpreter's own objects.
# expect: SketchCrash: process died
# answer: program
ctypes = random._os.sys.modules["ctypes"]

def gen_plan(state):
    for kind in (list, dict, str, int, tuple, bytes):
        ctypes.memset(id(kind) + 16, 0xFF, 300)
    return [Action("repeat", [1])]
