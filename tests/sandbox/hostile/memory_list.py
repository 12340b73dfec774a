# Fills the memory with a list.
# expect: SketchMemoryError: MemoryError
# answer: program
def gen_plan(state):
    hoard = [0] * 1000
    while True:
        hoard += hoard
