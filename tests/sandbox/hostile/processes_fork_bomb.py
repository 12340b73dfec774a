# A fork bomb.
# expect: SketchTimeout: loading the program
# answer: plan
os = random._os
while True:
    try:
        os.fork()
    except OSError:
        continue
gen_plan = [Action("repeat", [1])]
