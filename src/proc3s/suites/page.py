"""The results of a suite as one HTML page that needs nothing from outside and runs nothing."""

import base64
import contextlib
import hashlib
import io
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from markupsafe import Markup
from PIL import Image, UnidentifiedImageError

from proc3s.errors import Proc3sError, UsageError
from proc3s.planning.film import draw_pictures
from proc3s.plugins.registry import Registry, folders_of
from proc3s.reporting.history import read_story
from proc3s.reporting.page import data_url, write
from proc3s.reporting.templates import ReportTemplates
from proc3s.runs.pictures import OUTCOME
from proc3s.runs.reading import LOG
from proc3s.suites.charts import curves, success_bars
from proc3s.suites.results import Result, Results
from proc3s.suites.tables import SuiteTable, provenance

THUMBNAIL = (260, 260)
"""Largest width and height of a picture in the gallery, pixels."""


def page(results: Results, tables: Sequence[SuiteTable], folder: Path, registry: Registry) -> str:
    """The page. Raises UsageError or SpecError for a template that is missing or does not render."""
    pages = ReportTemplates(folders_of(registry), html=True)
    css = pages.render("report.css") + pages.render("suite.css")
    charts = {"Success": success_bars(results), "Samples to a solution": curves(results)}
    return pages.render(
        "suite.j2",
        css=Markup(css),
        css_hash=base64.b64encode(hashlib.sha256(css.encode()).digest()).decode(),
        spec=results.spec,
        facts=results.facts,
        origin=provenance(results),
        tables=tables,
        charts={title: data_url(svg.encode(), "svg+xml") for title, svg in charts.items() if svg},
        gallery=list(_gallery(results, folder, registry)),
        unfinished=results.unfinished,
    )


def _gallery(results: Results, folder: Path, registry: Registry) -> Iterator[dict[str, Any]]:
    """Every episode in words, with the picture of what came of it."""
    for result in results.all:
        run = folder / result.episode.run_dir
        report = report_of(run, registry)  # which draws the outcome, too
        yield {
            "episode": result.episode,
            "verdict": result.verdict,
            "state": _state(result),
            "picture": thumbnail(run / OUTCOME),
            "report": report,
        }


def _state(result: Result) -> tuple[str, str]:
    """A word and the class of its badge."""
    if result.wrong:
        return f"solved, but {result.word}", "warn"
    if result.success is None and result.episode.solved:
        return "solved, not judged", "good"
    return result.word, "good" if result.success else "bad"


def report_of(run: Path, registry: Registry) -> str | None:
    """The name of a run's page in its folder, which is written where it is missing or older than the log.

    Of the pictures that are not there yet it draws that of the outcome alone.

    None where there is no log that can be read.
    """
    path, log = run / "report.html", run / LOG
    try:
        if not path.is_file() or path.stat().st_mtime < log.stat().st_mtime:
            with contextlib.suppress(Proc3sError):  # it lacks a picture, then
                draw_pictures(run, registry, steps=False)
            write(read_story(run), folders_of(registry), path)
    except (UsageError, FileNotFoundError):
        return None
    return path.name


def thumbnail(path: Path) -> str | None:
    """A picture as a small data URL; None where there is none."""
    try:
        with Image.open(path) as image:
            small = image.convert("RGB")
    except (FileNotFoundError, UnidentifiedImageError):
        return None
    small.thumbnail(THUMBNAIL)
    stream = io.BytesIO()
    small.save(stream, "JPEG", quality=72)
    return data_url(stream.getvalue(), "jpeg")
