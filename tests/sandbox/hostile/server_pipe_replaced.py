# Makes the server write nowhere.
# expect: SketchTimeout: one call of gen_plan
# answer: program
serve = random._os.sys.modules["boxed.serve"]

def gen_plan(state):
    serve._write = lambda data: None
    return [Action("repeat", [1])]
