# Makes sockets of every family by way of the C library.
# expect: plan
# answer: plan
ctypes = random._os.sys.modules["ctypes"]
libc = ctypes.CDLL(None, use_errno=True)
for family in (1, 2, 10, 16, 17, 38, 40):
    for kind in (1, 2, 3):
        assert (libc.socket(family, kind, 0), ctypes.get_errno()) == (-1, 1)
pair = (ctypes.c_int * 2)()
assert libc.socketpair(1, 1, 0, pair) == -1
for descriptor in (3, 4, 5):
    assert libc.send(descriptor, b"x", 1, 0) == -1
    assert libc.connect(descriptor, bytes(16), 16) == -1
gen_plan = [Action("repeat", [1])]
