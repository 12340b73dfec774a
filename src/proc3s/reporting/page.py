"""`proc3s report`: one HTML page that needs nothing from outside and runs nothing.

Whatever a model or a program wrote is escaped, by the template or by Pygments; a policy in the page forbids
scripts and requests besides. The page is `report.j2`, its style `report.css`.
"""

import base64
import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from markupsafe import Markup
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import get_lexer_by_name

from proc3s.errors import UsageError
from proc3s.feedback.report import Diagnosis
from proc3s.reporting import charts
from proc3s.reporting.explanation import explained
from proc3s.reporting.history import ProgramRecord, RoundRecord, Story
from proc3s.reporting.templates import ReportTemplates
from proc3s.runs.pictures import NEAREST_MISS, OUTCOME, SCENE, step_pictures
from proc3s.sandbox.text import clean

_LONGEST = 400_000
"""Characters of a text that are shown."""


def page(story: Story, folders: Sequence[Path]) -> str:
    """The page. Raises UsageError or SpecError for a template that is missing or does not render."""
    templates = ReportTemplates(folders, html=True)
    css = _highlighting() + templates.render("report.css")
    colors = charts.colors_of(sorted({v for p in story.programs for v in p.samples.violation if v}))
    return templates.render(
        "report.j2",
        css=Markup(css),  # a file of the templates; what follows is what the policy allows
        css_hash=base64.b64encode(hashlib.sha256(css.encode()).digest()).decode(),
        told=_shown(explained(story, folders)),
        colors={name: data_url(_swatch(color), "svg+xml") for name, color in colors.items()},
        details={round_.number: _details(round_, colors) for round_ in story.rounds},
        pictures=_pictures(story),
        missed=_missed(story),
        timings=_timings(story),
        summary=_shown(story.summary or {}),
        options=_shown(story.options),
        versions=story.versions,
        began=story.began,
    )


def _highlighting() -> str:
    formatter: HtmlFormatter[str] = HtmlFormatter(style="friendly", nobackground=True)
    return str(formatter.get_style_defs("pre"))  # type: ignore[no-untyped-call]


def write(story: Story, folders: Sequence[Path], path: Path) -> None:
    """Write the page. Raises UsageError if the file cannot be written."""
    text = page(story, folders)
    try:
        path.write_text(text, encoding="utf-8", errors="xmlcharrefreplace")
    except OSError as error:
        raise UsageError(f"the report {path} cannot be written: {error.strerror}") from error


def _shown(value: Any) -> Any:
    """Data whose texts have no character that shows nothing or turns the direction of a line."""
    if isinstance(value, str):
        return clean(value, _LONGEST)
    if isinstance(value, dict):
        return {_shown(name): _shown(item) for name, item in value.items()}
    return [_shown(item) for item in value] if isinstance(value, list | tuple) else value


def _details(round_: RoundRecord, colors: dict[str, str]) -> dict[str, Any]:
    """What a round has beside its explanation: texts, highlighted, and charts."""
    return {
        "messages": [(m.role, m.kind, colored(m.text, "markdown")) for m in round_.messages],
        "completions": [
            _shown(c.model_dump(mode="json", exclude={"candidates"})) for c in round_.completions
        ],
        "programs": [_of_program(program, colors) for program in round_.programs],
    }


def _of_program(program: ProgramRecord, colors: dict[str, str]) -> dict[str, Any]:
    samplers, steps = charts.by_parameter(program, colors), charts.by_step(program.steps, colors)
    return {
        "answer": None if program.answer is None else colored(program.answer, "markdown"),
        "source": None
        if program.source is None
        else colored(program.source, "python", _faulty_lines(program.diagnosis)),
        "diff": colored(program.change.diff, "diff") if program.change else None,
        "printed": clean(program.printed, _LONGEST),
        "by_parameter": data_url(samplers.encode(), "svg+xml") if samplers else None,
        "by_step": data_url(steps.encode(), "svg+xml") if steps else None,
    }


def colored(text: str, language: str, marked: Sequence[int] = ()) -> Markup:
    """Text as HTML lines with its syntax highlighted, every character of it escaped."""
    lexer = get_lexer_by_name(language, stripnl=False, ensurenl=True)
    formatter = HtmlFormatter(nowrap=True, hl_lines=marked)
    shown = clean(text, _LONGEST)
    return Markup(highlight(shown, lexer, formatter))  # Pygments escapes


def _faulty_lines(diagnosis: Diagnosis | None) -> list[int]:
    """Lines that errors of the program name."""
    failures = (*diagnosis.program_errors, *diagnosis.failures) if diagnosis else ()
    return sorted({failure.line for failure in failures if failure.line})


def _pictures(story: Story) -> list[dict[str, Any]]:
    """Those of the plan that was carried out: before the first step, then after each; else the last alone."""
    found = step_pictures(story.run)
    plan = story.executed["plan"] if story.executed else []
    if found:
        return [
            _picture(path, _shown(plan[n - 1]) if 0 < n <= len(plan) else None, n)
            for n, path in found.items()
        ]
    last = story.run / OUTCOME
    return [_picture(last, None, None)] if last.is_file() else []


def _missed(story: Story) -> list[dict[str, Any]]:
    """Those of what an unsolved run came nearest to, and of where it began."""
    paths = [story.run / name for name in (NEAREST_MISS, SCENE)]
    return [] if story.solved else [_picture(path, None, None) for path in paths if path.is_file()]


def _picture(path: Path, action: dict[str, Any] | None, after: int | None) -> dict[str, Any]:
    """A picture, the action that it shows the outcome of, and how many actions came before it."""
    return {"name": path.name, "src": data_url(path.read_bytes(), "png"), "action": action, "after": after}


def data_url(data: bytes, kind: str) -> str:
    """A picture of a kind, e.g. png, as the address of an image."""
    return f"data:image/{kind};base64,{base64.b64encode(data).decode()}"


def _swatch(color: str) -> bytes:
    """A little square of a color, for legends: the policy allows no style of a single element."""
    square = f'<rect width="10" height="10" fill="{color}"/>'
    return f'<svg xmlns="http://www.w3.org/2000/svg" width="10" height="10">{square}</svg>'.encode()


def _timings(story: Story) -> list[tuple[str, float, float | None]]:
    """(stage, wall seconds, CPU seconds), the total last; empty where the run was broken off."""
    summary = story.summary or {}
    cpu = summary.get("cpu_seconds", {})
    return [(stage, seconds, cpu.get(stage)) for stage, seconds in summary.get("seconds", {}).items()]
