def gen_plan(initial, x0, y0, x1, y1, x2, y2, x3, y3, x4, y4):
    places = [(x0, y0), (x1, y1), (x2, y2), (x3, y3), (x4, y4)]
    plan = []
    for block, place in zip(initial.objects.values(), places):
        plan += [Action("pick", list(block.point)), Action("place", [*place, BLOCK_SIZE / 2])]
    return plan


def gen_domain(initial):
    x, y, _ = TABLE_CENTER
    spots = {}
    for k in range(5):
        spots[f"x{k}"] = ContinuousSampler(x - 0.06, x + 0.06)
        spots[f"y{k}"] = ContinuousSampler(y - 0.06, y + 0.06)
    return spots
