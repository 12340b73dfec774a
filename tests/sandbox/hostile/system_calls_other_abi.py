# Calls the kernel by the numbers of another ABI, which a careless filter forgets.
# expect: SketchCrash: SIGSYS
# answer: plan
random._os.sys.modules["ctypes"].CDLL(None).syscall(0x40000000 | 2, b"/etc/passwd", 0)
gen_plan = [Action("repeat", [1])]
