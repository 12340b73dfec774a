# Looks for keys in the environment, in Python's copy and in the C library's.
# expect: plan
# answer: plan
os = random._os
ctypes = os.sys.modules["ctypes"]
libc = ctypes.CDLL(None)
libc.getenv.restype = ctypes.c_char_p
for name in ("SECRET_API_KEY", "OPENAI_API_KEY", "HOME", "PATH", "USER"):
    assert name not in os.environ
    assert libc.getenv(name.encode()) is None
assert not any("SECRET" in name for name in os.environ)
gen_plan = [Action("repeat", [1])]
