def gen_plan(initial, center_x, center_y, turn, r0, r1, r2, r3, r4, inner):
    points = []
    for k, outer in enumerate([r0, r1, r2, r3, r4]):
        for angle, radius in ((turn + 2 * math.pi * k / 5, outer), (turn + math.pi * (2 * k + 1) / 5, inner)):
            points.append((center_x + radius * math.cos(angle), center_y + radius * math.sin(angle)))
    points.append(points[0])
    return [Action("draw_line", [*a, *b]) for a, b in zip(points, points[1:])]


def gen_domain(initial):
    spikes = {f"r{k}": ContinuousSampler(12, 30) for k in range(5)}
    center = {name: ContinuousSampler(10, 90) for name in ("center_x", "center_y")}
    return {**center, "turn": ContinuousSampler(0, 1.26), **spikes, "inner": ContinuousSampler(3, 11)}
