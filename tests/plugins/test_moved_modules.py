"""What was written for an earlier layout goes on loading."""

import importlib
import sys

import pytest

import proc3s
from proc3s.specs.base import Target

pytestmark = pytest.mark.filterwarnings("ignore:.* has moved to:DeprecationWarning")
TARGETS = [
    "proc3s_tabletop.scenes:scene",
    "proc3s_tabletop.judges:on",
    "proc3s_tabletop.judges:still",
    "proc3s_tabletop.formations:grid",
    "proc3s_tabletop.standing:on_another",
    "proc3s_tabletop.programs:PoseMethods",
    "proc3s_tabletop.grasp_sampler:GraspSampler",
    "proc3s_tabletop.world:ReferenceWorld",
    "proc3s_tabletop.execution:ExecutionWorld",
    "proc3s_tabletop.world:pick",
    "proc3s_tabletop.world:place_object",
    "proc3s_tabletop.constraints:grasp",
    "proc3s_tabletop.grasp_screen:grasps",
]


@pytest.mark.parametrize("address", TARGETS)
def test_targets_of_earlier_domain_files_load(address):
    assert callable(Target(target=address).load())


@pytest.mark.parametrize(
    ("module", "name"),
    [
        ("state", "FloatArray"),
        ("state", "PlanBatch"),
        ("world", "Score"),
        ("samplers", "Space"),
        ("problem", "Trial"),
        ("registry", "open_registry"),
        ("options", "RunOptions"),
        ("options", "options_model"),
        ("recordings", "read_recordings"),
        ("asking", "CallOptions"),
        ("events", "RunStarted"),
        ("hookspecs", "hookimpl"),
    ],
)
def test_modules_of_earlier_versions_are_found(module, name):
    assert hasattr(importlib.import_module(f"proc3s.{module}"), name)


def test_an_old_name_warns_whoever_imports_it(monkeypatch):
    monkeypatch.delitem(sys.modules, "proc3s.samplers", raising=False)
    with pytest.warns(DeprecationWarning, match=r"moved to proc3s\.domain\.samplers.*removed") as caught:
        from proc3s.samplers import Space  # noqa: F401
    assert caught[0].filename == __file__


def test_a_name_that_was_never_there_says_where_the_module_is_now():
    with pytest.raises(ImportError, match=r"cannot import name 'nothing'|has moved to"):
        from proc3s.samplers import nothing  # noqa: F401
    with pytest.raises(AttributeError, match=r"moved to proc3s\.domain\.samplers"):
        importlib.import_module("proc3s.samplers").nothing  # noqa: B018


def test_other_modules_are_missed_as_ever():
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("proc3s.never_there")
    assert not hasattr(proc3s, "never_there")
