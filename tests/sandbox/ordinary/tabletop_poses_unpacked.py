# Poses that are unpacked, compared and indexed by name.
# scene: tabletop
# expect: plan: push(0.2, -0.5, 0.02)
# answer: program
def gen_plan(initial):
    x, y, z, *angles = initial["object_2"].pose
    assert angles == [0, 0, 0] and initial["object_0"].pose == initial.objects["object_0"].pose
    return [Action("push", [x, y, z])]
