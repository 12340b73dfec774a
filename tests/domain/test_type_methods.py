"""Types of a domain may have methods: the prompt shows them, programs call them."""

import dataclasses

import numpy as np
import pytest

import toy_world
from proc3s import SpecError
from proc3s.domain.prelude import setup_code
from proc3s.planning.grounding import open_sketch
from proc3s.planning.options import RunOptions
from proc3s.planning.setup import make_setup
from proc3s.plugins.registry import open_registry

PROGRAM = """
def gen_plan(initial, by):
    return [Action("slide", ["object_0", initial["object_1"].beyond(by) + initial.beads[0].half])]

def gen_domain(initial):
    return {"by": ContinuousSampler(2, 2)}
"""


class BeadMethods:
    """Not shown: only what it defines is."""

    @property
    def half(self):
        """Half its place, m."""
        return self.place / 2

    def beyond(self, by):
        """A place further on, m."""
        return self.place + by


class SceneMethods:
    def __getitem__(self, name):
        return next(bead for bead in self.beads if bead.name == name)


class NoMethods:
    value = 1


def with_methods(folder, bead="BeadMethods"):
    text = toy_world.DOMAIN.replace(
        "summary: A bead.", f'summary: A bead.\n    methods: "test_type_methods:{bead}"'
    ).replace("summary: The wire.", 'summary: The wire.\n    methods: "test_type_methods:SceneMethods"')
    return toy_world.problem(folder, text)


def test_the_prompt_shows_them_as_they_are(tmp_path):
    code = setup_code(with_methods(tmp_path).domain)
    assert '    @property\n    def half(self):\n        """Half its place, m."""\n' in code
    assert "BeadMethods" not in code
    compile(code, "setup", "exec")


def test_programs_call_them(tmp_path):
    options = RunOptions(task="toy/shift")
    setup = dataclasses.replace(
        make_setup(open_registry([]), options, toy_world.problem(tmp_path)), problem=with_methods(tmp_path)
    )
    with open_sketch(setup, PROGRAM) as opened:
        batch = opened.sketch.plans(np.array([[0.5]]), 0)
    assert batch.plan(0)[0].args == ("object_0", 3.0)


@pytest.mark.parametrize("name", ["NoMethods", "Missing"])
def test_a_class_without_methods_is_a_mistake(tmp_path, name):
    with pytest.raises(SpecError, match="test_type_methods"):
        setup_code(with_methods(tmp_path, name).domain)
