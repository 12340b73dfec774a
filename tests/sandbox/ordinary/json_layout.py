# A layout written as JSON in the program.
# expect: plan: draw_line(1.5, 2, 3, 4)
# answer: program
import json

LAYOUT = json.loads('{"lines": [[1.5, 2, 3, 4]]}')

def gen_plan(state):
    assert json.loads(json.dumps(LAYOUT)) == LAYOUT
    return [Action("draw_line", line) for line in LAYOUT["lines"]]
