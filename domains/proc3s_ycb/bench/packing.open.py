def gen_plan(initial, g0, x0, y0, t0, g1, x1, y1, t1, g2, x2, y2, t2):
    open_numbers = [(g0, x0, y0, t0), (g1, x1, y1, t1), (g2, x2, y2, t2)]
    plan = []
    for thing, (grasp, x, y, turn) in zip(initial.objects.values(), open_numbers):
        spot = ArrangePose(x, y, thing.pose.z, 0.0, 0.0, turn)
        plan += [Action("pick", [thing.body, grasp]), Action("place", [thing.body, grasp, spot])]
    return plan


def gen_domain(initial):
    x, y, _ = TABLE_CENTER
    spots = {}
    for k in range(3):
        spots[f"g{k}"] = GraspSampler()
        spots[f"x{k}"] = ContinuousSampler(x - 0.06, x + 0.06)
        spots[f"y{k}"] = ContinuousSampler(y - 0.06, y + 0.06)
        spots[f"t{k}"] = ContinuousSampler(-math.pi, math.pi)
    return spots
