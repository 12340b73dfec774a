# Offers integers of thousands of digits as choices.
# expect: SketchCrash: a reply is not what it should be
# answer: plan
os, struct = random._os, random._os.sys.modules["struct"]
body = b'{"parameters": [{"name": "x", "line": 1, "sampler": "DiscreteSampler", "args": {"values": [1, %s]}}], "problems": [], "log": ""}' % (b"9" * 4000)
os.write(4, struct.pack("<IHHI", 0, 2, 0, len(body)) + body)
os._exit(0)
