def gen_plan(initial, direction, gap, length, head):
    target = max(initial.obstacles, key=lambda obstacle: obstacle.radius)
    reach = target.radius + gap
    tip_x, tip_y = target.x_pos + reach * math.cos(direction), target.y_pos + reach * math.sin(direction)
    plan = []
    for turn, size in ((0, length), (0.6, head * length), (-0.6, head * length)):
        angle = direction + turn
        end = (tip_x + size * math.cos(angle), tip_y + size * math.sin(angle))
        plan.append(Action("draw_line", [*end, tip_x, tip_y]))
    return plan


def gen_domain(initial):
    return {
        "direction": ContinuousSampler(0, 2 * math.pi),
        "gap": ContinuousSampler(0, 6),
        "length": ContinuousSampler(8, 60),
        "head": ContinuousSampler(0.2, 0.5),
    }
