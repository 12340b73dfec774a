"""The domain Arrange-Blocks with the skills and constraints of the toolbox, and states of it."""

from proc3s import Domain
from proc3s_blocks import register_domains
from proc3s_tabletop import register_constraints, register_skills


def registered(hook):
    """What a hook registers, by name."""
    found = {}
    hook(lambda spec: found.setdefault(spec.name, spec))
    return found


def blocks_domain():
    """Arrange-Blocks as a registry would merge it."""
    spec = registered(register_domains)["blocks"]
    attached = {"skills": registered(register_skills), "constraints": registered(register_constraints)}
    return Domain(spec.model_copy(update=attached), ())


def belief(domain, *things):
    """A state of (category, colour, x, y, z) or (category, colour, x, y, z, roll, pitch, yaw)."""
    objects = {}
    for k, (category, color, *pose) in enumerate(things):
        numbers = dict(zip(("x", "y", "z", "roll", "pitch", "yaw"), pose, strict=False))
        objects[f"object_{k}"] = {"category": category, "color": color, "pose": numbers}
    return domain.states.parse({"objects": objects})
