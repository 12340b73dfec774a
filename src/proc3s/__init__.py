"""Everything a plugin author or a script imports; names are imported when first used.

`__init__.pyi` says where each name is from.
"""

import importlib
from typing import Any

from proc3s.moved import MovedModules

# Little is imported here: under `python -m proc3s` the working directory is still on the path (__main__.py).
with open(f"{__file__}i", encoding="utf-8") as _stub:  # noqa: PTH123 - for the same reason
    _HOMES = {line.split()[3]: line.split()[1] for line in _stub}

__all__ = [*_HOMES]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    importlib.import_module("proc3s.errors").refuse_windows()
    return getattr(importlib.import_module(_HOMES[name], __name__), name)


def __dir__() -> list[str]:
    return __all__


MovedModules(
    __name__,
    {
        "asking": ["llm.call_options", "llm.candidates"],
        "config": ["llm.config"],
        "constraints": ["domain.margins"],
        "events": ["runs.events"],
        "executors": ["search.executor"],
        "hookspecs": ["plugins.hookspecs", "markers"],
        "llms": ["llm.types", "llm.usage"],
        "options": ["planning.options", "planning.setup", "plugins.part_options"],
        "planner": ["planning.planner"],
        "problem": ["search.problem", "search.trial", "search.rollout"],
        "recordings": ["runs.recordings", "llm.recorder"],
        "registry": ["plugins.registry"],
        "samplers": ["domain.samplers"],
        "secrets": ["redaction"],
        "solving": ["search.solver", "search.search"],
        "specfile": ["specs.yaml_files", "specs.yaml_reader"],
        "state": ["domain.values", "domain.state", "domain.plan_batch"],
        "world": ["domain.world"],
    },
).install()
