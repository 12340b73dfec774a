# Sends an error whose text is no Unicode, on a line that is no number.
# expect: SketchCrash: a reply is not what it should be
# answer: program
os, struct = random._os, random._os.sys.modules["struct"]

calls = 0

def gen_plan(state):
    global calls
    calls += 1
    if calls == 1:
        return [Action("repeat", [1])]
    body = b'{"kind": "runtime", "message": "\\ud800 \xff", "line": NaN}'
    os.write(4, struct.pack("<IHHI", 0, 5, 0, len(body)) + body)
    os._exit(0)
