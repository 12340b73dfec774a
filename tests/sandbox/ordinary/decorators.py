# Decorators of its own, partial, reduce, singledispatch.
# expect: plan: repeat(6); draw_line(1, 2, 3, 3)
# answer: program
import functools
import operator

def logged(function):
    @functools.wraps(function)
    def inner(*args, **kwargs):
        print(function.__name__)
        return function(*args, **kwargs)
    return inner

@functools.singledispatch
def as_list(value):
    return [value]

@as_list.register
def _(value: tuple):
    return list(value)

@logged
def gen_plan(state):
    line = functools.partial(Action, "draw_line")
    product = functools.reduce(operator.mul, [1, 2, 3])
    return [Action("repeat", as_list(product)), line(as_list((1, 2, 3, 3)))]
