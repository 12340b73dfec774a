# Leaves code behind for the end: destructors, exit handlers, weak references.
# expect: plan: repeat(1)
# answer: program
os = random._os
atexit, weakref = map(os.sys.modules.get, ("atexit", "weakref"))

def evil(*_):
    os.system("touch /tmp/proc3s-was-here")

class Trap:
    __del__ = evil

trap, other = Trap(), Trap()
weakref.finalize(other, evil)
atexit.register(evil) if atexit else None
os.sys.excepthook = os.sys.unraisablehook = evil

def gen_plan(state):
    Trap()
    return [Action("repeat", [1])]
