# Fills the memory with an array.
# expect: SketchMemoryError line 5: Unable to allocate
# answer: program
def gen_plan(state):
    return np.ones(10**11)
