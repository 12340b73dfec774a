# Fills the memory with a regular expression.
# expect: SketchMemoryError: MemoryError
# answer: plan
import re
re.compile("|".join("a" * i for i in range(20000)))
gen_plan = [Action("repeat", [1])]
