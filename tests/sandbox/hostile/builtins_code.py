# Builds code at run time and climbs to the builtins that were left out: still in the box.
# expect: SketchRuntimeError: PermissionError: [Errno 1] Operation not permitted: '/etc/passwd'
# answer: program
def gen_plan(state):
    code = compile("().__class__.__base__.__subclasses__()", "x", "eval")
    wrapper = [kind for kind in eval(code) if kind.__name__ == "_wrap_close"][0]
    exec("text = opened('/etc/passwd')", {"opened": wrapper.__init__.__globals__["sys"].modules["io"].open})
