# An exception of its own that nothing ordinary catches, with a name and a text that break terminals.
# expect: SketchRuntimeError line 5: ?[31mFatal: ?[2J?
# answer: program
def gen_plan(state):
    raise type("\x1b[31mFatal", (BaseException,), {})("\x1b[2J\u202e")
