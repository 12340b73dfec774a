# Picks a block by name and places it on another, with grasps and poses.
# scene: tabletop
# expect: plan: pick(object_0, (0.1, -0.5, 0.02, 0, 0, 0.5)); place(object_0, (0.1, -0.5, 0.02, 0, 0, 0.5), (-0.1, -0.5, 0.06, 0, 0, 0))
def gen_plan(initial: ArrangeBelief, yaw: float):
    source, target = initial.objects["object_0"].pose, initial.objects["object_1"].pose
    grasp = ArrangePose(source.x, source.y, source.z, 0, 0, yaw)
    above = ArrangePose(target.x, target.y, target.z + BLOCK_SIZE)
    return [Action("pick", ["object_0", grasp]), Action("place", ["object_0", grasp, above])]

def gen_domain(initial: ArrangeBelief):
    return {"yaw": ContinuousSampler(0.5, 0.5)}
