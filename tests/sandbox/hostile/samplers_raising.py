# A sampler that raises when it is looked at.
# expect: SketchRuntimeError line 6: ZeroDivisionError
class Sampler(ContinuousSampler):
    @property
    def min(self):
        1 / 0
    @min.setter
    def min(self, value):
        pass

def gen_plan(state, x):
    return [Action("repeat", [1])]

def gen_domain(state):
    return {"x": Sampler(0, 1)}
