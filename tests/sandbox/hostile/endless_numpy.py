# Multiplies large matrices for ever, inside C code.
# expect: SketchTimeout line 7: one call of gen_plan took longer
# answer: program
def gen_plan(state):
    a = np.ones((700, 700))
    while True:
        a = np.sort(a, axis=None)[::-1].reshape(700, 700).copy()
