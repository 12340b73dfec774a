# Lists a folder in the obvious way.
# expect: SketchRuntimeError line 6: PermissionError: [Errno 1] Operation not permitted: '/'
# friendly: SketchRuntimeError line 5: ImportError: 'os' cannot be imported here; available: __future__, abc,
# answer: plan
import os
print(os.listdir("/"))
gen_plan = [Action("repeat", [1])]
