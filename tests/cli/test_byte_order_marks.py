"""Files as editors save them: every kind that people write may begin with a byte-order mark."""

import json
import shutil

import pytest

from proc3s import answer, load_domain
from proc3s.prompts.extract import extract_program
from proc3s.suites.results import read_figures
from proc3s.textfiles import read_text
from sample_answers import STAR

MARK = "\ufeff"
PROGRAM = extract_program(STAR)


@pytest.fixture(params=["utf-8-sig", "utf-16"])
def save(request, here):
    """Writes a file as an editor does that marks how it is encoded, with the line ends of Windows."""

    def write(name, text):
        path = here / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.replace("\n", "\r\n").encode(request.param))
        return path

    return write


def ran(cli, *args):
    done = cli("run", "drawing/star", "--json", "--out", "run", *args)
    assert done.code == 0, done.stderr
    return done.json


def test_a_text_is_read_without_its_mark(save):
    assert read_text(save("a.txt", "é\nb\n")) == "é\nb\n"


def test_a_file_without_a_mark_is_utf_8(here):
    (here / "a.txt").write_bytes("é\r\nb\r".encode())
    assert read_text(here / "a.txt") == "é\nb\n"
    (here / "a.txt").write_bytes(b"\xe9")
    with pytest.raises(UnicodeDecodeError):
        read_text(here / "a.txt")


def test_the_script_of_a_stub(cli, save):
    assert ran(cli, "--llm", f"stub:{save('script.json', json.dumps([STAR]))}")["solved"]


def test_an_answer_file_with_its_origin(cli, save):
    path = save("mine/star.proc3s.md", f"---\norigin: authored\n---\n{STAR}")
    assert ran(cli, "--llm", f"replay:{path.parent}")["llm_source"] == "authored"


def test_an_answer_given_by_hand(cli, save):
    manual = ("--llm", "manual:desk", "-L", "wait=0")
    assert cli("run", "drawing/star", *manual, "--out", "asked").code == 4
    save("desk/drawing.star.proc3s.seed0.answer.md", STAR)
    assert ran(cli, *manual)["solved"]


def test_a_program(cli, save):
    path = save("star.py", PROGRAM)
    assert cli("solve", "drawing/star", "--sketch", path, "--out", "run").code == 0


def test_the_configuration(cli, save):
    save("script.json", json.dumps([STAR]))
    save("proc3s.toml", 'llm = "stub:script.json"\n')
    assert ran(cli)["llm"] == "stub:script.json"


def test_a_domain(save):
    from proc3s.plugins.registry import open_registry

    own = open_registry().domain("drawing").spec.folder / "domain.yaml"
    path = save("copy/domain.yaml", own.read_text(encoding="utf-8"))
    assert load_domain(path).model_dump() == load_domain(own).model_dump()


def test_a_worked_example(save):
    import dataclasses

    from proc3s.planning.options import RunOptions
    from proc3s.planning.setup import make_problem
    from proc3s.plugins.registry import open_registry
    from proc3s.prompts.examples import example_turns

    problem = make_problem(open_registry(), RunOptions(task="drawing/star"))
    spec = problem.domain.spec
    example = spec.examples["square"]
    text = read_text(spec.folder / "examples/square.sketch.md")
    copy = spec.in_folder(save("own/examples/square.sketch.md", text).parents[1])
    domain = dataclasses.replace(problem.domain, spec=copy)
    moved = dataclasses.replace(problem, domain=domain)
    assert example_turns(moved, example, "sketch") == example_turns(problem, example, "sketch")


@pytest.mark.slow
def test_a_suite(cli, save):
    suite = "name: mine\nsummary: Mine.\ntasks: [drawing/star]\nmethods: [proc3s]\nseeds: 1\n"
    done = cli("bench", save("mine.yaml", suite), "--llm", "replay", "--out", "suite", "--json")
    assert done.code == 0, done.stderr


def test_published_figures(save):
    figures = "quantity,method,domain,task,mean,std\nsuccess_percent,cap,drawing,star,80,4\n"
    assert list(read_figures(save("figures.csv", figures)).values()) == [(80.0, 4.0)]


def test_an_approved_rendering(cli, save, here):
    args = ("render-prompt", "drawing/star", "--method", "cap", "--check", "approved")
    assert cli(*args, "--update").code == 0
    (approved,) = (here / "approved").rglob("*.md")
    save(approved.relative_to(here), approved.read_text(encoding="utf-8"))
    assert cli(*args).code == 0


def test_a_template(cli, here):
    (here / "templates/partials").mkdir(parents=True)
    (here / "templates/partials/task.j2").write_text(f"{MARK}Do it.", encoding="utf-8")
    done = cli("render-prompt", "drawing/star", "--template-dir", "templates")
    assert "Do it." in done.stdout
    assert MARK not in done.stdout


def test_a_cassette_is_played_and_gone_on_with(cli, here):
    first = ran(cli, "--record", "kept.jsonl")
    kept = here / "kept.jsonl"
    kept.write_bytes(MARK.encode() + kept.read_bytes())
    shutil.rmtree(here / "run")
    assert ran(cli, "--llm", "replay:kept.jsonl", "--record", "kept.jsonl")["plan"] == first["plan"]
    shutil.rmtree(here / "run")
    assert ran(cli, "--llm", "replay:kept.jsonl", "-L", "repeat=1")["plan"] == first["plan"]


def test_the_log_of_a_run(cli, here):
    first = ran(cli)
    log = here / "run/events.jsonl"
    log.write_bytes(MARK.encode() + log.read_bytes())
    again = cli("replay", "run", "--json", "--out", "again")
    assert again.json["plan"] == first["plan"]
    assert cli("explain", "run").code == 0


@pytest.mark.parametrize("form", ["{0}```python\n{1}\n```", "Words.\n```python\n{0}{1}\n```", "{0}{1}"])
def test_a_mark_in_an_answer_is_no_part_of_its_program(form):
    text = form.format(MARK, PROGRAM)
    assert extract_program(answer(text, "m").text).strip() == PROGRAM.strip()


def test_a_file_that_is_no_text_is_said(cli, here):
    (here / "old.md").write_bytes(b"\xe9")
    done = cli("render-prompt", "drawing/star", "--diff", "old.md")
    assert done.code == 2
    assert "old.md is no rendering of a prompt: it is no UTF-8 text" in done.stderr
