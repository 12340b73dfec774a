# Complains thirty thousand times, to flood the next prompt.
# expect: SketchCrash: a reply is not what it should be
# answer: plan
os, struct = random._os, random._os.sys.modules["struct"]
body = b'{"parameters": [], "problems": [%s], "log": ""}' % b",".join([b'["x",1]'] * 30000)
reply = struct.pack("<IHHI", 0, 2, 0, len(body)) + body
while reply:
    reply = reply[os.write(4, reply):]
os._exit(0)
