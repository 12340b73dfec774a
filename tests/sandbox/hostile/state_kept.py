# Keeps the state of the first call and hands it on: later calls get a new one.
# expect: plan: draw_line(50, 51, 2, 1)
# answer: program
seen = []
def gen_plan(state):
    seen.append(state)
    for old in seen:
        old.obstacles[0].x += 1
        old.obstacles.pop() if len(old.obstacles) > 2 else None
    new = seen[-1].obstacles[0]
    seen[-1].obstacles = [new, None, None]
    return [Action("draw_line", [new.y, new.x, 2, 1])]
