def gen_plan(initial, direction, gap, length, bend, joint, left, right, left_angle, right_angle):
    target = max(initial.obstacles, key=lambda obstacle: obstacle.radius)
    reach = target.radius + gap
    tip = (target.x_pos + reach * math.cos(direction), target.y_pos + reach * math.sin(direction))

    def away(point, angle, size):
        return (point[0] + size * math.cos(angle), point[1] + size * math.sin(angle))

    middle = away(tip, direction, joint * length)
    ends = [
        (middle, tip),
        (away(middle, direction + bend, (1 - joint) * length), middle),
        (away(tip, direction + left_angle, left), tip),
        (away(tip, direction - right_angle, right), tip),
    ]
    return [Action("draw_line", [*a, *b]) for a, b in ends]


def gen_domain(initial):
    barb, angle = ContinuousSampler(3, 20), ContinuousSampler(0.3, 0.9)
    return {
        "direction": ContinuousSampler(0, 2 * math.pi),
        "gap": ContinuousSampler(0, 6),
        "length": ContinuousSampler(15, 70),
        "bend": ContinuousSampler(-0.3, 0.3),
        "joint": ContinuousSampler(0.3, 0.7),
        "left": barb,
        "right": barb,
        "left_angle": angle,
        "right_angle": angle,
    }
