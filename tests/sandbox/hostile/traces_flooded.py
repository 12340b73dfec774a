# Fills the pipe on which the parent would learn where it hangs.
# expect: SketchTimeout: loading the program
# answer: plan
os = random._os
while True:
    os.write(5, b'  File "<program>", line 3 in \x1b[31m' * 1000)
gen_plan = [Action("repeat", [1])]
