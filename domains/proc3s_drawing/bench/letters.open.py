def gen_plan(initial, left, bottom, height, proportion, dip):
    width = proportion * height
    right, top = left + width, bottom + height
    middle = (left + width / 2, top - dip * height)
    corners = [(left, bottom), (left, top), middle, (right, top), (right, bottom)]
    return [Action("draw_line", [*a, *b]) for a, b in zip(corners, corners[1:])]


def gen_domain(initial):
    return {
        "left": ContinuousSampler(0, 90),
        "bottom": ContinuousSampler(0, 90),
        "height": ContinuousSampler(20, 70),
        "proportion": ContinuousSampler(0.7, 1.2),
        "dip": ContinuousSampler(0.45, 0.85),
    }
