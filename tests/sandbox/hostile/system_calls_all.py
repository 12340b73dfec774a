# Tries every system call there is, but for those that the lock allows.
# expect: plan
# answer: plan
ctypes, lock = map(random._os.sys.modules.get, ("ctypes", "boxed.lock"))
libc = ctypes.CDLL(None, use_errno=True)
allowed = set(lock._NUMBERS[lock.platform.machine()].values())
exempt = {335, 336}  # uretprobe and uprobe, which the kernel takes from every filter; they do nothing here
for number in set(range(600)) - allowed - exempt:
    ctypes.set_errno(0)
    assert (libc.syscall(number, 0, 0, 0, 0, 0, 0), ctypes.get_errno()) == (-1, 1), number
gen_plan = [Action("repeat", [1])]
