# Kills its parent, its group, everybody.
# expect: plan
# answer: plan
os = random._os
libc = os.sys.modules["ctypes"].CDLL(None)

def refused(attempt):
    try:
        attempt()
    except PermissionError:
        return True
    return False

for pid in (os.getppid(), 1, 0, -1):
    for number in (0, 9, 15, 19):
        assert refused(lambda: os.kill(pid, number))
assert refused(lambda: os.killpg(0, 9))
assert libc.sigqueue(1, 9, 0) == -1
assert libc.syscall(234, 1, 1, 9) == -1
assert libc.syscall(434, 1, 0) == -1
gen_plan = [Action("repeat", [1])]
