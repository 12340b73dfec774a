# Changes the environment, the import path and the module table for those who come after.
# expect: plan
# answer: plan
os = random._os
os.environ["PATH"] = os.environ["LD_PRELOAD"] = "/tmp/evil.so"
os.putenv("PYTHONPATH", "/tmp")
os.sys.path[:] = ["/tmp"]
os.sys.modules.clear()
gen_plan = [Action("repeat", [1])]
