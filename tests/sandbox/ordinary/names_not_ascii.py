# Names and texts in the letters of mathematics and of other languages.
# expect: plan: draw_line(51, 50, 0, 0)
# log: größer als π – 三角形 ✓
def gen_plan(state, θ, größe):
    print("größer als π – 三角形 ✓")
    Δx = größe * math.cos(θ)
    return [Action("draw_line", [state.obstacles[0].x + Δx, state.obstacles[0].y, 0, 0])]

def gen_domain(state):
    return {"θ": ContinuousSampler(0, 0), "größe": ContinuousSampler(1, 1)}
