"""The results of a suite in its folder: one SQLite file.

SQLite, since an episode is then there whole or not at all whenever the process is killed, rows of several
processes do not mix, and "which are finished" is a query; of JSONL all this would have to be written.
"""

import json
import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NamedTuple

from proc3s.errors import UsageError
from proc3s.specs.suite import Cell
from proc3s.suites.episode import Episode
from proc3s.suites.outcomes import Unfinished

FILE = "episodes.sqlite"
LOCK_TIMEOUT = 30.0
"""Seconds that a process waits for another one to finish writing."""

_CELL = "task TEXT, method TEXT, preset TEXT, seed INTEGER"
_KEY = "PRIMARY KEY (task, method, preset, seed)"
_IS = "task = ? AND method = ? AND preset = ? AND seed = ?"
_ERROR = "json_extract(document, '$.error')"


class JudgeVerdict(NamedTuple):
    """What a person says of an outcome."""

    reached: bool
    why: str
    at: str
    """ISO 8601."""


class Store:
    """Episodes, people's verdicts and facts about the suite; every write is on the disk when it returns.

    Raises UsageError if the folder has no results and `make` is not set, or the file is damaged.
    """

    def __init__(self, folder: Path, make: bool = False) -> None:
        self.folder, self._path = folder, folder / FILE
        if not make and not self._path.is_file():
            raise UsageError(f"{folder} has no results of a suite ({FILE})")
        with self._open() as table:
            table.execute("PRAGMA journal_mode = WAL")
            table.execute(f"CREATE TABLE IF NOT EXISTS episodes ({_CELL}, document TEXT, {_KEY})")
            table.execute(
                f"CREATE TABLE IF NOT EXISTS verdicts ({_CELL}, reached INTEGER, why TEXT, at TEXT, {_KEY})"
            )
            table.execute(
                f"CREATE TABLE IF NOT EXISTS unfinished ({_CELL}, stopped TEXT, error TEXT, {_KEY})"
            )
            table.execute("CREATE TABLE IF NOT EXISTS facts (name TEXT PRIMARY KEY, document TEXT)")

    def add(self, episode: Episode) -> None:
        """Keep a finished episode. Raises UsageError if it is there already."""
        row = (*episode.cell, episode.model_dump_json())
        try:
            with self._open() as table:
                table.execute(f"DELETE FROM unfinished WHERE {_IS}", episode.cell)
                table.execute(f"DELETE FROM episodes WHERE {_IS} AND {_ERROR} IS NOT NULL", episode.cell)
                table.execute("INSERT INTO episodes VALUES (?, ?, ?, ?, ?)", row)
        except sqlite3.IntegrityError as error:
            raise UsageError(f"another process has finished {episode.cell.folder} as well") from error

    def episodes(self) -> list[Episode]:
        """All that are finished, in the order in which they were."""
        with self._open() as table:
            wanted = f"SELECT document FROM episodes WHERE {_ERROR} IS NULL ORDER BY rowid"
            rows = table.execute(wanted).fetchall()
        return [Episode.model_validate_json(document) for (document,) in rows]

    def leave(self, unfinished: Unfinished) -> None:
        """Keep why an episode could not be carried out, in place of an earlier reason."""
        row = (*unfinished.cell, unfinished.stopped, unfinished.error)
        with self._open() as table:
            table.execute("INSERT OR REPLACE INTO unfinished VALUES (?, ?, ?, ?, ?, ?)", row)

    def unfinished(self) -> list[Unfinished]:
        """The episodes that could not be carried out up to now.

        Earlier versions kept those that ended with an error among the finished ones.
        """
        columns = "task, method, preset, seed"
        old = f"SELECT {columns}, 'usage', {_ERROR} FROM episodes WHERE {_ERROR} IS NOT NULL"
        with self._open() as table:
            rows = table.execute(f"{old} UNION ALL SELECT * FROM unfinished").fetchall()
        latest = {Cell(*row[:4]): Unfinished(Cell(*row[:4]), *row[4:]) for row in rows}
        return list(latest.values())

    def judge(self, cell: Cell, reached: bool, why: str = "") -> None:
        """Keep what a person says of an episode, in place of what was said before."""
        row = (*cell, int(reached), why, datetime.now(UTC).isoformat(timespec="seconds"))
        with self._open() as table:
            table.execute("INSERT OR REPLACE INTO verdicts VALUES (?, ?, ?, ?, ?, ?, ?)", row)

    def verdicts(self) -> dict[Cell, JudgeVerdict]:
        """What people said."""
        with self._open() as table:
            rows = table.execute("SELECT * FROM verdicts").fetchall()
        return {Cell(*row[:4]): JudgeVerdict(bool(row[4]), row[5], row[6]) for row in rows}

    def facts(self) -> dict[str, Any]:
        """What is known of the suite: its spec, options and versions, by name."""
        with self._open() as table:
            rows = table.execute("SELECT name, document FROM facts").fetchall()
        return {name: json.loads(document) for name, document in rows}

    def note(self, facts: Mapping[str, Any]) -> None:
        """Keep facts, in place of those of the same names."""
        rows = [(name, json.dumps(value)) for name, value in facts.items()]
        with self._open() as table:
            table.executemany("INSERT OR REPLACE INTO facts VALUES (?, ?)", rows)

    @contextmanager
    def _open(self) -> Iterator[sqlite3.Connection]:
        try:
            with closing(sqlite3.connect(self._path, timeout=LOCK_TIMEOUT)) as connection, connection:
                yield connection
        except sqlite3.IntegrityError:
            raise
        except sqlite3.Error as error:
            raise UsageError(f"the results in {self._path} cannot be read or written: {error}") from error
