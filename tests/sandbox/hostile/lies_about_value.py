# A number that is another one each time it is asked.
# expect: SketchContractError line 18: step 0, draw_line: y2 is nan, expected a finite number
# answer: program
class Changing(float):
    asked = 0
    def __float__(self):
        Changing.asked += 1
        return float("nan") if Changing.asked > 1 else 1.0

class Numeric:
    def __float__(self):
        return float("nan")

modules = random._os.sys.modules
modules["numbers"].Real.register(Numeric)

def gen_plan(state):
    return [Action("draw_line", [Changing(1), 1, 1, Numeric()])]
