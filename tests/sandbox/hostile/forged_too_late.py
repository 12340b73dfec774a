# Answers once more when its last sample is long finished.
# expect: SketchCrash: tampered with its process
# answer: program
os, struct = random._os, random._os.sys.modules["struct"]

class Late(Action):
    def __del__(self):
        os.write(4, struct.pack("<IHHIBd", 0, 4, 1, 9, 1, 1.0))

def gen_plan(state):
    return [Late("repeat", [1])]
