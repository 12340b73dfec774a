# A skill's name that equals every skill, and an object's that hashes like one.
# expect: SketchContractError: step 0, pick: item is 'nonsense', expected the name of an object; there is object_0, object_1
# answer: program
class Name(str):
    __hash__ = str.__hash__
    def __eq__(self, other):
        return True
    def __repr__(self):
        return "\x1b[2J" * 10**6

def gen_plan(state):
    return [Action(Name("pick"), [Name("nonsense"), Pose(1, 2, 3)])]
