# Rotation matrices, norms, solving, broadcasting, random access.
# expect: plan: draw_line(1, 0, 0, 1)
# answer: program
def gen_plan(state):
    turn = np.array([[np.cos(np.pi / 2), -np.sin(np.pi / 2)], [np.sin(np.pi / 2), np.cos(np.pi / 2)]])
    start = np.linalg.solve(turn.T @ turn, np.array([1.0, 0.0]))
    end = np.clip(turn @ start, 0, 1)
    centres = np.array([(o.x, o.y) for o in state.obstacles])
    distances = np.linalg.norm(centres[:, None] - centres[None], axis=-1)
    assert np.allclose(distances, distances.T) and np.median(distances) > 0 and np.argmin(distances) == 0
    assert np.percentile([1, 2, 3], 50) == 2 and np.interp(0.5, [0, 1], [0, 2]) == 1
    assert np.einsum("ij,ij->i", turn, turn).sum() > 1 and np.unique([1, 1, 2]).size == 2
    return [Action("draw_line", [*start, *end])]
