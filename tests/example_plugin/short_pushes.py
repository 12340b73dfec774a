from proc3s import ConstraintSpec, hookimpl


def short(transition):
    _, dx, dy = transition.action.args
    return 0.8 - (dx**2 + dy**2) ** 0.5


@hookimpl
def register_constraints(register):
    says = "a push is longer than 0.8 m"
    register(ConstraintSpec(name="short", says=says, target="short_pushes:short", domains=("push",)))
