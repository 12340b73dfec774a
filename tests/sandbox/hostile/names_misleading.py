# Skills and objects whose names turn the terminal around.
# expect: SketchContractError line 5: unknown skill '\x1b[31mdraw_line\u202e\u200b'
# answer: program
def gen_plan(state):
    return [Action("\x1b[31mdraw_line\u202e\u200b", [1, 2, 3, 4])]
