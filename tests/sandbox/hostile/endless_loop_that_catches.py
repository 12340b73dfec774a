# Loops for ever and catches whatever would end it.
# expect: SketchTimeout: loading the program
# answer: plan
signal = random._os.sys.modules["signal"]
for number in range(1, 32):
    try:
        signal.signal(number, signal.SIG_IGN)
    except (OSError, ValueError):
        continue
while True:
    try:
        x = 1
    except BaseException:
        continue
