"""`proc3s report`: the page of run folders of every kind, as text and in a browser."""

import re
from html.parser import HTMLParser

import pytest

from browser import needs_chromium, visiting
from proc3s.plugins.registry import folders_of, open_registry
from proc3s.reporting.history import read_story
from proc3s.reporting.page import page

HOSTILE = """<script>document.title = "answer"</script>
```python
def gen_plan(initial, x):
    # </pre></style><script>document.title = "program"</script>
    print('<img src="http://elsewhere.example/x.png" onerror="alert(1)">')
    return [Action("draw_line", [50, 1, 51, 1]), Action("draw_line", [-1 - x, 1, 2, 1])]

def gen_domain(initial):
    return {"x": ContinuousSampler(0, 1)}
```
"""
GOAL = '<script>document.title = "goal"</script> & "two" lines'


class Elements(HTMLParser):
    """Every element of a page with its attributes."""

    def __init__(self, text):
        super().__init__()
        self.found = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, dict(attrs)))


@pytest.fixture
def hostile(cli, stub):
    """A run whose instruction, answer and program would like to be part of the page."""
    llm = stub(HOSTILE, "no code <b>here</b>", HOSTILE)
    cli("run", "drawing/free", "--goal", GOAL, "--samples", 30, "--llm", llm, "--out", "run")


def test_what_the_page_says(cli, here, two_rounds):
    done = cli("report", "two")
    assert (done.code, done.stdout.strip()) == (0, "two/report.html")
    text = (two_rounds / "report.html").read_text()
    for part in (
        "two lines",
        "The world accepted it",
        "program-0.py",
        "program-1.py",
        "Changes since round 0",
        "Samples by parameter",
        "Violations by step",
        "the x coordinate leaves the canvas",
        "Prompt: 4 messages",
        "Timings",
    ):
        assert part in text
    assert text.count("data:image/png;base64,") == 1
    assert '<span class="k">def</span>' in text


def test_nothing_on_the_page_is_from_elsewhere_or_runs(cli, here, hostile):
    cli("report", "run", "--out", "page.html")
    found = Elements((here / "page.html").read_text()).found
    assert {tag for tag, _ in found} & {"script", "link", "iframe", "object", "base", "form"} == set()
    for tag, attributes in found:
        assert not [name for name in attributes if name.startswith("on") or name == "style"]
        for name in ("src", "href", "srcset", "action"):
            assert attributes.get(name, "#").startswith(("#", "data:image/")), (tag, attributes)


def test_a_policy_that_forbids_all_but_the_page_itself(cli, here, two_rounds):
    cli("report", "two", "--out", "page.html")
    metas = [a for tag, a in Elements((here / "page.html").read_text()).found if tag == "meta"]
    policy = next(a["content"] for a in metas if a.get("http-equiv") == "Content-Security-Policy")
    assert policy.startswith("default-src 'none'; img-src data:; style-src 'sha256-")
    assert "unsafe" not in policy


@pytest.mark.slow
def test_every_beginning_of_a_log_has_a_page(two_rounds):
    folders = folders_of(open_registry())
    log = two_rounds / "events.jsonl"
    lines = log.read_bytes().splitlines(keepends=True)
    for count in range(len(lines)):
        log.write_bytes(b"".join(lines[:count]) + lines[count][:20])
        assert "broken off, or still at work" in page(read_story(two_rounds), folders)


@pytest.mark.slow
def test_pages_of_other_runs(cli, stub, failing, here, two_rounds, rewrite):
    rewrite(two_rounds, lambda event: {k: v for k, v in event.items() if k not in ("dims", "log")})
    (two_rounds / "plan.png").unlink()
    assert cli("report", "two").code == 0
    three = [[failing.outside, failing.broken, failing.wider]]
    cli(
        *("run", "drawing/free", "--goal", "two", "--samples", 90, "--candidates", 3),
        *("--llm", stub(*three), "--out", "many"),
    )
    assert cli("report", "many").code == 0
    text = (here / "many" / "report.html").read_text()
    assert "Candidate 2, of 3" in text
    assert 'class="hll"' in text  # the line of the error
    for method in ("cap", "llm3"):
        cli("run", "drawing/star", "--method", method, "--out", method)
        assert cli("report", method).code == 0
        assert "Draw a star with at least five points." in (here / method / "report.html").read_text()


def test_a_page_is_the_same_every_time(two_rounds):
    folders = folders_of(open_registry())
    assert page(read_story(two_rounds), folders) == page(read_story(two_rounds), folders)


def test_what_cannot_be_reported(cli, here, two_rounds):
    assert cli("report", "nowhere").code == 2
    done = cli("report", "two", "--out", "no/such/folder/page.html")
    assert done.code == 2
    assert "cannot be written" in done.stderr


def test_the_page_is_shown(cli, two_rounds, monkeypatch):
    shown = []
    monkeypatch.setattr("typer.launch", shown.append)
    cli("report", "two", "--open")
    assert shown == [(two_rounds / "report.html").as_uri()]


@needs_chromium
@pytest.mark.slow
def test_a_browser_shows_the_page_and_asks_for_nothing(cli, here, hostile):
    cli("report", "run")
    address = (here / "run" / "report.html").as_uri()
    with visiting() as open_page:
        visit = open_page(address)
        assert [url for url in visit.requests if not url.startswith("data:")] == [address]
        assert visit.complaints == []
        assert visit.page.title() == "drawing/free, seed 0: a run of proc3s"
        assert visit.page.locator("p.quote").inner_text() == GOAL
        widths = visit.page.eval_on_selector_all("img.chart", "all => all.map(one => one.naturalWidth)")
        assert len(widths) == 4
        assert min(widths) > 100
        program = visit.page.locator("section details[open] pre").first.inner_text()
        assert '</pre></style><script>document.title = "program"</script>' in program
        room = visit.page.evaluate("document.documentElement.scrollWidth - window.innerWidth")
        assert room <= 0, "the page is wider than the window"


@needs_chromium
@pytest.mark.slow
def test_the_policy_holds_in_a_browser(cli, here, two_rounds):
    cli("report", "two")
    text = (two_rounds / "report.html").read_text()
    bad = '<script>document.title = "owned"</script><img src="http://elsewhere.example/x.png">'
    (here / "bad.html").write_text(text.replace("<main>", f"<main>{bad}"))
    with visiting() as open_page:
        visit = open_page((here / "bad.html").as_uri())
        assert "owned" not in visit.page.title()
        assert len([c for c in visit.complaints if re.search("Content Security Policy", c)]) >= 2
