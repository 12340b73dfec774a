# Corners by product, pairs by pairwise, a cycle closed by chain.
# expect: plan: draw_line(10.00, 10.00, 10.00, 20.00); draw_line(10.00, 20.00, 20.00, 10.00); draw_line(20.00, 10.00, 20.00, 20.00); draw_line(20.00, 20.00, 10.00, 10.00)
# answer: program
from itertools import chain, islice, pairwise, product

def gen_plan(state):
    corners = list(product((10, 20), repeat=2))
    closed = chain(corners, islice(corners, 1))
    return [Action("draw_line", [*a, *b]) for a, b in pairwise(closed)]
