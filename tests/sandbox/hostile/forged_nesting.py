# Sends JSON that is nested a hundred thousand deep.
# expect: SketchCrash: a reply is not what it should be
# answer: plan
os, struct = random._os, random._os.sys.modules["struct"]
reply = struct.pack("<IHHI", 0, 2, 0, 100000) + b"[" * 100000
while reply:
    reply = reply[os.write(4, reply):]
os._exit(0)
