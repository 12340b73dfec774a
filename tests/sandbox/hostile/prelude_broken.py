# Breaks the constructor of the state, which the server calls for every sample.
# expect: SketchRuntimeError line 6: ZeroDivisionError
# answer: program
def gen_plan(state):
    def init(self, *args, **kwargs):
        1 / 0
    Scene.__init__ = init
    raise ValueError if init(None) else ""
