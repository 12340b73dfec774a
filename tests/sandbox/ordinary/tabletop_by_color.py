# Chooses objects by colour and category, and their poses as arrays and tuples.
# scene: tabletop
# expect: plan: pick(object_1, (0, 0, 0, 0, 3.142, 0)); place(object_1, (0, 0, 0, 0, 3.142, 0), (0.2, -0.5, 0.12, 0, 0, 0))
def find(belief, category, color=None):
    for name, o in belief.objects.items():
        if o.category == category and color in (None, o.color):
            return name, o
    raise LookupError(category)

def gen_plan(initial, height):
    block, _ = find(initial, "block", "blue")
    _, bowl = find(initial, category="bowl")
    grasp = (0, 0, 0, 0, math.pi, 0)
    target = np.array([*bowl.pose.point, 0, 0, 0]) + [0, 0, height, 0, 0, 0]
    return [Action("pick", [block, grasp]), Action("place", [block, grasp, target])]

def gen_domain(initial):
    return {"height": ContinuousSampler(min=0.1, max=0.1)}
