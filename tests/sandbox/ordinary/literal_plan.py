# The plan itself, as plain as can be.
# expect: plan: draw_line(0, 0, 10, 10); pick(object_1, (1, 2, 3, 0, 0, 0)); look((1, 2, 3), near)
# answer: plan
gen_plan = [
    Action("draw_line", [0, 0, 10, 10]),
    Action(name="pick", params=["object_1", Pose(1, 2, 3)]),
    Action("look", (1, 2, 3), "near"),
]
