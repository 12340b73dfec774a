"""Grasps measured in earlier runs: a small database in the user's cache folder.

SQLite, since several processes add rows at the same time, and a killed one must leave the file intact.
"""

import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from pathlib import Path
from typing import NamedTuple, TypeAlias

from proc3s_tabletop.meshes import cache as mesh_cache

NAME = "grasps.sqlite"
LOCK_TIMEOUT = 10.0
"""Seconds that a process waits for another one to finish writing."""

Grasp: TypeAlias = tuple[float, ...]
"""x, y, z (m), roll, pitch, yaw (rad), rounded."""


class GraspVerdict(NamedTuple):
    """How deep the open hand is in a body, m; the share of the rays between its pads that meet the body; and
    whether the closed hand holds it, None where nobody tried."""

    depth: float
    cover: float
    holds: bool | None = None


class GraspCache:
    """Verdicts on grasps of one body in one rest pose, stored under a key; a damaged file is replaced."""

    def __init__(self, key: str, folder: Path | None = None) -> None:
        self._key, self._path = key, (folder or mesh_cache.folder()) / NAME

    def read(self) -> dict[Grasp, GraspVerdict]:
        """All verdicts that are stored."""
        with self._table() as table:
            rows = table.execute("SELECT * FROM grasps WHERE key = ?", (self._key,)).fetchall()
        return {tuple(row[1:7]): GraspVerdict(row[7], row[8], _flag(row[9])) for row in rows}

    def add(self, found: Mapping[Grasp, GraspVerdict]) -> None:
        """Store verdicts; two processes that measure the same grasp get equal ones."""
        rows = [(self._key, *grasp, *verdict) for grasp, verdict in found.items()]
        with self._table() as table:
            table.executemany("INSERT OR REPLACE INTO grasps VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)", rows)

    @contextmanager
    def _table(self) -> Iterator[sqlite3.Connection]:
        try:
            connection = _opened(self._path)
        except sqlite3.OperationalError:  # no folder, a full disk, or another process holds the lock
            raise
        except sqlite3.DatabaseError:
            self._path.unlink(missing_ok=True)
            connection = _opened(self._path)
        with closing(connection), connection:
            yield connection


def _opened(path: Path) -> sqlite3.Connection:
    """A connection to the database, made if need be. Raises DatabaseError where the file is none."""
    connection = sqlite3.connect(path, timeout=LOCK_TIMEOUT)
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
