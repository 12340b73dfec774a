# A power with a billion digits, inside C code.
# expect: SketchTimeout line 5: one call of gen_plan took longer
# answer: program
def gen_plan(state):
    return 3 ** (10 ** 9)
