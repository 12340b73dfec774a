# Takes the lock off again.
# expect: plan
# answer: plan
os = random._os
ctypes, resource, lock = map(os.sys.modules.get, ("ctypes", "resource", "boxed.lock"))
libc = ctypes.CDLL(None, use_errno=True)
for option, value in ((22, 0), (22, 2), (38, 0), (4, 1), (1, 0), (8, 1), (24, 0)):
    assert (libc.prctl(option, value, 0, 0, 0), ctypes.get_errno()) == (-1, 1)
for kind in (resource.RLIMIT_AS, resource.RLIMIT_CPU, resource.RLIMIT_NOFILE, resource.RLIMIT_NPROC):
    try:
        resource.setrlimit(kind, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    except (OSError, ValueError):
        continue
    raise AssertionError(kind)
for attempt in (lambda: os.setuid(0), lambda: os.setgroups([0]), lambda: os.chroot("/"), os.setsid):
    try:
        attempt()
    except PermissionError:
        continue
    raise AssertionError(attempt)
try:
    lock.install([lock._instruction(lock._RETURN, lock._ALLOW)])
except OSError:
    gen_plan = [Action("repeat", [1])]
