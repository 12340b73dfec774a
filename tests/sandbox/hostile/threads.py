# Starts threads, to go on when its call is over.
# expect: plan
# answer: plan
modules = random._os.sys.modules
threading, ctypes = modules["threading"], modules["ctypes"]
for start in (threading.Thread(target=print).start, lambda: modules["_thread"].start_new_thread(print, ())):
    try:
        start()
    except RuntimeError:
        continue
    raise AssertionError("a thread has started")
libc = ctypes.CDLL(None)
number, routine = ctypes.c_ulong(), ctypes.cast(libc.getpid, ctypes.c_void_p)
assert libc.pthread_create(ctypes.byref(number), None, routine, None) != 0
gen_plan = [Action("repeat", [1])]
