# Creates and changes files wherever it can, and removes some.
# expect: plan
# answer: plan
os = random._os
io = os.sys.modules["io"]

def refused(attempt):
    try:
        attempt()
    except PermissionError:
        return True
    return False

for folder in ("/tmp", "/dev/shm", "/var/tmp", ".", "/root", "/proc/self"):
    path = folder + "/proc3s-was-here"
    assert refused(lambda: io.open(path, "w")), path
    assert refused(lambda: os.mkdir(path)), path
    assert refused(lambda: os.symlink("/etc", path)), path
    assert refused(lambda: os.mkfifo(path)), path
assert refused(lambda: os.rename("/etc/passwd", "/tmp/proc3s-was-here"))
assert refused(lambda: os.link("/etc/passwd", "/tmp/proc3s-was-here"))
assert refused(lambda: os.unlink("/tmp/nothing"))
assert refused(lambda: os.chmod("/tmp", 0))
assert refused(lambda: os.truncate("/tmp/nothing", 0))
gen_plan = [Action("repeat", [1])]
