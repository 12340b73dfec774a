# Lets the interpreter compile a bomb at run time, past the limits of the parser.
# expect: SketchCrash line 12: SIGSEGV
# answer: program
ast = random._os.sys.modules["ast"]
random._os.sys.setrecursionlimit(10**8)
places = {"lineno": 1, "col_offset": 0}
node = ast.Constant(1, **places)
for _ in range(10**5):
    node = ast.UnaryOp(ast.USub(), node, **places)

def gen_plan(state):
    return compile(ast.Expression(node), "x", "eval")
