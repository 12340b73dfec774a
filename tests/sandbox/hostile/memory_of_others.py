# Attaches to other processes and reads and writes their memory.
# expect: plan
# answer: plan
ctypes = random._os.sys.modules["ctypes"]
libc = ctypes.CDLL(None, use_errno=True)
buffer = ctypes.create_string_buffer(64)
vector = (ctypes.c_size_t * 2)(ctypes.addressof(buffer), 64)
for pid in (1, random._os.getpid(), random._os.getpid() - 1):
    for request in (0, 1, 16, 0x4206):
        assert (libc.ptrace(request, pid, 0, 0), ctypes.get_errno()) == (-1, 1)
    assert (libc.process_vm_readv(pid, vector, 1, vector, 1, 0), ctypes.get_errno()) == (-1, 1)
    assert (libc.process_vm_writev(pid, vector, 1, vector, 1, 0), ctypes.get_errno()) == (-1, 1)
gen_plan = [Action("repeat", [1])]
