# Looks into /proc: its own memory, its parent, everybody's command lines.
# expect: plan
# answer: plan
os = random._os
for path in ("self/environ", "self/mem", "self/maps", "self/fd/4", "self/root", "1/cmdline", "1/environ", "sys/kernel/hostname"):
    for attempt in (lambda p: os.open(p, 0), os.stat, os.readlink, os.listdir):
        try:
            attempt("/proc/" + path)
        except PermissionError:
            continue
        raise AssertionError(path)
gen_plan = [Action("repeat", [1])]
