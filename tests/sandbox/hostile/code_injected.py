# Jumps into machine code of its own.
# expect: SketchCrash line 6: SIGSEGV
# answer: plan
ctypes = random._os.sys.modules["ctypes"]
code = ctypes.create_string_buffer(b"\xb8\x2a\0\0\0\xc3" * 100)
ctypes.CFUNCTYPE(ctypes.c_int)(ctypes.addressof(code))()
gen_plan = [Action("repeat", [1])]
