# Structural pattern matching on objects, tuples and numbers.
# expect: plan: draw_line(50, 50, 20, 70)
# answer: program
def place(o):
    match o:
        case Obstacle(name="object_0", x=x, y=y):
            return (x, y)
        case Obstacle(x=x) if x < 30:
            return x, o.y
        case _:
            raise ValueError(o)

def gen_plan(state):
    match [place(o) for o in state.obstacles]:
        case [(a, b), (c, d)]:
            return [Action("draw_line", [a, b, c, d])]
