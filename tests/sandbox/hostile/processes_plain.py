# Runs a command in the obvious way.
# expect: SketchRuntimeError line 5: No module named 'subprocess'
# friendly: SketchRuntimeError line 5: ImportError: 'subprocess' cannot be imported here
# answer: plan
import subprocess
subprocess.run(["touch", "/tmp/proc3s-was-here"])
gen_plan = [Action("repeat", [1])]
