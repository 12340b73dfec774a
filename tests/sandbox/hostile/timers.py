# Sets alarms, to interrupt the server later.
# expect: plan
# answer: plan
signal = random._os.sys.modules["signal"]
signal.signal(signal.SIGALRM, lambda *_: 1 / 0)
for set_timer in (lambda: signal.setitimer(signal.ITIMER_REAL, 0.01), lambda: signal.pause() or 1 / 0):
    try:
        set_timer()
    except OSError:
        break
gen_plan = [Action("repeat", [1])]
