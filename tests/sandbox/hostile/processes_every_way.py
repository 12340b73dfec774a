# Starts processes in every way the C library knows.
# expect: plan
# answer: plan
os = random._os
ctypes = os.sys.modules["ctypes"]
libc = ctypes.CDLL(None, use_errno=True)
touch = ["touch", "/tmp/proc3s-was-here"]

def refused(attempt):
    try:
        attempt()
    except PermissionError:
        return True
    return False

assert refused(os.fork)
assert refused(os.forkpty)
assert refused(lambda: os.posix_spawn("/usr/bin/touch", touch, {}))
assert refused(lambda: os.execv("/usr/bin/touch", touch))
assert os.system("touch /tmp/proc3s-was-here") != 0
assert libc.vfork() == -1
assert libc.popen(b"touch /tmp/proc3s-was-here", b"r") == 0
gen_plan = [Action("repeat", [1])]
