def gen_plan(initial, base, side, gap):
    blocks = [o for o in initial.objects.values() if o.category == "block"]
    support = blocks[base]
    others = [b for b in blocks if b is not support]
    others.sort(key=lambda b: math.dist(b.point[:2], support.point[:2]))
    second, third = others[:2]
    x, y, z = support.point
    step = side * (BLOCK_SIZE + gap)
    return [
        Action("pick", list(second.point)),
        Action("place", [x + step, y, z]),
        Action("pick", list(third.point)),
        Action("place", [x + step / 2, y, z + BLOCK_SIZE]),
    ]


def gen_domain(initial):
    count = sum(o.category == "block" for o in initial.objects.values())
    return {
        "base": DiscreteSampler(list(range(count))),
        "side": DiscreteSampler([-1, 1]),
        "gap": ContinuousSampler(0.004, 0.016),
    }
