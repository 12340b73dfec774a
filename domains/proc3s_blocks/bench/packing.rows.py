def gen_plan(initial, three, two, rows, side):
    x, y, _ = TABLE_CENTER
    slots = [(x + k * three, y + side * rows / 2) for k in (-1, 0, 1)]
    slots += [(x + k * two / 2, y - side * rows / 2) for k in (-1, 1)]
    blocks = sorted(initial.objects.values(), key=lambda b: math.dist(b.point[:2], (x, y)))
    plan = []
    for block in blocks:
        slot = min(slots, key=lambda s: math.dist(s, block.point[:2]))
        slots.remove(slot)
        plan.append(Action("pick", list(block.point)))
        plan.append(Action("place", [*slot, BLOCK_SIZE / 2]))
    return plan


def gen_domain(initial):
    return {
        "three": ContinuousSampler(0.046, 0.056),
        "two": ContinuousSampler(0.046, 0.1),
        "rows": ContinuousSampler(0.09, 0.112),
        "side": DiscreteSampler([-1, 1]),
    }
