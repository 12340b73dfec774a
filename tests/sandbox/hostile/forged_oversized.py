# Announces a reply of four gigabytes.
# expect: SketchCrash: a reply of 4294967295 bytes is too long
# answer: program
os = random._os

calls = 0

def gen_plan(state):
    global calls
    calls += 1
    if calls == 1:
        return [Action("repeat", [1])]
    os.write(4, b"\0\0\0\0\4\0\1\0\xff\xff\xff\xff")
    return [Action("repeat", [1])]
