"""The cache of prepared meshes: files with a checksum, written atomically by one process at a time."""

import contextlib
import hashlib
import io
import os
import tempfile
import warnings
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from proc3s.errors import Notice
from proc3s_tabletop.extra import extra

VARIABLE = "PROC3S_CACHE"
"""Environment variable that overrides the user's cache folder."""
SUFFIX = ".mesh"

Arrays: TypeAlias = Mapping[str, NDArray[Any]]


def folder() -> Path:
    """The folder of prepared meshes, created if missing; if not writable, a temporary one and a warning."""
    import platformdirs

    root = Path(os.environ.get(VARIABLE) or platformdirs.user_cache_path("proc3s"))
    path = root / "meshes"
    try:
        path.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path):
            return path
    except OSError as error:
        return _instead(path, str(error.strerror))


@extra()
def kept(key: str, make: Callable[[], Arrays]) -> Arrays:
    """The arrays stored under a key; `make` computes missing or damaged ones, in one process at a time."""
    from filelock import FileLock

    where = folder()
    path = where / (key + SUFFIX)
    if (found := _read(path)) is not None:
        return found
    with FileLock(where / (key + ".lock")):
        if (found := _read(path)) is None:
            found = make()
            try:
                _write(path, found)
            except OSError as error:
                text = f"{path} is not kept, and made again next time: {error.strerror}"
                warnings.warn(text, Notice, stacklevel=2)
    return found


def _read(path: Path) -> Arrays | None:
    """The arrays of a file; None if it is missing or damaged."""
    try:
        checksum, _, content = path.read_bytes().partition(b"\n")
    except FileNotFoundError:
        return None
    if checksum != _checksum(content):
        return None
    with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
        return dict(arrays)


def _write(path: Path, arrays: Arrays) -> None:
    buffer = io.BytesIO()
    np.savez(buffer, allow_pickle=False, **arrays)
    content = buffer.getvalue()
    with _whole(path) as file:
        file.write(_checksum(content) + b"\n" + content)


@contextlib.contextmanager
def _whole(path: Path) -> Iterator[Any]:
    """A temporary file that is renamed to `path` once it is complete."""
    with tempfile.NamedTemporaryFile(dir=path.parent, prefix=path.stem[:8], delete=False) as file:
        try:
            yield file
            file.close()
            Path(file.name).replace(path)
        except BaseException:
            Path(file.name).unlink(missing_ok=True)
            raise


def _checksum(content: bytes) -> bytes:
    return hashlib.sha256(content).hexdigest().encode()


def _instead(path: Path, reason: str) -> Path:
    """A temporary folder of this user, in place of the cache folder."""
    where = Path(tempfile.gettempdir()) / f"proc3s-meshes-{os.getuid()}"
    where.mkdir(mode=0o700, exist_ok=True)
    text = f"{path} cannot be written ({reason}): meshes are kept in {where}"
    warnings.warn(text, Notice, stacklevel=2)
    return where
