# A tower of all blocks, from lists and dictionaries of names.
# scene: tabletop
# expect: plan: pick(object_0, (0, 0, 0, 0, 0, 0)); place(object_0, (0, 0, 0, 0, 0, 0), (0, -0.5, 0.02, 0, 0, 0)); pick(object_1, (0, 0, 0, 0, 0, 0)); place(object_1, (0, 0, 0, 0, 0, 0), (0, -0.5, 0.06, 0, 0, 0))
# answer: program
def gen_plan(initial):
    plan = []
    blocks = sorted(name for name, o in initial.objects.items() if o.category == CATEGORIES[0])
    x, y, z = TABLE_CENTER
    for level, name in enumerate(blocks):
        target = ArrangePose(x, y, z + BLOCK_SIZE * (level + 0.5))
        plan += [Action("pick", [name, ArrangePose()]), Action("place", [name, ArrangePose(), target])]
    return plan
