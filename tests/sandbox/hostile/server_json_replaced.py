# Replaces the server's JSON.
# expect: SketchCrash: tampered with its process
# answer: plan
serve = random._os.sys.modules["boxed.serve"]
serve.json.dumps = lambda *args, **kwargs: "[" * 50000
gen_plan = [Action("repeat", [1])]
