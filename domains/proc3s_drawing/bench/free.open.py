def gen_plan(initial, left, bottom, width, roof):
    right, top = left + width, bottom + width
    ridge = (left + width / 2, top + roof * width)
    outline = [(left, top), (left, bottom), (right, bottom), (right, top), (left, top), ridge, (right, top)]
    return [Action("draw_line", [*a, *b]) for a, b in zip(outline, outline[1:])]


def gen_domain(initial):
    return {
        "left": ContinuousSampler(2, 80),
        "bottom": ContinuousSampler(2, 80),
        "width": ContinuousSampler(10, 30),
        "roof": ContinuousSampler(0.4, 1.0),
    }
