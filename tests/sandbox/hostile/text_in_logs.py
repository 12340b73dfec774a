# Prints what would clear the screen, reorder a line, or hide in it.
# expect: plan: repeat(1)
# log: ab?[2Jc?d?e??f
# answer: program
def gen_plan(state):
    print("ab\x1b[2Jc\u202ed\u200be\ud800\ufe0ff")
    return [Action("repeat", [1])]
