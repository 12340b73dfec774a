# scene: count=100 smallest=1 largest=2
def gen_plan(
    initial,
    x0, y0, turn0, length0,
    x1, y1, turn1, length1,
    x2, y2, turn2, length2,
    x3, y3, turn3, length3,
    x4, y4, turn4, length4,
    x5, y5, turn5, length5,
    x6, y6, turn6, length6,
    x7, y7, turn7, length7,
    x8, y8, turn8, length8,
    x9, y9, turn9, length9,
):
    strokes = [
        (x0, y0, turn0, length0),
        (x1, y1, turn1, length1),
        (x2, y2, turn2, length2),
        (x3, y3, turn3, length3),
        (x4, y4, turn4, length4),
        (x5, y5, turn5, length5),
        (x6, y6, turn6, length6),
        (x7, y7, turn7, length7),
        (x8, y8, turn8, length8),
        (x9, y9, turn9, length9),
    ]
    return [
        Action("draw_line", [x, y, x + length * math.cos(turn), y + length * math.sin(turn)])
        for x, y, turn, length in strokes
    ]


def gen_domain(initial):
    domain = {}
    for k in range(10):
        domain[f"x{k}"] = domain[f"y{k}"] = ContinuousSampler(0, CANVAS_SIZE)
        domain[f"turn{k}"] = ContinuousSampler(0, 2 * math.pi)
        domain[f"length{k}"] = ContinuousSampler(3, 10)
    return domain
