# A regular polygon with numpy arrays as points.
# expect: plan: draw_line(70, 50, 50, 70); draw_line(50, 70, 30, 50); draw_line(30, 50, 50, 30); draw_line(50, 30, 70, 50)
import numpy as np

def gen_plan(state, size: float):
    angles = np.linspace(0, 2 * np.pi, 5)
    points = np.array([50.0, 50.0]) + size * np.column_stack([np.cos(angles), np.sin(angles)])
    return [Action("draw_line", np.concatenate([a, b])) for a, b in zip(points[:-1], points[1:])]

def gen_domain(state):
    return {"size": ContinuousSampler(20, 20)}
