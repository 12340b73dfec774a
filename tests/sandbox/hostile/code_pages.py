# Asks for memory that can be executed.
# expect: plan
# answer: plan
ctypes = random._os.sys.modules["ctypes"]
libc = ctypes.CDLL(None, use_errno=True)
libc.mmap.restype = ctypes.c_ssize_t
for protection in (4, 5, 7):
    assert (libc.mmap(0, 4096, protection, 0x22, -1, 0), ctypes.get_errno()) == (-1, 1)
page = libc.mmap(0, 4096, 3, 0x22, -1, 0)
assert page > 0
for protection in (4, 5, 7):
    assert (libc.mprotect(ctypes.c_void_p(page), 4096, protection), ctypes.get_errno()) == (-1, 1)
gen_plan = [Action("repeat", [1])]
