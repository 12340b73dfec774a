def gen_plan(initial, x, y, gap, shift_x, shift_y):
    blocks = [o for o in initial.objects.values() if o.category == "block"]
    blocks.sort(key=lambda b: math.dist(b.point[:2], (x, y)))
    step = (BLOCK_SIZE + gap) / 2
    places = [
        (x - step, y, BLOCK_SIZE / 2),
        (x + step, y, BLOCK_SIZE / 2),
        (x + shift_x, y + shift_y, 1.5 * BLOCK_SIZE),
    ]
    plan = []
    for block, place in zip(blocks, places):
        plan += [Action("pick", list(block.point)), Action("place", list(place))]
    return plan


def gen_domain(initial):
    (x_min, x_max), (y_min, y_max), _ = TABLE_BOUNDS
    return {
        "x": ContinuousSampler(x_min, x_max),
        "y": ContinuousSampler(y_min, y_max),
        "gap": ContinuousSampler(0, 0.02),
        "shift_x": ContinuousSampler(-0.01, 0.01),
        "shift_y": ContinuousSampler(-0.01, 0.01),
    }
