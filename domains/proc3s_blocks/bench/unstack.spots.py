def find(initial, category, color):
    return next(o for o in initial.objects.values() if o.category == category and o.color == color)


def on_top(initial, block):
    """The blocks above another, the highest first."""
    above = [
        o
        for o in initial.objects.values()
        if o.pose.z > block.pose.z and math.dist(o.point[:2], block.point[:2]) < BLOCK_SIZE / 2
    ]
    return sorted(above, key=lambda o: -o.pose.z)


def free_spots(initial):
    """Places on a grid with room for a block and the fingers around it."""
    spots = []
    for x in np.arange(-0.24, 0.25, 0.04):
        for y in np.arange(-0.68, -0.25, 0.04):
            near = (math.dist((x, y), o.point[:2]) - (0.15 if o.category == "bowl" else 0.1)
                    for o in initial.objects.values())
            if min(near) > 0:
                spots.append((x, y))
    return spots


def gen_plan(initial, first, second, distance, direction):
    block, bowl = find(initial, "block", "green"), find(initial, "bowl", "green")
    spots = free_spots(initial)
    plan = []
    for obstacle, spot in zip(on_top(initial, block), (first, second)):
        plan.append(Action("pick", list(obstacle.point)))
        plan.append(Action("place", [*spots[spot], BLOCK_SIZE / 2]))
    x = bowl.pose.x + distance * math.cos(direction)
    y = bowl.pose.y + distance * math.sin(direction)
    plan.append(Action("pick", list(block.point)))
    plan.append(Action("place", [x, y, BLOCK_SIZE / 2]))
    return plan


def gen_domain(initial):
    spots = list(range(len(free_spots(initial))))
    return {
        "first": DiscreteSampler(spots),
        "second": DiscreteSampler(spots),
        "distance": ContinuousSampler(0, 0.008),
        "direction": ContinuousSampler(0, 2 * math.pi),
    }
