# Runs a command by unpickling it.
# expect: plan
# answer: plan
pickle = random._os.sys.modules["pickle"]
print(pickle.loads(b"cposix\nsystem\n(S'touch /tmp/proc3s-was-here'\ntR."))
gen_plan = [Action("repeat", [1])]
