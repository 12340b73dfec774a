# Waits for somebody to type.
# expect: plan
# answer: plan
sys = random._os.sys
assert sys.stdin.read() == ""
try:
    sys.modules["builtins"].input("password: ")
except EOFError:
    gen_plan = [Action("repeat", [1])]
