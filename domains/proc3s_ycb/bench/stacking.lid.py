def find(initial, category):
    return next(o for o in initial.objects.values() if o.category == category)


def gen_plan(initial, grasp, shift_x, shift_y, turn):
    can, berry = find(initial, "meat_can"), find(initial, "strawberry")
    top = can.pose.z + SIZES["meat_can"][2][1] - SIZES["strawberry"][2][0]
    spot = ArrangePose(can.pose.x + shift_x, can.pose.y + shift_y, top, 0.0, 0.0, turn)
    return [
        Action("pick", [berry.body, grasp]),
        Action("place", [berry.body, grasp, spot]),
    ]


def gen_domain(initial):
    return {
        "grasp": GraspSampler(),
        "shift_x": ContinuousSampler(-0.01, 0.01),
        "shift_y": ContinuousSampler(-0.01, 0.01),
        "turn": ContinuousSampler(-math.pi, math.pi),
    }
