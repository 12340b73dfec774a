"""Everything a plugin author or a script imports; names are imported when first used.

`__init__.pyi` says where each name is from.
"""

import lazy_loader

from proc3s.moved import MovedModules

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

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
