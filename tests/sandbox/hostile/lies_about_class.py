# Claims to be a number, an Action, a list.
# expect: SketchRuntimeError: TypeError: float() argument must be a string or a real number
# answer: program
class Liar:
    __class__ = float
    def __eq__(self, other):
        return True
    def __hash__(self):
        return hash("repeat")
    def __len__(self):
        return 1
    def __getattr__(self, name):
        return self

def gen_plan(state):
    return [Action("repeat", [Liar()])]
