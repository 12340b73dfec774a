# Reads the requests that are meant for the server.
# expect: SketchTimeout line 6: loading the program
# answer: plan
os = random._os
print("waiting")
os.read(3, 1000)
gen_plan = [Action("repeat", [1])]
