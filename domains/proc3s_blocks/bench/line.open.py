def gen_plan(initial, x, y, turn, pitch):
    blocks = [o for o in initial.objects.values() if o.category == "block"]
    blocks.sort(key=lambda b: math.dist(b.point[:2], (x, y)))
    plan = []
    for k, block in enumerate(blocks[:5]):
        along = (k - 2) * pitch
        place = [x + along * math.cos(turn), y + along * math.sin(turn), 0.0]
        plan += [Action("pick", list(block.point)), Action("place", place)]
    return plan


def gen_domain(initial):
    (x_min, x_max), (y_min, y_max), _ = TABLE_BOUNDS
    return {
        "x": ContinuousSampler(x_min, x_max),
        "y": ContinuousSampler(y_min, y_max),
        "turn": ContinuousSampler(0, math.pi),
        "pitch": ContinuousSampler(0.04, 0.12),
    }
