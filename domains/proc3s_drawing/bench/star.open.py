def gen_plan(initial, center_x, center_y, radius, turn):
    points = []
    for k in range(5):
        angle = turn + 4 * math.pi * k / 5
        points.append((center_x + radius * math.cos(angle), center_y + radius * math.sin(angle)))
    points.append(points[0])
    return [Action("draw_line", [*a, *b]) for a, b in zip(points, points[1:])]


def gen_domain(initial):
    return {
        "center_x": ContinuousSampler(8, 92),
        "center_y": ContinuousSampler(8, 92),
        "radius": ContinuousSampler(24, 40),
        "turn": ContinuousSampler(0, 2 * math.pi / 5),
    }
