def room(initial, x, y, taken):
    """Distance of a block at x, y from what would touch it or the fingers around it; negative if too near."""
    spare = []
    for o in initial.objects.values():
        if o.body in taken:
            continue
        dx, dy = abs(o.pose.x - x), abs(o.pose.y - y)
        if o.category == "block":
            spare.append(max(dx - 0.045, dy - 0.08))
        else:
            spare.append(math.hypot(max(dx - 0.02, 0), max(dy - 0.055, 0)) - 0.085)
    return min(spare, default=1.0)


def free_lines(initial, pitch):
    """Left ends of lines with the most room around them, the best ones first."""
    found = []
    for y in np.arange(-0.76, -0.24, 0.02):
        for x in np.arange(-0.26, 0.27 - 4 * pitch, 0.02):
            if math.hypot(max(abs(x), abs(x + 4 * pitch)), y) < 0.76:
                found.append((min(room(initial, x + k * pitch, y, []) for k in range(5)), x, y))
    return [(x, y) for _, x, y in sorted(found, reverse=True)]


def gen_plan(initial, place, pitch):
    x, y = free_lines(initial, 0.055)[place]
    blocks = [o for o in initial.objects.values() if o.category == "block"]
    blocks.sort(key=lambda b: math.dist(b.point[:2], (x + 2 * pitch, y)))
    plan = []
    for k, block in enumerate(sorted(blocks[:5], key=lambda b: b.pose.x)):
        plan.append(Action("pick", list(block.point)))
        plan.append(Action("place", [x + k * pitch, y, BLOCK_SIZE / 2]))
    return plan


def gen_domain(initial):
    return {
        "place": DiscreteSampler(list(range(12))),
        "pitch": ContinuousSampler(0.046, 0.055),
    }
