import itertools


def score(order, spots):
    """Room around every spot for what is not moved yet, and a preference for the can at the end, opposite."""
    room = [
        math.dist(spot, later.point[:2]) for k, spot in enumerate(spots) for later in order[k + 1 :]
    ]
    kinds = [thing.category for thing in order]
    apart = math.dist(spots[kinds.index("banana")], spots[kinds.index("meat_can")])
    return min(0.16, *room) + 0.03 * (kinds[-1] == "meat_can") + 0.2 * apart


def ranked(things):
    """Orders of the things with a corner for each, the best first."""
    x, y, _ = TABLE_CENTER
    corners = [(x + a * 0.044, y + b * 0.044) for a in (-1, 1) for b in (-1, 1)]
    layouts = [
        (order, spots)
        for order in itertools.permutations(things)
        for spots in itertools.permutations(corners, len(order))
    ]
    return sorted(layouts, key=lambda layout: -score(*layout))


def middle(grasp, pose):
    """The pose to ask for so that a thing, pushed between the closing fingers, ends up at `pose`."""
    along = math.cos(grasp.yaw), math.sin(grasp.yaw)
    shift = grasp.x * along[0] + grasp.y * along[1]
    pushed = ArrangePose(shift * along[0], shift * along[1], 0.0, 0.0, 0.0, 0.0)
    x, y, _ = 2 * pose.point - pose.multiply(pushed).point
    return ArrangePose(x, y, pose.z, 0.0, 0.0, pose.yaw)


def gen_plan(initial, rank, banana, berry, can_0, can_1, can_2, can_3, can_4, can_5, out, turn_berry, turn_can):
    def askew(grasp):
        return abs(math.cos(grasp.yaw)) + 10 * abs(grasp.x)

    can = min((can_0, can_1, can_2, can_3, can_4, can_5), key=askew)
    grasps = {"banana": banana, "strawberry": berry, "meat_can": can}
    turns = {"banana": out, "strawberry": turn_berry, "meat_can": turn_can}
    center = np.array(TABLE_CENTER[:2])
    plan = []
    for thing, (x, y) in zip(*ranked(list(initial.objects.values()))[rank]):
        grasp, turn = grasps[thing.category], turns[thing.category]
        if thing.category == "banana":
            turn += math.atan2(y - center[1], x - center[0])
        spot = ArrangePose(x, y, thing.pose.z, 0.0, 0.0, turn)
        plan.append(Action("pick", [thing.body, grasp]))
        plan.append(Action("place", [thing.body, grasp, middle(grasp, spot)]))
    return plan


def gen_domain(initial):
    names = ["banana", "berry"] + [f"can_{k}" for k in range(6)]
    return {
        "rank": DiscreteSampler(list(range(6))),
        **{name: GraspSampler() for name in names},
        "out": ContinuousSampler(-0.6, 1.2),
        "turn_berry": ContinuousSampler(-math.pi, math.pi),
        "turn_can": ContinuousSampler(-math.pi, math.pi),
    }
