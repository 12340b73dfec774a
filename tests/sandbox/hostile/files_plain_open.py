# Reads a file in the obvious way.
# expect: SketchRuntimeError line 5: PermissionError: [Errno 1] Operation not permitted: '/etc/passwd'
# friendly: SketchRuntimeError line 5: NameError: name 'open' is not defined
# answer: plan
print(open("/etc/passwd").read())
gen_plan = [Action("repeat", [1])]
