# Reads and saves files by way of numpy, which opens them in C.
# expect: plan
# answer: plan
def refused(attempt):
    try:
        attempt()
    except (OSError, SystemError):
        return True
    return False

assert refused(lambda: np.fromfile("/etc/passwd", "u1"))
assert refused(lambda: np.load("/etc/passwd", allow_pickle=True))
assert refused(lambda: np.zeros(3).tofile("/tmp/proc3s-was-here"))
assert refused(lambda: np.save("/tmp/proc3s-was-here", np.zeros(3)))
assert refused(lambda: np.loadtxt("/etc/passwd", str))
gen_plan = [Action("repeat", [1])]
