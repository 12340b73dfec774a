# Raises in the server's own functions by way of a trace function.
# expect: SketchRuntimeError line 8: KeyboardInterrupt
# answer: program
sys = random._os.sys

def trace(frame, event, argument):
    if "boxed" in frame.f_code.co_filename:
        raise KeyboardInterrupt
    return trace

def gen_plan(state):
    sys.settrace(trace)
    return [Action("repeat", [1])]
