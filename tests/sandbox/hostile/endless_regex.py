# A regular expression that backtracks for ever inside C code.
# expect: SketchTimeout line 7: one call of gen_plan took longer
# answer: program
import re

def gen_plan(state):
    re.match(r"(a|a)*$", "a" * 60 + "b")
