"""Templates of one's own: copied out, changed, and those that change nothing named."""

from pathlib import Path

import pytest

import proc3s
import proc3s_drawing
from proc3s.plugins.registry import folders_of, open_registry

APPROVED = Path(__file__).parents[1] / "prompts"


@pytest.fixture
def write(here):
    def write(name, text="Try again.\n"):
        path = here / "mine" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    return write


@pytest.fixture
def notices(cli):
    """What is said on stderr of the templates in `mine`."""

    def notices(*more, task="drawing/star"):
        result = cli("render-prompt", task, "--template-dir", "mine", *more)
        assert result.code == 0, result.stderr
        return [said for said in result.stderr.split("proc3s: ")[1:] if said.startswith("--template-dir")]

    return notices


def test_the_templates_of_prompts_are_copied_as_they_are(cli, here):
    result = cli("new", "templates")
    assert result.code == 0
    copied = {p.relative_to(here / "templates").as_posix() for p in (here / "templates").rglob("*.*")}
    assert copied == {
        "feedback.j2",
        *(f"methods/{name}.j2" for name in ("cap", "llm3", "proc3s")),
        *(f"partials/{name}.j2" for name in ("environment", "samplers", "skills", "task")),
    }
    (builtin,) = folders_of(open_registry())
    for name in copied:
        assert (here / "templates" / name).read_bytes() == (builtin / name).read_bytes()
        assert f"  {name}\n" in result.stdout
    assert "--template-dir templates" in result.stdout
    assert "--diff <(proc3s render-prompt" in result.stdout


@pytest.mark.parametrize("within", ["drawing/star", pytest.param(None, marks=pytest.mark.slow)])
def test_with_the_copies_every_prompt_is_as_before(cli, within):
    cli("new", "templates", "--dir", "mine")
    task = [within] if within else []
    checked = cli("render-prompt", *task, "--check", APPROVED, "--template-dir", "mine")
    assert checked.code == 0, checked.stdout
    assert "--template-dir" not in checked.stderr


def test_a_folder_in_use_is_left_alone(cli, here, write):
    write("notes.txt")
    result = cli("new", "templates", "--dir", "mine")
    assert result.code == 2
    assert "not empty" in result.stderr
    assert [p.name for p in (here / "mine").iterdir()] == ["notes.txt"]


def test_a_plugins_template_is_copied_and_a_domains_is_named(cli, here):
    for path, text in {
        "toy/methods/cap.j2": "From a plugin.\n",
        "own/templates/feedback.j2": "No.\n",
    }.items():
        (here / path).parent.mkdir(parents=True)
        (here / path).write_text(text)
    drawing = Path(proc3s_drawing.__file__).with_name("domain.yaml").read_text()
    (here / "own/domain.yaml").write_text(drawing.replace("name: drawing", "name: own"))
    (here / "proc3s_plugins.py").write_text(
        "from pathlib import Path\nfrom proc3s import TemplatesSpec, hookimpl, load_domain\n\n"
        "@hookimpl\ndef register_templates(register):\n"
        "    register(TemplatesSpec(name='toy', summary='', folder=Path('toy').resolve()))\n\n"
        "@hookimpl\ndef register_domains(register):\n    register(load_domain(Path('own/domain.yaml')))\n"
    )
    result = cli("new", "templates", "--dir", "mine")
    assert (here / "mine/methods/cap.j2").read_text() == "From a plugin.\n"
    assert (here / "mine/feedback.j2").read_text() != "No.\n"
    assert "the domain own has its own feedback.j2" in result.stdout


def test_a_template_that_no_prompt_uses_is_named(notices, write):
    write("feedbck.j2")
    write("methods/proc3s2.j2")
    write("report.j2")
    first, second, third = notices()
    assert "feedbck.j2; did you mean 'feedback.j2'?" in first
    assert "methods/proc3s2.j2; did you mean 'methods/proc3s.j2'?" in second
    assert "report.j2" in third
    assert ["proc3s new templates" in said for said in (first, second, third)] == [False, False, True]


def test_a_run_says_so_too(cli, write):
    write("feedbck.j2")
    result = cli("run", "drawing/star", "--template-dir", "mine", "--json")
    assert result.json["solved"]
    assert "did you mean 'feedback.j2'?" in result.stderr


def test_python_warns(here, write):
    write("feedbck.j2")
    with pytest.warns(UserWarning, match=r"did you mean 'feedback\.j2'") as caught:
        proc3s.render_prompt("drawing/star", template_dir=here / "mine")
    assert caught[0].filename == __file__
    with pytest.warns(UserWarning, match=r"did you mean 'feedback\.j2'") as caught:
        proc3s.run("drawing/star", template_dir=here / "mine")
    assert caught[0].filename == __file__


def test_checking_says_so_too(cli, write):
    write("feedbck.j2")
    result = cli("render-prompt", "drawing/star", "--check", APPROVED, "--template-dir", "mine")
    assert result.code == 0
    assert "did you mean 'feedback.j2'?" in result.stderr


def test_what_ones_own_templates_name_is_used(notices, write):
    write("methods/cap.j2", "{% extends 'base.j2' %}{% block a %}{% import 'words.j2' as w %}{% endblock %}")
    write("base.j2", "{% block a %}{% endblock %}{% include './parts/end.j2' %}")
    write("words.j2")
    write("parts/end.j2")
    write("feedback.j2")
    assert notices() == []


def test_a_template_of_another_method_or_of_a_computed_name_is_used(notices, write):
    write("methods/llm3.j2")
    write("extra-sketch.j2")
    assert len(notices()) == 1
    write("methods/cap.j2", "{% include 'extra-' ~ method.answer ~ '.j2' %}")
    assert notices() == []


def test_a_template_of_a_plugins_method_is_used(cli, here, notices, write):
    (here / "mine.py").write_text(
        "from proc3s import MethodSpec, hookimpl\n\n@hookimpl\ndef register_methods(register):\n"
        "    register(MethodSpec(name='own', summary='', template='own', answer='program'))\n"
    )
    write("methods/own.j2")
    assert notices("--plugin", "mine.py") == []
    assert len(notices()) == 1


def test_a_part_that_ones_own_template_leaves_out(notices, write):
    write("methods/proc3s.j2")
    write("partials/samplers.j2")
    assert "partials/samplers.j2; none of yours includes it" in notices()[0]


def test_a_folder_without_templates(here, notices, write):
    write("feedback.txt")
    (said,) = notices()
    assert "changes nothing" in said
    assert "proc3s new templates" in said


def test_a_folder_that_is_not_there(cli):
    result = cli("render-prompt", "drawing/star", "--template-dir", "nowhere")
    assert result.code == 2
    assert "no template folder" in result.stderr
    assert "proc3s new templates" in result.stderr


def test_links_in_a_circle_lead_nowhere(cli, here):
    (here / "one").symlink_to(here / "other")
    (here / "other").symlink_to(here / "one")
    for args in (["--template-dir", "one"], ["--plugin", "one"]):
        done = cli("render-prompt", "drawing/star", *args)
        assert (done.code, "one" in done.stderr, "Traceback" in done.stderr) == (2, True, False), done.stderr
