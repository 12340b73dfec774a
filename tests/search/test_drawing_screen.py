"""The screen of the Drawing domain says just what its world says."""

import dataclasses
import json
import math
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from proc3s import Problem, Rollouts, specs
from proc3s.domain.plan_batch import PlanBatch
from proc3s.plugins.registry import open_registry
from proc3s_drawing.screens import segments_clear

DRAWING = open_registry().domain("drawing")
coordinate = st.floats(-5, 105, allow_subnormal=False) | st.integers(0, 100).map(float)
point = st.tuples(coordinate, coordinate)
discs = st.lists(st.tuples(st.floats(0, 100), st.floats(0, 100), st.floats(0.5, 20)), max_size=6)


@st.composite
def grazing(draw, circles):
    """A line that passes an edge, or begins or ends at one, by as little as a hair; it may be very short."""
    x, y, radius = draw(st.sampled_from(circles))
    turn, tilt = draw(st.floats(0, 2 * math.pi)), draw(st.sampled_from([0.0, 0.3, math.pi / 2]))
    gap = draw(st.sampled_from([-1, 1])) * 10.0 ** draw(st.integers(-13, -1))
    length = 10.0 ** draw(st.integers(-8, 2))
    before = draw(st.sampled_from([0.0, 0.4, 1.0])) * length
    foot = np.array([x, y]) + (radius + 1 + gap) * np.array([math.cos(turn), math.sin(turn)])
    along = np.array([-math.sin(turn + tilt), math.cos(turn + tilt)])
    return tuple((foot - before * along).tolist()), tuple((foot + (length - before) * along).tolist())


@st.composite
def drawings(draw):
    circles = draw(discs)
    line = st.tuples(point, point)
    line = line | grazing(circles) if circles else line
    plans = draw(st.lists(st.lists(line, min_size=1, max_size=4), min_size=1, max_size=5))
    return circles, [[(*p, *q) for p, q in plan] for plan in plans]


def problem_of(circles, domain=DRAWING):
    obstacles = [
        {"name": f"object_{i}", "x_pos": x, "y_pos": y, "radius": r, "color": "red"}
        for i, (x, y, r) in enumerate(circles)
    ]
    scene = json.dumps({"obstacles": obstacles})
    return Problem(domain, domain.spec.tasks["star"], scene, goal="", seed=0, samples=1)


def batch_of(problem, plans):
    lengths = [len(plan) for plan in plans]
    actions = sum(lengths)
    return PlanBatch(
        problem.domain.signatures(problem.initial),
        np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64),
        np.zeros(actions, np.uint8),
        np.arange(actions + 1) * 4,
        np.array([number for plan in plans for line in plan for number in line], float),
    )


def screened(problem, batch):
    return segments_clear(problem.initial, batch, domain=problem.domain)


def in_doubt(problem, trial):
    """Whether less than 2e-6 decides on what the world found, or on what it named."""
    line = trial.plan[trial.reached].args
    clearances = sorted(exact_clearance(o, line) for o in problem.initial.obstacles)
    earlier = [m["collision"] for m in trial.margins[:-1] if "collision" in m]
    near = [c for c in (*earlier, *clearances) if abs(c) < 2e-6]
    return near or (len(clearances) > 1 and clearances[1] - clearances[0] < 2e-6)


def exact_clearance(obstacle, line):
    a, b, c = complex(*line[:2]), complex(*line[2:]), complex(obstacle.x_pos, obstacle.y_pos)
    along = b - a
    t = ((c - a) * along.conjugate()).real / abs(along) ** 2 if abs(along) > 1e-100 else 0.0
    return abs(c - a - min(max(t, 0.0), 1.0) * along) - obstacle.radius - 1


@settings(max_examples=400, deadline=None)
@given(drawings())
def test_the_screen_says_what_the_world_says(drawing):
    circles, plans = drawing
    problem = problem_of(circles)
    batch = batch_of(problem, plans)
    rollouts = Rollouts(problem)
    for i, verdict in enumerate(screened(problem, batch)):
        trial = rollouts(batch.plan(i))
        if verdict is None:
            assert trial.accepted or in_doubt(problem, trial)
            continue
        said = trial.violations[0]
        assert verdict.margin == pytest.approx(said.margin, abs=1e-9)
        assert dataclasses.replace(verdict, margin=said.margin) == said
        assert verdict.step == trial.reached


@settings(max_examples=100, deadline=None)
@given(drawings(), st.data())
def test_a_verdict_does_not_depend_on_the_batch(drawing, data):
    circles, plans = drawing
    problem = problem_of(circles)
    together = screened(problem, batch_of(problem, plans))
    order = data.draw(st.permutations(range(len(plans))))
    shuffled = screened(problem, batch_of(problem, [plans[i] for i in order]))
    assert shuffled == [together[i] for i in order]
    assert [screened(problem, batch_of(problem, [plan]))[0] for plan in plans] == together


def uniform(problem, count, steps, seed=0):
    lines = np.random.default_rng(seed).random((count, steps, 4)) * 100
    return batch_of(problem, lines.tolist())


def crowd():
    state = DRAWING.scene(DRAWING.spec.tasks["star"], 0, {"count": 100, "smallest": 1, "largest": 2})
    return problem_of([(o.x_pos, o.y_pos, o.radius) for o in state.obstacles])


def test_large_batches_and_crowds_agree_with_the_world():
    problem = crowd()
    batch = uniform(problem, 2000, 10)
    verdicts = screened(problem, batch)
    rollouts = Rollouts(problem)
    for i in range(0, 2000, 20):
        said = rollouts(batch.plan(i)).violations[0]
        assert (verdicts[i].step, verdicts[i].text) == (said.step, said.text)


def test_samples_without_a_plan_do_no_harm():
    problem = problem_of([(50.0, 50.0, 10.0)])
    plans = [[(0, 50, 100, 50)], [], [(math.nan, 0, 1, 1)], [(1e300, 0, -1e300, 1)], [(0, 0, 1, 1)]]
    verdicts = screened(problem, batch_of(problem, plans))
    assert verdicts[0].text == "line touches object_0"
    assert verdicts[1] is None
    assert verdicts[4] is None


def changed(**update):
    return dataclasses.replace(DRAWING, spec=DRAWING.spec.model_copy(update=update))


def test_sentences_and_tolerances_are_those_of_the_spec():
    collision = DRAWING.spec.constraints["collision"]
    changes = {"says": "{obstacle} is in the way", "tolerance": 2.0}
    constraints = {**DRAWING.spec.constraints, "collision": collision.model_copy(update=changes)}
    problem = problem_of([(50.0, 50.0, 10.0)], changed(constraints=constraints))
    plans = [[(0.0, 60.0, 100.0, 60.0)], [(0.0, 58.0, 100.0, 58.0)]]
    first, second = screened(problem, batch_of(problem, plans))
    assert first is None
    assert second.text == "object_0 is in the way"


def test_behind_another_skill_the_world_decides():
    other = specs.SkillSpec(
        name="lift", summary="Lifts.", target="proc3s_drawing.world:draw_line", params={"by": {}}
    )
    problem = problem_of([(50.0, 50.0, 10.0)], changed(skills={"lift": other, **DRAWING.spec.skills}))
    signatures = problem.domain.signatures(problem.initial)
    assert [s.skill for s in signatures] == ["lift", "draw_line"]
    batch = PlanBatch(
        signatures,
        np.array([0, 2, 4]),
        np.array([0, 1, 1, 0], np.uint8),
        np.array([0, 1, 5, 9, 10]),
        np.array([7.0, 0, 50, 100, 50, 0, 50, 100, 50, 7.0]),
    )
    first, second = screened(problem, batch)
    assert first is None
    assert (second.step, second.skill, second.text) == (0, "draw_line", "line touches object_0")


def test_a_constraint_of_a_plugin_leaves_all_plans_to_the_world():
    extra = DRAWING.spec.constraints["inside"].model_copy(update={"name": "extra"})
    constraints = {**DRAWING.spec.constraints, "extra": extra}
    problem = problem_of([(50.0, 50.0, 10.0)], changed(constraints=constraints))
    assert screened(problem, batch_of(problem, [[(0.0, 50.0, 100.0, 50.0)]])) == [None]


def test_the_screen_is_many_times_faster_than_the_world():
    problem = problem_of([(20.0, 20.0, 9.0), (70.0, 30.0, 12.0), (50.0, 80.0, 5.0)])
    batch = uniform(problem, 2000, 10)
    screened(problem, batch)
    begun = time.process_time()
    screened(problem, batch)
    numpy = (time.process_time() - begun) / 2000
    rollouts = Rollouts(problem)
    plans = [batch.plan(i) for i in range(200)]
    begun = time.process_time()
    for plan in plans:
        rollouts(plan)
    assert numpy < (time.process_time() - begun) / 200 / 5


def renamed(skills, constraints):
    """The canvas with other names: new -> old."""
    spec = DRAWING.spec
    known = {"skills": (skills, spec.skills), "constraints": (constraints, spec.constraints)}
    update = {
        kind: {new: there[old].model_copy(update={"name": new}) for new, old in names.items()}
        for kind, (names, there) in known.items()
    }
    return dataclasses.replace(DRAWING, spec=spec.model_copy(update=update))


def test_it_knows_lines_and_rules_by_what_they_are_and_not_by_their_names():
    circles, plans = [(50, 50, 10)], [[(10, 50, 90, 50)], [(10, 10, 110, 10)], [(10, 10, 90, 10)]]
    problem = problem_of(circles, renamed({"stroke": "draw_line"}, {"edge": "inside", "disc": "collision"}))
    found = screened(problem, batch := batch_of(problem, plans))
    rollouts = Rollouts(problem)
    assert [trial.violations for trial in map(rollouts, map(batch.plan, range(3)))] == [
        (found[0],),
        (found[1],),
        (),
    ]
    assert [(v.constraint, v.skill) for v in found if v] == [("disc", "stroke"), ("edge", "stroke")]


def test_rules_of_another_order_or_meaning_are_left_to_the_world():
    for constraints in ({"collision": "collision", "inside": "inside"}, {"inside": "inside"}):
        problem = problem_of([(50, 50, 10)], renamed({"draw_line": "draw_line"}, constraints))
        assert screened(problem, batch_of(problem, [[(10, 50, 90, 50)]])) == [None]
