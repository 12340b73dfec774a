"""The seven methods of the paper over the one loop, and the presets."""

from collections.abc import Callable
from pathlib import Path

from proc3s import MethodSpec, PresetSpec, SuiteSpec, hookimpl, load_suite

_FEEDBACK_ROUNDS = 5  # PRoC3S, section 5: up to five rounds of feedback

METHODS = (
    MethodSpec(
        name="proc3s",
        summary="A program with open parameters and samplers for them; failures go back to the LLM.",
        template="proc3s",
        answer="sketch",
        rounds=_FEEDBACK_ROUNDS,
    ),
    MethodSpec(
        name="proc3s-nf",
        summary="PRoC3S without feedback.",
        template="proc3s",
        answer="sketch",
    ),
    MethodSpec(
        name="cap",
        summary="Code as Policies: a program of the state alone, executed unchecked.",
        template="cap",
        answer="program",
        samples="none",
        fallback="last_plan",
    ),
    MethodSpec(
        name="cap-gaussian",
        summary="Code as Policies with Gaussian noise on every number; else the plan itself is executed.",
        template="cap",
        answer="program",
        perturb="gaussian",
        fallback="last_plan",
        solver="gaussian",
    ),
    MethodSpec(
        name="llm3",
        summary="The LLM writes the ground plan itself, checked once a round; the last is executed anyway.",
        template="llm3",
        answer="plan",
        samples="one",
        fallback="last_plan",
        rounds=_FEEDBACK_ROUNDS,
    ),
    MethodSpec(
        name="llm3-nf",
        summary="LLM3 without feedback.",
        template="llm3",
        answer="plan",
        samples="one",
        fallback="last_plan",
    ),
    MethodSpec(
        name="llm3-gaussian",
        summary="LLM3 with Gaussian noise on every number of the plan.",
        template="llm3",
        answer="plan",
        perturb="gaussian",
        fallback="last_plan",
        rounds=_FEEDBACK_ROUNDS,
        solver="gaussian",
    ),
)

PRESETS = (
    PresetSpec(
        name="paper",
        summary="The protocol of the paper: its budgets, feedback as the two commonest failures.",
        budget="paper",
    ),
    PresetSpec(
        name="release",
        summary="The budgets of the authors' released configurations, else as the paper.",
        budget="release",
    ),
    PresetSpec(
        name="best",
        summary="Everything on: portfolio search, the goal checked, rehearsals, plans with room, graded "
        "feedback, repairs, restarts.",
        budget="paper",
        solver="portfolio",
        feedback="graded",
        check_goal=True,
        improve=24,
        rehearsals=2,
        screens="all",
        repairs=2,
        restart_after=2,
        state_constraints=True,
    ),
)


@hookimpl
def register_methods(register: Callable[[MethodSpec | PresetSpec | SuiteSpec], None]) -> None:
    """Seven methods, three presets, and the suites of `bench/*.yaml`."""
    for spec in (*METHODS, *PRESETS):
        register(spec)
    for path in sorted((Path(__file__).parent / "bench").glob("*.yaml")):
        register(load_suite(path))
