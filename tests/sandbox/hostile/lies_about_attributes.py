# An Action whose name and values are never the same twice.
# expect: plan: repeat(3)
# answer: program
import itertools
names = itertools.cycle(["repeat", "\x1b[2J"])

class Fickle:
    params = property(lambda self: [3])
    @property
    def name(self):
        return next(names)

def gen_plan(state):
    next(names), next(names)
    action = Fickle()
    if action.name != "repeat":
        return [action]
    next(names)
    return [action]
