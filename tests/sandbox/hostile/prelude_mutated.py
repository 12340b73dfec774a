# Changes the classes of the state and the constants between samples.
# expect: plan: draw_line(50, 50, 1, 1)
# answer: program
def gen_plan(state):
    o = state.obstacles[0]
    Obstacle.__repr__ = Scene.__len__ = lambda self: 1 / 0
    Obstacle.extra, Action.extra = 1, 2
    state.obstacles.clear()
    globals()["CANVAS"] = None
    globals()["gen_plan"] = lambda state: []
    return [Action("draw_line", [o.x, o.y, 1, 1])]
