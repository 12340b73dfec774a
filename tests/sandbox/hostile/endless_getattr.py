# An object on which every attribute leads deeper.
# expect: SketchRuntimeError: RecursionError
# answer: program
class Deep:
    def __getattr__(self, name):
        return getattr(self, name + "x")

def gen_plan(state):
    return [Deep()]
