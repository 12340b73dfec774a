def gen_plan(initial, first, second, spare, turn):
    a, b = initial.obstacles[first], initial.obstacles[second]
    x, y = (a.x_pos + b.x_pos) / 2, (a.y_pos + b.y_pos) / 2
    radius = math.dist((a.x_pos, a.y_pos), (b.x_pos, b.y_pos)) / 2 + max(a.radius, b.radius) + spare
    corners = []
    for k in range(16):
        angle = turn + 2 * math.pi * k / 16
        corners.append((x + radius * math.cos(angle), y + radius * math.sin(angle)))
    return [Action("draw_line", [*corners[k - 1], *corners[k]]) for k in range(16)]


def gen_domain(initial):
    count = len(initial.obstacles)
    return {
        "first": DiscreteSampler(list(range(count // 2))),
        "second": DiscreteSampler(list(range(count // 2, count))),
        "spare": ContinuousSampler(1, 12),
        "turn": ContinuousSampler(0, 2 * math.pi / 16),
    }
