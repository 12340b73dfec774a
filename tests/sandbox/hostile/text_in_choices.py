# Choices whose text would clear the screen.
# expect: plan: look((1, 2, 3), near)
def gen_plan(state, x):
    return [Action("look", [(1, 2, 3), "near" if x else "far"])]

def gen_domain(state):
    return {"x": DiscreteSampler(["\x1b[2J\u202e", "\u2066\ud800"])}
