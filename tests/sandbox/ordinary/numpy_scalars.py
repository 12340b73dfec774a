# numpy numbers of every kind where numbers are expected.
# expect: plan: draw_line(1, 2, 3, 4); repeat(5)
# answer: program
def gen_plan(state):
    values = np.arange(1, 5)
    return [
        Action("draw_line", [values[0], np.float32(2), values.max() - 1, np.array([4.0])]),
        Action("repeat", [np.int64(5)]),
    ]
