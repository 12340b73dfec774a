"""Every hook of a plugin has its effect on the command line. A test is named after the hook that it tests."""

import textwrap

import pytest

from proc3s.plugins import hookspecs

STAR = ("run", "drawing/star", "--llm", "replay")


@pytest.fixture
def plugin(here):
    """Writes a plugin of one hook; gives the options that load it."""

    def write(name, text):
        path = here / f"{name}.py"
        path.write_text("from proc3s import *\n" + textwrap.dedent(text))
        return ("--plugin", path)

    return write


def test_every_hook_has_a_test():
    for name, value in vars(hookspecs).items():
        if hasattr(value, "proc3s_spec"):
            assert f"test_{name}" in globals(), f"no test of the hook {name}"


def test_register_domains(cli, here, plugin):
    (here / "dot.yaml").write_text(
        textwrap.dedent("""
        spec_version: 1
        name: dots
        summary: Dots.
        world: {target: "proc3s:World"}
        state: Dots
        types: {Dots: {summary: Dots., fields: {count: {type: int}}}}
        skills: {add: {summary: Adds dots., target: "hook_domains:add", params: {by: {type: float}}}}
        samplers: [ContinuousSampler]
        constraints: {few: {says: too many dots, target: "hook_domains:few"}}
        tasks: {three: {instruction: Make three dots., initial: {target: "hook_domains:none"}}}
        budget: {paper: 10}
        """)
    )
    given = plugin(
        "hook_domains",
        """
        from pathlib import Path

        @hookimpl
        def register_domains(register):
            register(load_domain(Path(__file__).with_name("dot.yaml")))

        def none(rng): return {"count": 0}
        def add(world, by): pass
        def few(transition): return 3.0
        """,
    )
    (here / "program.py").write_text("def gen_plan(initial):\n    return [Action('add', [1.0])]\n")
    done = cli("solve", "dots/three", "--sketch", "program.py", "--method", "cap", *given, "--json")
    assert done.json["plan"] == [{"skill": "add", "args": [1.0]}]


def test_register_skills(cli, plugin):
    given = plugin(
        "hook_skills",
        """
        @hookimpl
        def register_skills(register):
            register(SkillSpec(name="erase", summary="Erases all.", params={}, domains=("drawing",),
                               target="hook_skills:erase"))

        def erase(world): pass
        """,
    )
    assert "erase" in cli("render-prompt", "drawing/star", *given).stdout
    assert "erase" not in cli("render-prompt", "drawing/star").stdout


def test_register_samplers(cli, plugin):
    given = plugin(
        "hook_samplers",
        """
        @hookimpl
        def register_samplers(register):
            register(SamplerSpec(name="DiceSampler", summary="Throws a die.", params={}, domains=("*",),
                                 target="hook_samplers:Dice"))

        class Dice:
            dim = 1
            def decode(self, u): return 1 + (6 * u).astype(int)
        """,
    )
    assert "DiceSampler" in cli("render-prompt", "drawing/star", *given).stdout


def test_register_constraints(cli, plugin):
    given = plugin(
        "hook_constraints",
        """
        @hookimpl
        def register_constraints(register):
            register(ConstraintSpec(name="silence", says="no line is wanted", domains=("drawing",),
                                    target="hook_constraints:never"))

        def never(transition): return -1.0
        """,
    )
    done = cli(*STAR, "--samples", 20, "--feedback", 0, "--no-screens", "--json", *given)
    assert "no line is wanted" in {violation["text"] for violation in done.json["violations"]}


def test_register_methods(cli, plugin):
    given = plugin(
        "hook_methods",
        """
        @hookimpl
        def register_methods(register):
            register(MethodSpec(name="mine", summary="Mine.", template="proc3s", answer="sketch"))
        """,
    )
    done = cli(*STAR, "--method", "mine", "--json", *given)
    assert (done.json["method"], done.json["solved"]) == ("mine", True)


def test_register_solvers(cli, plugin):
    given = plugin(
        "hook_solvers",
        """
        import numpy as np

        @hookimpl
        def register_solvers(register):
            register(SolverSpec(name="middle", summary="The middle.", target="hook_solvers:Middle"))

        class Middle:
            def __init__(self, space, budget, rng, options): self._dim, self._left = space.dim, 1
            def ask(self, limit):
                self._left, count = 0, self._left
                return np.full((count, self._dim), 0.5)
            def tell(self, trials): pass
        """,
    )
    done = cli(*STAR, "--solver", "middle", "--feedback", 0, "--json", *given)
    assert (done.json["solver"], done.json["samples"]) == ("middle", 1)


BACKEND = """
    class Silent(LLM):
        def __init__(self, model, options): self._model = model
        def complete(self, request): return answer("I do not know.", self._model)
    """


def test_register_llms(cli, plugin):
    given = plugin(
        "hook_llms",
        BACKEND
        + """
    @hookimpl
    def register_llms(register):
        register(LLMSpec(name="silent", summary="Knows nothing.", usage="silent", target="hook_llms:Silent"))
    """,
    )
    done = cli("run", "drawing/star", "--llm", "silent", "--feedback", 0, "--json", *given)
    assert (done.json["llm"], done.json["llm_source"], done.json["solved"]) == ("silent", "live", False)


def test_resolve_llm(cli, here, plugin):
    given = plugin(
        "hook_resolve",
        BACKEND
        + """
    @hookimpl
    def resolve_llm(model):
        if model.startswith("quiet-"):
            return LLMSpec(name="quiet", summary="", usage="quiet-N", target="hook_resolve:Silent")
    """,
    )
    done = cli("run", "drawing/star", "--llm", "quiet-7", "--feedback", 0, "--out", "run", *given)
    assert done.code == 1
    assert '"model": "quiet-7"' in (here / "run" / "events.jsonl").read_text()


def test_register_executors(cli, here, plugin):
    given = plugin(
        "hook_executors",
        """
        from pathlib import Path
        from proc3s_executors.serial import Serial

        @hookimpl
        def register_executors(register):
            register(ExecutorSpec(name="noted", summary="Takes notes.", target="hook_executors:Noted"))

        class Noted(Serial):
            def map(self, problem, plans):
                Path("noted").touch()
                return super().map(problem, plans)
        """,
    )
    assert cli(*STAR, "--executor", "noted", *given).code == 0
    assert (here / "noted").exists()


def test_register_templates(cli, here, plugin):
    (here / "mine" / "partials").mkdir(parents=True)
    (here / "mine" / "partials" / "samplers.j2").write_text("Any number will do.")
    given = plugin(
        "hook_templates",
        """
        from pathlib import Path

        @hookimpl
        def register_templates(register):
            register(TemplatesSpec(name="mine", summary="Mine.", folder=Path(__file__).parent / "mine"))
        """,
    )
    assert "Any number will do." in cli("render-prompt", "drawing/star", *given).stdout


def test_prompt_context(cli, here, plugin):
    (here / "mine" / "partials").mkdir(parents=True)
    (here / "mine" / "partials" / "samplers.j2").write_text("Advice: {{ advice }}")
    given = plugin(
        "hook_context",
        """
        @hookimpl
        def prompt_context(problem, method):
            return {"advice": f"{method.name} draws in {problem.domain.spec.name}"}
        """,
    )
    shown = cli("render-prompt", "drawing/star", "--template-dir", "mine", *given)
    assert "Advice: proc3s draws in drawing" in shown.stdout


def test_on_event(cli, here, plugin):
    given = plugin(
        "hook_event",
        """
        from pathlib import Path

        @hookimpl
        def on_event(event):
            with Path("heard").open("a") as file:
                print(event.event, file=file)
        """,
    )
    cli(*STAR, *given)
    heard = (here / "heard").read_text().split()
    assert (heard[0], heard[-1]) == ("run_started", "run_ended")
    assert {"prompt_rendered", "answer_received", "batch_evaluated", "plan_executed"} <= set(heard)
