# Replaces the server's frames.
# expect: SketchCrash: tampered with its process
# answer: program
serve = random._os.sys.modules["boxed.serve"]

class Frames:
    def pack(self, *args):
        return b"\xff" * 100

calls = 0

def gen_plan(state):
    global calls
    calls += 1
    if calls == 1:
        return [Action("repeat", [1])]
    serve.REPLY = Frames()
    return [Action("repeat", [1])]
