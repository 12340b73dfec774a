# Copies, closes, makes and misuses descriptors.
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

for fd in range(10):
    assert refused(lambda: os.dup(fd)) and refused(lambda: os.close(fd)) and refused(lambda: os.fstat(fd))
    assert refused(lambda: os.ftruncate(fd, 0)) and refused(lambda: os.lseek(fd, 0, 0))
    assert libc.fcntl(fd, 8, 1) == -1 and libc.ioctl(fd, 0x5412, b"x") == -1
    if fd != 3:
        assert refused(lambda: os.read(fd, 1))
    if fd not in (4, 5):
        assert refused(lambda: os.write(fd, b"x"))
assert refused(os.pipe) and refused(lambda: os.memfd_create("x")) and refused(lambda: os.eventfd(0))
assert refused(lambda: os.sendfile(4, 3, None, 10)) and refused(lambda: os.splice(3, 4, 10))
gen_plan = [Action("repeat", [1])]
