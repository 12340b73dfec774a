# An exception that raises when it is shown, of a class that raises when it is named.
# expect: SketchCrash: process died (exit code 1)
# answer: program
class Meta(type):
    __name__ = property(lambda self: 1 / 0)

class Bad(Exception, metaclass=Meta):
    def __str__(self):
        raise SystemExit

def gen_plan(state):
    raise Bad
