def gen_plan(initial, first, second, share, r0, r1, r2, r3, r4, r5, r6, r7, r8, r9, r10, r11):
    a, b = initial.obstacles[first], initial.obstacles[second]
    x = a.x_pos + share * (b.x_pos - a.x_pos)
    y = a.y_pos + share * (b.y_pos - a.y_pos)
    corners = []
    for k, radius in enumerate([r0, r1, r2, r3, r4, r5, r6, r7, r8, r9, r10, r11]):
        angle = 2 * math.pi * k / 12
        corners.append((x + radius * math.cos(angle), y + radius * math.sin(angle)))
    return [Action("draw_line", [*corners[k - 1], *corners[k]]) for k in range(12)]


def gen_domain(initial):
    count = len(initial.obstacles)
    return {
        "first": DiscreteSampler(list(range(count // 2))),
        "second": DiscreteSampler(list(range(count // 2, count))),
        "share": ContinuousSampler(0.2, 0.8),
        **{f"r{k}": ContinuousSampler(15, 50) for k in range(12)},
    }
