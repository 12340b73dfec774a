# Replaces what the server's code calls.
# expect: SketchCrash: process died (exit code 1)
# answer: program
builtins = random._os.sys.modules["builtins"]

def gen_plan(state):
    builtins.len = builtins.isinstance = builtins.type = None
    return [Action("repeat", [1])]
