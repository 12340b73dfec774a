# The plan with its values one by one.
# expect: plan: draw_line(1, 2, 3, 4); repeat(2)
# answer: plan
from math import sqrt
gen_plan = (Action("draw_line", 1, 2, 3, sqrt(16)), Action("repeat", 2))
