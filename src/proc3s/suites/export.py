"""The results of a suite as files: Markdown, CSV, JSON, and one page that needs nothing from outside."""

import csv
import io
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from proc3s.errors import UsageError
from proc3s.plugins.registry import Registry
from proc3s.suites.outcomes import Unfinished
from proc3s.suites.results import Results, read_figures
from proc3s.suites.tables import SuiteTable, provenance, tables

FIGURES = "figures.csv"
"""The published figures, in the folder of the suite."""


def write_files(results: Results, folder: Path, registry: Registry) -> list[SuiteTable]:
    """Write `results.*` into a folder; returns the tables. Raises UsageError."""
    from proc3s.suites.page import page

    figures = folder / FIGURES
    made = list(tables(results, read_figures(figures if figures.is_file() else None)))
    texts = {
        "results.md": markdown(results, made),
        "results.csv": rows(results),
        "results.json": json.dumps(document(results, made), indent=2, ensure_ascii=False) + "\n",
        "results.html": page(results, made, folder, registry),
    }
    for name, text in texts.items():
        try:
            (folder / name).write_text(text, encoding="utf-8", errors="xmlcharrefreplace")
        except OSError as error:
            raise UsageError(f"{folder / name} cannot be written: {error.strerror}") from error
    return made


def document(results: Results, made: Sequence[SuiteTable]) -> dict[str, Any]:
    """Everything as plain data."""
    return {
        "suite": results.spec.model_dump(mode="json"),
        "facts": {name: value for name, value in results.facts.items() if name != "spec"},
        "origin": provenance(results),
        "tables": [{"title": t.title, "head": t.head, "lines": t.lines, "note": t.note} for t in made],
        "episodes": [
            {
                **r.episode.model_dump(mode="json"),
                "outcome": r.word,
                "human": r.verdict and r.verdict._asdict(),
            }
            for r in results.all
        ],
        "unfinished": [_unfinished(one) for one in results.unfinished],
    }


def markdown(results: Results, made: Sequence[SuiteTable]) -> str:
    """All tables as Markdown."""
    parts = [f"# {results.spec.name}\n\n{results.spec.summary}\n"]
    parts += [f"- {sentence}\n" for sentence in provenance(results)]
    if results.spec.source:
        parts.append(f"\nPublished figures: {results.spec.source.strip()}.\n")
    for table in made:
        lines = [table.head, ("---",) * len(table.head), *table.lines]
        body = "\n".join(f"| {' | '.join(map(_in_table, line))} |" for line in lines)
        parts.append(f"\n## {table.title}\n\n{body}\n\n{table.note}\n")
    return "".join(parts)


def _in_table(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")


def rows(results: Results) -> str:
    """The episodes as CSV, what is nested under dotted names; those that are not finished come last."""
    flat = [
        _flat(r.episode.model_dump(mode="json")) | {"outcome": r.word} | _human(r.verdict)
        for r in results.all
    ]
    flat += map(_unfinished, results.unfinished)
    names = list(dict.fromkeys(name for row in flat for name in row))
    out = io.StringIO()
    writer = csv.DictWriter(out, names, lineterminator="\n")
    writer.writeheader()
    writer.writerows(flat)
    return out.getvalue()


def _unfinished(one: Unfinished) -> dict[str, Any]:
    return {**one.cell._asdict(), "outcome": one.word, "error": one.error}


def _human(verdict: Any) -> dict[str, Any]:
    return {f"human.{k}": v for k, v in verdict._asdict().items()} if verdict else {}


def _flat(row: dict[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in row.items():
        if isinstance(value, dict):
            found |= {f"{name}.{key}": inner for key, inner in value.items()}
        else:
            found[name] = " ".join(value) if isinstance(value, list) else value
    return found
