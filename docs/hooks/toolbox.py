"""The page of the table-top toolbox: what a `domain.yaml` may say of bodies, scenes and judges."""

import inspect
from importlib.util import find_spec
from typing import Any

import models
import names
from words import render


def pages() -> dict[str, str]:
    """Markdown by its place in the site; nothing where the toolbox is not installed."""
    if find_spec("pybullet") is None:
        return {}
    from proc3s_tabletop.catalogue import body_specs
    from proc3s_tabletop.tasks import judges, scenes

    bodies = models.tables(*body_specs.SHAPES.values())
    entries = models.tables(scenes.Entry)
    found = [_judge(f) for f in vars(judges).values() if inspect.isfunction(f) and _is_judge(f, judges)]
    return {"reference/table-top.md": render("toolbox.md.j2", bodies=bodies, entries=entries, judges=found)}


def _is_judge(function: Any, module: Any) -> bool:
    public = function.__module__ == module.__name__ and not function.__name__.startswith("_")
    return public and list(inspect.signature(function).parameters)[:2] == ["state", "plan"]


def _judge(function: Any) -> dict[str, str]:
    """Without the state and the plan, which every judge is given."""
    call = names.signature(function).replace("state: Any, plan: Plan, ", "")
    return {"name": function.__name__, "signature": call, "doc": inspect.getdoc(function) or ""}
