# gen_plan is an object that can be called.
# expect: plan: repeat(4)
class Planner:
    def __init__(self, times):
        self.times = times

    def __call__(self, state):
        return [Action("repeat", [self.times])]

gen_plan = Planner(4)

def gen_domain(state):
    return {}
