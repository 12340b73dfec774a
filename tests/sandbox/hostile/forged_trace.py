# Catches the signal that asks where it hangs, and answers with nonsense.
# expect: SketchTimeout line 4: loading the program
# answer: plan
os = random._os
forged = b'  File "<program>", line 99999999999999999999 in x\n  File "/etc/passwd", line 1 in x\n  File "<program>", line 4 in \x1b[2J\n'
os.sys.modules["signal"].signal(10, lambda *_: os.write(5, forged))
while True:
    pass
gen_plan = [Action("repeat", [1])]
