def gen_plan(initial, left, bottom, height, width, dip, x0, y0, x1, y1, x2, y2, x3, y3, x4, y4):
    right, top = left + width, bottom + height
    corners = [(left, bottom), (left, top), (left + width / 2, top - dip), (right, top), (right, bottom)]
    moves = [(x0, y0), (x1, y1), (x2, y2), (x3, y3), (x4, y4)]
    points = [(x + dx, y + dy) for (x, y), (dx, dy) in zip(corners, moves)]
    return [Action("draw_line", [*a, *b]) for a, b in zip(points, points[1:])]


def gen_domain(initial):
    moves = {f"{axis}{k}": ContinuousSampler(-4, 4) for k in range(5) for axis in "xy"}
    return {
        "left": ContinuousSampler(4, 70),
        "bottom": ContinuousSampler(4, 70),
        "height": ContinuousSampler(20, 60),
        "width": ContinuousSampler(20, 50),
        "dip": ContinuousSampler(10, 30),
        **moves,
    }
