"""One worker or many, cache or none: the same plan, the same trials, the same counters."""

import os
import signal
import time
from multiprocessing import active_children

import numpy as np
import pytest

from proc3s import Action, SpecError, UsageError
from proc3s.search.evaluator import Evaluator
from proc3s_executors.processes import Processes

from .conftest import Walks

ALL = {"budget": 150, "seed": 1, "exhaust": True}


def backtracking(space, budget, rng):
    from proc3s_solvers.backtracking import Backtracking, BacktrackingOptions

    return Backtracking(space, budget, rng, BacktrackingOptions())


@pytest.fixture(params=["one", "two", "four"])
def processes(request):
    return request.getfixturevalue(request.param)


@pytest.mark.slow
@pytest.mark.parametrize("prefixes", [True, False], ids=["cache", "no cache"])
@pytest.mark.parametrize("screened", [False, True], ids=["bare", "screened"])
@pytest.mark.parametrize("seed", [1, 2])
def test_processes_find_what_serial_finds(problem, search, serial, processes, prefixes, screened, seed):
    names, stateful = (("listed",), ("Guard",)) if screened else ((), ())
    made = problem(*names, stateful=stateful, prefixes=prefixes)
    plain = problem(*names, stateful=stateful, prefixes=False)
    expected = search(plain, serial, seed=seed, audit=20)
    found = search(made, processes, seed=seed, audit=20)
    assert found == expected
    assert repr(found.trials) == repr(expected.trials)


def test_a_solver_that_learns_takes_the_same_path(problem, search, serial, two):
    plain = search(problem(prefixes=False), serial, backtracking, seed=2)
    assert search(problem(), serial, backtracking, seed=2) == plain
    assert search(problem(), two, backtracking, seed=2) == plain


def test_screens_change_the_work_and_not_the_result(problem, search, serial):
    bare, screened = search(problem(), serial), search(problem("listed"), serial)
    assert bare.plan == screened.plan
    assert bare.samples == screened.samples
    assert screened.evaluations == bare.evaluations - screened.rejected_by["listed"]
    assert [t.violations for t in bare.trials] == [t.violations for t in screened.trials]


@pytest.mark.parametrize(("prefixes", "expected"), [(True, 5 + 2 + 1), (False, 5 + 5 + 5)])
def test_prefixes_save_steps(problem, serial, tmp_path, prefixes, expected):
    made = problem(world={"count": str(tmp_path / "steps")}, prefixes=prefixes)
    legal = [0.5, 0.5, 0.62, 0.66, 0.55]
    u = np.array([legal, [*legal[:3], 0.67, 0.55], [*legal[:4], 0.56]])
    trials = list(Evaluator(made, Walks(made), serial).stream(u))
    assert [trial.accepted for trial in trials] == [True] * 3
    assert [len(trial.margins) for trial in trials] == [5] * 3
    assert stepped(tmp_path / "steps") == expected


def test_a_cache_that_is_too_small_forgets_and_stays_right(problem, search, serial, monkeypatch):
    from proc3s.plugins.loose_files import import_loose_file

    from .conftest import LOOSE

    expected = search(problem(prefixes=False), serial, backtracking, seed=2)
    for size in (1, 2, 7):
        monkeypatch.setattr(import_loose_file(LOOSE).Walk, "most_prefixes", size)
        assert search(problem(), serial, backtracking, seed=2) == expected


def stepped(count):
    return len(count.read_text()) if count.exists() else 0


@pytest.mark.slow
def test_a_killed_worker_costs_time_and_no_result(problem, search, serial, tmp_path):
    slow = problem(world={"seconds": 0.002, "count": str(tmp_path / "steps")})
    expected = search(problem(), serial, **ALL)
    executor = Processes(2)
    killed = 0

    class Killing:
        def map(self, problem, plans):
            nonlocal killed
            for number, trial in enumerate(executor.map(problem, plans)):
                if number in (3, 40):
                    os.kill(active_children()[0].pid, signal.SIGKILL)
                    killed += 1
                yield trial

        def close(self):
            executor.close()

    try:
        assert search(slow, Killing(), **ALL) == expected
    finally:
        executor.close()
    assert killed >= 2


@pytest.mark.slow
def test_a_plan_that_kills_its_worker_costs_that_plan_alone(problem, search, two, serial):
    """One in about fifty plans takes the simulator down; all others get their verdicts."""
    deadly = search(problem(world={"deadly": (14.0, 14.6)}), two, budget=60, exhaust=True)
    whole = search(problem(), serial, budget=60, exhaust=True)
    crashed = [trial for trial in deadly.trials if "crashed" in "".join(v.text for v in trial.violations)]
    assert 1 <= len(crashed) < 4
    others = [(a, b) for a, b in zip(deadly.trials, whole.trials, strict=True) if a not in crashed]
    assert all(a == b for a, b in others)


def test_workers_that_keep_dying_are_given_up(problem, monkeypatch):
    executor = Processes(1)
    made = problem(world={"seconds": 0.2})
    submit = executor._submit

    def and_kill(key, chunk):
        future = submit(key, chunk)
        for child in active_children():
            child.kill()
        return future

    monkeypatch.setattr(executor, "_submit", and_kill)
    try:
        with pytest.raises(UsageError, match="worker processes died; is there memory enough for --jobs 1"):
            list(executor.map(made, [(Action("hop", (1.0,)),)] * 4))
    finally:
        executor.close()


def test_closing_the_stream_cancels_what_is_not_done(problem, two, tmp_path):
    count = tmp_path / "steps"
    made = problem(world={"seconds": 0.004, "count": str(count)})
    stream = Evaluator(made, Walks(made), two).stream(np.full((400, 5), 0.1) + np.arange(400)[:, None] / 1e4)
    next(stream)
    begun = time.monotonic()
    stream.close()
    assert time.monotonic() - begun < 1
    time.sleep(0.3)  # what was under way comes to its end
    after = stepped(count)
    time.sleep(0.3)
    assert stepped(count) == after < 400


@pytest.mark.parametrize("name", ["serial", "two"])
def test_an_error_of_a_skill_is_named(request, problem, search, name):
    made = problem(world={"broken_at": 66.0})
    with pytest.raises(SpecError) as caught:
        search(made, request.getfixturevalue(name), **ALL)
    assert "skill hop" in str(caught.value)
    assert "raised RuntimeError: the simulator gave up" in str(caught.value)
    assert "walk.py:" in str(caught.value)


def test_trials_before_an_error_are_kept_by_every_executor(problem, serial, two):
    made = problem(world={"broken_at": 66.0})
    u = np.random.default_rng(4).random((200, 5))
    counts = []
    for executor in (serial, two):
        evaluator = Evaluator(made, Walks(made), executor)
        with pytest.raises(SpecError):
            list(evaluator.stream(u))
        counts.append((evaluator.samples, evaluator.evaluations))
    assert counts[0] == counts[1]
    assert counts[0][0] > 0


def test_an_accepted_plan_before_an_error_is_found(problem, serial, two):
    made = problem(world={"broken_at": 88.0})
    good, broken = [0.5, 0.5, 0.62, 0.66, 0.55], [0.5, 0.5, 0.62, 0.66, 0.99]
    u = np.array([good, broken, broken, broken])
    for executor in (serial, two):
        assert next(Evaluator(made, Walks(made), executor).stream(u)).accepted


def test_workers_change_worlds_with_the_problem(problem, search, serial, two):
    for limit in (100.0, 60.0):
        made = problem(stateful=("Guard",))
        spec = made.domain.spec.screens[0].model_copy(update={"args": {"limit": limit}})
        import dataclasses

        domain = dataclasses.replace(
            made.domain, spec=made.domain.spec.model_copy(update={"screens": (spec,)})
        )
        made = dataclasses.replace(made, domain=domain)
        assert search(made, two) == search(made, serial)


def test_equal_plans_are_rolled_out_once(problem, search, serial, two):
    found = search(problem(), two, decimals=-1, **ALL)
    assert found == search(problem(), serial, decimals=-1, **ALL)
    assert found.evaluations == len({t.plan for t in found.trials}) < found.samples


def busy(problem, executor, u):
    begun = time.perf_counter()
    trials = list(Evaluator(problem, Walks(problem), executor).stream(u))
    return time.perf_counter() - begun, trials


@pytest.mark.slow
def test_two_processes_are_nearly_twice_as_fast(problem, serial):
    """Steps that wait, so that the ratio says what the executor costs and not what else the machine does."""
    made = problem(world={"asleep": 0.004}, prefixes=False)
    u = np.random.default_rng(0).random((100, 5)) * 0.3
    executor = Processes(2)
    try:
        busy(made, executor, u[:8])
        ratios = []
        for _ in range(4):
            alone, expected = busy(made, serial, u)
            together, trials = busy(made, executor, u)
            assert trials == expected
            ratios.append(alone / together)
    finally:
        executor.close()
    assert max(ratios) >= 1.7
