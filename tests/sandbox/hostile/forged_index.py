# Names an object by an index beyond the table.
# expect: SketchContractError: step 0, pick: item must be one of object_0, object_1
# answer: program
os, struct = random._os, random._os.sys.modules["struct"]

calls = 0

def gen_plan(state):
    global calls
    calls += 1
    if calls == 1:
        return [Action("repeat", [1])]
    for sample in range(3):
        os.write(4, struct.pack("<IHHIB7d", sample, 4, 1, 57, 2, 7, 1, 1, 1, 1, 1, 1))
    while True:
        pass
