# Answers the loading itself, with parameters that gen_plan does not have.
# expect: SketchCrash: tampered with its process
# answer: plan
os, struct = random._os, random._os.sys.modules["struct"]
body = b'{"parameters": [{"name": "x", "line": 1, "sampler": "ContinuousSampler", "args": {"min": 0, "max": 1}}], "problems": [], "log": ""}'
os.write(4, struct.pack("<IHHI", 0, 2, 0, len(body)) + body)
gen_plan = [Action("repeat", [1])]
