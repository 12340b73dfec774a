# Constants of its own beside those of the domain.
# expect: plan: draw_line(10, 90, 90, 90)
MARGIN = 0.1 * CANVAS
LEFT, RIGHT = MARGIN, CANVAS - MARGIN
SIDES = {"top": RIGHT, "bottom": LEFT}

def gen_plan(state, side):
    return [Action("draw_line", [LEFT, SIDES[side], RIGHT, SIDES[side]])]

def gen_domain(state):
    return {"side": DiscreteSampler(["top"])}
