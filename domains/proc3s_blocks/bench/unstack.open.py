def gen_plan(initial, x0, y0, x1, y1, in_x, in_y):
    block = next(o for o in initial.objects.values() if o.category == "block" and o.color == "green")
    bowl = next(o for o in initial.objects.values() if o.category == "bowl")
    above = [
        o
        for o in initial.objects.values()
        if o.pose.z > block.pose.z and math.dist(o.point[:2], block.point[:2]) < BLOCK_SIZE / 2
    ]
    plan = []
    for obstacle, place in zip(sorted(above, key=lambda o: -o.pose.z), ((x0, y0), (x1, y1))):
        plan += [Action("pick", list(obstacle.point)), Action("place", [*place, BLOCK_SIZE / 2])]
    place = [bowl.pose.x + in_x, bowl.pose.y + in_y, bowl.pose.z]
    return [*plan, Action("pick", list(block.point)), Action("place", place)]


def gen_domain(initial):
    (x_min, x_max), (y_min, y_max), _ = TABLE_BOUNDS
    x, y = ContinuousSampler(x_min, x_max), ContinuousSampler(y_min, y_max)
    spare = ContinuousSampler(-0.02, 0.02)
    return {"x0": x, "y0": y, "x1": x, "y1": y, "in_x": spare, "in_y": spare}
