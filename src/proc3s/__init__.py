"""Everything a plugin author imports; names are imported when first used, so `import proc3s` is cheap."""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from proc3s.constraints import Margin as Margin
    from proc3s.constraints import Violation as Violation
    from proc3s.constraints import sentence as sentence
    from proc3s.domain import Domain as Domain
    from proc3s.errors import LLMError as LLMError
    from proc3s.errors import OutOfTime as OutOfTime
    from proc3s.errors import Pending as Pending
    from proc3s.errors import SpecError as SpecError
    from proc3s.errors import UsageError as UsageError
    from proc3s.executors import Executor as Executor
    from proc3s.findings import Finding as Finding
    from proc3s.hookspecs import hookimpl as hookimpl
    from proc3s.llms import LLM as LLM
    from proc3s.llms import Candidate as Candidate
    from proc3s.llms import Completion as Completion
    from proc3s.llms import Message as Message
    from proc3s.llms import Price as Price
    from proc3s.llms import Request as Request
    from proc3s.llms import Sampling as Sampling
    from proc3s.llms import Usage as Usage
    from proc3s.llms import answer as answer
    from proc3s.llms import digest as digest
    from proc3s.plugins import import_loose_file as import_loose_file
    from proc3s.plugins import loose_files as loose_files
    from proc3s.problem import Problem as Problem
    from proc3s.problem import Trial as Trial
    from proc3s.problem import rollout as rollout
    from proc3s.rollouts import Rollouts as Rollouts
    from proc3s.samplers import Sampler as Sampler
    from proc3s.samplers import Space as Space
    from proc3s.secrets import platform_name as platform_name
    from proc3s.secrets import redacted as redacted
    from proc3s.secrets import without_secrets as without_secrets
    from proc3s.solving import Solver as Solver
    from proc3s.specfile import load_domain as load_domain
    from proc3s.specs import ConstraintSpec as ConstraintSpec
    from proc3s.specs import DomainSpec as DomainSpec
    from proc3s.specs import ExecutorSpec as ExecutorSpec
    from proc3s.specs import LLMSpec as LLMSpec
    from proc3s.specs import MethodSpec as MethodSpec
    from proc3s.specs import PresetSpec as PresetSpec
    from proc3s.specs import SamplerSpec as SamplerSpec
    from proc3s.specs import ScreenSpec as ScreenSpec
    from proc3s.specs import SkillSpec as SkillSpec
    from proc3s.specs import SolverSpec as SolverSpec
    from proc3s.specs import TemplatesSpec as TemplatesSpec
    from proc3s.state import Action as Action
    from proc3s.state import FloatArray as FloatArray
    from proc3s.state import Plan as Plan
    from proc3s.state import PlanBatch as PlanBatch
    from proc3s.state import Pose as Pose
    from proc3s.state import State as State
    from proc3s.suites.spec import SuiteSpec as SuiteSpec
    from proc3s.suites.spec import load_suite as load_suite
    from proc3s.world import Score as Score
    from proc3s.world import Transition as Transition
    from proc3s.world import World as World

_WHERE = {
    "constraints": ("Margin", "Violation", "sentence"),
    "domain": ("Domain",),
    "errors": ("LLMError", "OutOfTime", "Pending", "SpecError", "UsageError"),
    "executors": ("Executor",),
    "findings": ("Finding",),
    "hookspecs": ("hookimpl",),
    "llms": (
        "LLM",
        "Candidate",
        "Completion",
        "Message",
        "Price",
        "Request",
        "Sampling",
        "Usage",
        "answer",
        "digest",
    ),
    "problem": ("Problem", "Trial", "rollout"),
    "plugins": ("import_loose_file", "loose_files"),
    "rollouts": ("Rollouts",),
    "samplers": ("Sampler", "Space"),
    "secrets": ("platform_name", "redacted", "without_secrets"),
    "solving": ("Solver",),
    "specfile": ("load_domain",),
    "specs": (
        "ConstraintSpec",
        "DomainSpec",
        "ExecutorSpec",
        "LLMSpec",
        "MethodSpec",
        "PresetSpec",
        "SamplerSpec",
        "ScreenSpec",
        "SkillSpec",
        "SolverSpec",
        "TemplatesSpec",
    ),
    "suites.spec": ("SuiteSpec", "load_suite"),
    "state": ("Action", "FloatArray", "Plan", "PlanBatch", "Pose", "State"),
    "world": ("Score", "Transition", "World"),
}
_MODULES = {name: module for module, names in _WHERE.items() for name in names}

__all__ = [*_MODULES]


def __getattr__(name: str) -> Any:
    if name not in _MODULES:
        raise AttributeError(f"module 'proc3s' has no attribute {name!r}")
    return getattr(importlib.import_module(f"proc3s.{_MODULES[name]}"), name)
