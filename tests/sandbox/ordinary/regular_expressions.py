# Reads names with regular expressions and string methods.
# expect: plan: repeat(1); repeat(2)
# answer: program
import re
import string

def gen_plan(state):
    pattern = re.compile(r"object_(?P<number>\d+)", re.IGNORECASE)
    numbers = [int(pattern.match(o.name)["number"]) for o in state.obstacles]
    assert string.Template("$a").substitute(a=1) == "1" and "x".center(3, "*") == "*x*"
    return [Action("repeat", [n + 1]) for n in sorted(numbers)]
