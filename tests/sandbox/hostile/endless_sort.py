# Sorts what does not let itself be compared.
# expect: SketchTimeout line 6: one call of gen_plan took longer
# answer: program
class Key:
    def __lt__(self, other):
        return sum(range(10**9)) < 0

def gen_plan(state):
    return sorted([Key(), Key()])
