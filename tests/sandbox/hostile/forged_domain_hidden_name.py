# Names a parameter with characters that nobody sees.
# expect: SketchCrash: a reply is not what it should be
# answer: plan
os, struct = random._os, random._os.sys.modules["struct"]
body = b'{"parameters": [{"name": "x\xe2\x80\x8d\xe2\x80\xae", "line": 1, "sampler": "ContinuousSampler", "args": {"min": 0, "max": 1}}], "problems": [], "log": ""}'
os.write(4, struct.pack("<IHHI", 0, 2, 0, len(body)) + body)
os._exit(0)
