# Corners by product, pairs by pairwise, a cycle closed by chain.
# expect: plan: draw_line(10, 10, 10, 20); draw_line(10, 20, 20, 10); draw_line(20, 10, 20, 20); draw_line(20, 20, 10, 10)
# answer: program
from itertools import chain, islice, pairwise, product

def gen_plan(state):
    corners = list(product((10, 20), repeat=2))
    closed = chain(corners, islice(corners, 1))
    return [Action("draw_line", [*a, *b]) for a, b in pairwise(closed)]
