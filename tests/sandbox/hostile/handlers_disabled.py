# Switches off the report of crashes, then crashes.
# expect: SketchCrash: SIGSEGV
# answer: program
modules = random._os.sys.modules

def gen_plan(state):
    modules["faulthandler"].disable()
    modules["faulthandler"].unregister(10)
    modules["ctypes"].string_at(0)
