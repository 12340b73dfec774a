from importlib.util import find_spec

# Without the extra `tabletop` there is no simulator to test.
MISSING = [name for name in ("pybullet", "airo_models") if find_spec(name) is None]
collect_ignore_glob = ["test_*.py"] if MISSING else []
