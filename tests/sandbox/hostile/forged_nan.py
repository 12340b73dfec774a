# Sends NaN and infinity past the server's checks.
# expect: SketchContractError: step 0, draw_line: x1 must be a finite number below 1e+06
# answer: program
os, struct = random._os, random._os.sys.modules["struct"]

calls = 0

def gen_plan(state):
    global calls
    calls += 1
    if calls == 1:
        return [Action("repeat", [1])]
    for sample in range(3):
        os.write(4, struct.pack("<IHHIBdddd", sample, 4, 1, 33, 0, math.nan, math.inf, -math.inf, 1e300))
    while True:
        pass
