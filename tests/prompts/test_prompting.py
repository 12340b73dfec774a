from pathlib import Path

import pytest

import proc3s_templates
import toy_world
from proc3s import MethodSpec, PresetSpec, SpecError, UsageError
from proc3s.feedback.report import ConstraintReport, Diagnosis, Failure
from proc3s.prompts.conversation import Exchange, conversation
from proc3s.prompts.prompter import Prompter
from proc3s.prompts.text import state_text

METHOD = MethodSpec(name="mine", summary="", template="mine", answer="sketch")
PRESET = PresetSpec(name="paper", summary="", budget="paper")
BUILT_IN = Path(proc3s_templates.__file__).parent


@pytest.fixture
def problem(tmp_path):
    return toy_world.problem(tmp_path)


@pytest.fixture
def system(tmp_path, problem):
    """The system message that a template gives."""
    folder = tmp_path / "templates"

    def render(text, context=None, **files):
        for name, content in {"mine": text, **files}.items():
            path = folder / "methods" / f"{name}.j2"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(content, encoding="utf-8")
        return Prompter(METHOD, PRESET, (folder,), context or {}).system(problem).text

    return render


def test_what_a_template_sees(system):
    text = system(
        "{{ domain.name }} {{ domain.skills.slide.params | join(',') }} {{ method.name }} {{ preset.top }}"
        " {{ samplers | map(attribute='name') | join }} {{ 'class Scene' in setup_code }} {{ extra }}",
        {"extra": "from a plugin"},
    )
    assert text == "toy bead,by mine 2 ContinuousSampler True from a plugin"


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("one\ntwo {{ domian.name }}", 2, "domian"),
        ("{{ domain.nam }}", 1, "nam"),
        ("one\n\n{% if x %}\n", 3, ""),
        ("one\n{{ domain.name | upperr }}", 2, "upperr"),
        ("one\ntwo\n{{ 1 // 0 }}", 3, "zero"),
        ("{{ 'a' + 1 }}", 1, ""),
        ("\n{{ domain.skills['lift'].name }}", 2, "lift"),
        ("\n{{ range(10000000) | list }}", 2, "ange"),
        ("\n{{ 'x' | int('a', 99) + {}.a }}", 2, ""),
    ],
)
def test_a_template_that_does_not_render_is_named_with_its_line(system, text, line, words):
    with pytest.raises(SpecError) as error:
        system(text)
    where, _, rest = str(error.value).partition(": ")
    assert where.endswith(f"methods/mine.j2:{line}")
    assert words in rest


def test_an_error_in_an_included_part_names_that_part(system):
    with pytest.raises(SpecError, match=r"methods/part\.j2:2: .*domian"):
        system("a\nb\nc\n{% include 'methods/part.j2' %}", part="x\n{{ domian }}")


def test_a_template_that_includes_itself_is_an_error_of_the_spec(system):
    with pytest.raises(SpecError):
        system("{% include 'methods/mine.j2' %}")


@pytest.mark.parametrize("text", ["{% include 'partials/nothing.j2' %}", "{% extends 'methods/min.j2' %}"])
def test_a_part_that_is_not_there(system, text):
    with pytest.raises(UsageError, match=r"there is no template '(partials/nothing|methods/min)\.j2'"):
        system(text)


def test_a_method_whose_template_is_not_there(problem, tmp_path):
    folder = tmp_path / "methods"
    folder.mkdir()
    (folder / "mime.j2").write_text("")
    with pytest.raises(
        UsageError, match=r"there is no template 'methods/mine\.j2'.*did you mean 'methods/mime\.j2'"
    ):
        Prompter(METHOD, PRESET, (tmp_path,)).system(problem)


@pytest.mark.parametrize(
    "text",
    [
        "{{ domain.__class__ }}",
        "{{ ''.__class__.__mro__ }}",
        "{{ domain['__class__'] }}",
        "{{ domain | attr('__class__') }}",
        "{{ self.__init__.__globals__ }}",
        "{{ lipsum.__globals__ }}",
        "{{ '{0.__class__}'.format(domain) }}",
        "{{ domain.model_copy.__func__ }}",
        "{{ cycler.__init__.__globals__.os }}",
    ],
)
def test_a_template_cannot_reach_the_machinery_of_python(system, text):
    with pytest.raises(SpecError):
        system(text)


@pytest.mark.parametrize(
    "text",
    [
        "{{ domain.world.load() }}",
        "{{ domain.world.model_copy(update={'target': 'os:getpid'}).load()() }}",
        "{{ domain.folder.joinpath('leak').write_text('x') }}",
        "{{ domain.folder.joinpath('domain.yaml').read_text() }}",
    ],
)
def test_a_template_cannot_import_or_touch_files(system, tmp_path, text):
    with pytest.raises(SpecError):
        system(text)
    assert not (tmp_path / "leak").exists()


@pytest.mark.parametrize("text", ["{{ domain.skills.clear() }}", "{% set _ = domain.tasks.pop('shift') %}"])
def test_a_template_cannot_change_the_domain(system, problem, text):
    with pytest.raises(SpecError):
        system(text)
    assert list(problem.domain.spec.skills) == ["slide"]
    assert list(problem.domain.spec.tasks) == ["shift"]


def test_folders_are_searched_in_order(problem, tmp_path):
    for name in ("first", "second"):
        (tmp_path / name / "methods").mkdir(parents=True)
    (tmp_path / "second/methods/mine.j2").write_text("second {% include 'methods/part.j2' %}")
    (tmp_path / "second/methods/part.j2").write_text("part 2")
    (tmp_path / "first/methods/part.j2").write_text("part 1")
    prompter = Prompter(METHOD, PRESET, (tmp_path / "first", tmp_path / "second"))
    assert prompter.system(problem).text == "second part 1"


@pytest.mark.parametrize(("template", "answer"), [("proc3s", "sketch"), ("cap", "program"), ("llm3", "plan")])
def test_the_built_in_prompts_of_a_domain_they_have_never_seen(problem, template, answer):
    method = MethodSpec(name="m", summary="", template=template, answer=answer)
    prompter = Prompter(method, PRESET, (BUILT_IN,))
    one, two = (conversation(prompter, problem, ()) for _ in range(2))
    assert [m.text.encode() for m in one] == [m.text.encode() for m in two]
    assert [m.kind for m in one] == ["system", "task"]
    text = "\n".join(m.text for m in one)
    for part in (
        "Beads slide on a wire.",
        "class Scene",
        "`slide(bead, by)`: Slides a bead.",
        "gen_plan",
        "Shift a bead.",
    ):
        assert part in text
    assert ("ContinuousSampler" in text) == (answer == "sketch")
    assert ("gen_domain" in text) == (answer == "sketch")
    assert "Bead(name='object_1', place=1.0)" in one[-1].text
    assert "leaves the wire" not in text  # the paper does not list the constraints


def feedback(problem, *failures, errors=(), answer="sketch"):
    method = MethodSpec(name="m", summary="", template="proc3s", answer=answer)
    diagnosis = Diagnosis(samples=10, failures=failures, program_errors=errors)
    return Prompter(method, PRESET, (BUILT_IN,)).feedback(problem, diagnosis).text


def violation(step, text):
    return Failure(kind="on_wire", text=text, step=step, skill="slide", share=50)


def test_feedback_names_the_two_commonest_failures_without_counts(problem):
    text = feedback(problem, violation(0, "first"), violation(2, "second"), violation(1, "third"))
    assert "step 0, action slide: first" in text
    assert "step 2, action slide: second" in text
    assert "third" not in text
    assert "%" not in text
    assert "50" not in text


def test_feedback_names_the_room_of_plans_that_only_a_rehearsal_refused(problem):
    method = MethodSpec(name="m", summary="", template="proc3s", answer="sketch")
    graded = PresetSpec(name="best", summary="", budget="paper", feedback="graded")
    told = {"constraint": "rehearsal", "share": 100, "steps": (2,), "texts": ("fell",), "best_margin": -1.0}
    report = ConstraintReport(**told, room="0.4, at step 1: it passes the pit")
    diagnosis = Diagnosis(samples=10, failures=(violation(2, "fell"),), constraints=(report,))
    text = Prompter(method, graded, (BUILT_IN,)).feedback(problem, diagnosis).text
    assert "the most room that one has, in expected errors, is 0.4, at step 1: it passes the pit.\n" in text


def test_feedback_quotes_the_line_of_an_error(problem):
    error = Failure(
        kind="SketchRuntimeError", text="division by zero", line=7, source="  x = 1 / 0", share=10
    )
    assert "line 7 (`x = 1 / 0`): division by zero" in feedback(problem, error)


def test_feedback_tells_all_that_made_a_program_useless(problem):
    errors = [Failure(kind="SketchContractError", text=f"breach {n}", line=n, share=100) for n in range(1, 7)]
    text = feedback(problem, errors=errors)
    for n in range(1, 7):
        assert f"line {n}: breach {n}" in text


def test_feedback_about_a_plan_asks_for_a_plan(problem):
    assert "whole new plan" in feedback(problem, violation(0, "a"), answer="plan")
    assert "whole program again" in feedback(problem, violation(0, "a"))


def test_text_of_the_program_is_never_a_template(problem):
    text = feedback(problem, violation(0, "{{ domain.name }} {% if %}"))
    assert "{{ domain.name }} {% if %}" in text


def test_earlier_rounds_are_messages_in_order(problem):
    history = [
        Exchange("answer 0", Diagnosis(samples=1, failures=(violation(0, "why 0"),))),
        Exchange("answer 1", Diagnosis(samples=1, failures=(violation(0, "why 1"),))),
    ]
    method = MethodSpec(name="m", summary="", template="proc3s", answer="sketch")
    messages = conversation(Prompter(method, PRESET, (BUILT_IN,)), problem, history)
    assert [(m.role, m.kind) for m in messages[1:]] == [
        ("user", "task"),
        ("assistant", "reply"),
        ("user", "feedback"),
        ("assistant", "reply"),
        ("user", "feedback"),
    ]
    assert messages[2].text == "answer 0"
    assert "why 1" in messages[-1].text


def test_a_state_as_the_llm_reads_it(problem):
    assert state_text(problem.initial) == (
        "Scene(\n"
        "    beads=[\n"
        "        Bead(name='object_0', place=0.0),\n"
        "        Bead(name='object_1', place=1.0),\n"
        "    ],\n"
        "    moves=0,\n"
        ")"
    )


def test_an_example_without_its_answer_is_an_error_of_the_spec(tmp_path):
    text = toy_world.DOMAIN + 'examples: {hop: {instruction: Hop., initial: {target: "toy_world:scene"}}}\n'
    problem = toy_world.problem(tmp_path, text)
    method = MethodSpec(name="m", summary="", template="cap", answer="program")
    with pytest.raises(SpecError, match=r"hop\.program\.md.*is missing"):
        conversation(Prompter(method, PRESET, (BUILT_IN,)), problem, ())


def test_an_example_with_a_round_of_feedback_is_four_messages(tmp_path):
    text = toy_world.DOMAIN + 'examples: {hop: {instruction: Hop., initial: {target: "toy_world:scene"}}}\n'
    (tmp_path / "examples").mkdir()
    (tmp_path / "examples/hop.plan.md").write_text("one\n<!-- feedback -->\ntwo\n\n<!-- answer -->\nthree\n")
    problem = toy_world.problem(tmp_path, text)
    method = MethodSpec(name="m", summary="", template="llm3", answer="plan")
    messages = conversation(Prompter(method, PRESET, (BUILT_IN,)), problem, ())
    assert [(m.role, m.text) for m in messages[2:5]] == [
        ("assistant", "one\n"),
        ("user", "two\n"),
        ("assistant", "three\n"),
    ]
