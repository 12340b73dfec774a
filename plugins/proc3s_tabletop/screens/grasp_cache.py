"""What was found of grasps in earlier runs: a small database in the user's cache folder.

SQLite, since several processes add to it at once, a row at a time, and a killed one must leave it whole.
"""

import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from pathlib import Path
from typing import NamedTuple, TypeAlias

from proc3s_tabletop.meshes import cache as mesh_cache

NAME = "grasps.sqlite"
PATIENCE = 10.0
"""How long a process waits for another to finish writing, s."""

Grasp: TypeAlias = tuple[float, ...]
"""x, y, z (m), roll, pitch, yaw (rad), rounded."""


class GraspVerdict(NamedTuple):
    """How deep the open hand is in a body, m; the share of the rays between its pads that meet the body; and
    whether the closed hand holds it, None where nobody tried."""

    depth: float
    cover: float
    holds: bool | None = None


class Verdicts:
    """The verdicts on grasps of one body in one rest, found under a key; a damaged file is begun anew."""

    def __init__(self, key: str, folder: Path | None = None) -> None:
        self._key, self._path = key, (folder or mesh_cache.folder()) / NAME

    def read(self) -> dict[Grasp, GraspVerdict]:
        """All that are known."""
        with self._table() as table:
            rows = table.execute("SELECT * FROM grasps WHERE key = ?", (self._key,)).fetchall()
        return {tuple(row[1:7]): GraspVerdict(row[7], row[8], _flag(row[9])) for row in rows}

    def add(self, found: Mapping[Grasp, GraspVerdict]) -> None:
        """Keep verdicts; where two processes find one at the same time, it is the same."""
        rows = [(self._key, *grasp, *verdict) for grasp, verdict in found.items()]
        with self._table() as table:
            table.executemany("INSERT OR REPLACE INTO grasps VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)", rows)

    @contextmanager
    def _table(self) -> Iterator[sqlite3.Connection]:
        try:
            connection = _opened(self._path)
        except sqlite3.OperationalError:  # no folder, no room, or another process writes for ever
            raise
        except sqlite3.DatabaseError:
            self._path.unlink(missing_ok=True)
            connection = _opened(self._path)
        with closing(connection), connection:
            yield connection


def _opened(path: Path) -> sqlite3.Connection:
    """A connection to the database, made if need be. Raises DatabaseError where the file is none."""
    connection = sqlite3.connect(path, timeout=PATIENCE)
    try:
        connection.execute("PRAGMA journal_mode = WAL")
        connection.execute(
            "CREATE TABLE IF NOT EXISTS grasps (key TEXT, x REAL, y REAL, z REAL, roll REAL, pitch REAL, "
            "yaw REAL, depth REAL, cover REAL, holds INTEGER, PRIMARY KEY (key, x, y, z, roll, pitch, yaw))"
        )
        if connection.execute("PRAGMA quick_check(1)").fetchone() != ("ok",):
            raise sqlite3.DatabaseError(f"{path} is damaged")
    except BaseException:
        connection.close()
        raise
    return connection


def _flag(value: int | None) -> bool | None:
    return None if value is None else bool(value)
