# Copies the state before it plans ahead on the copy.
# expect: plan: draw_line(50, 50, 51, 50)
# answer: program
import copy

def gen_plan(state):
    ahead = copy.deepcopy(state)
    ahead.obstacles[0].x += 1
    now, then = state.obstacles[0], copy.copy(ahead.obstacles[0])
    return [Action("draw_line", [now.x, now.y, then.x, then.y])]
