# A regular polygon with numpy arrays as points.
# expect: plan: draw_line(70.00, 50.00, 50.00, 70.00); draw_line(50.00, 70.00, 30.00, 50.00); draw_line(30.00, 50.00, 50.00, 30.00); draw_line(50.00, 30.00, 70.00, 50.00)
import numpy as np

def gen_plan(state, size: float):
    angles = np.linspace(0, 2 * np.pi, 5)
    points = np.array([50.0, 50.0]) + size * np.column_stack([np.cos(angles), np.sin(angles)])
    return [Action("draw_line", np.concatenate([a, b])) for a, b in zip(points[:-1], points[1:])]

def gen_domain(state):
    return {"size": ContinuousSampler(20, 20)}
