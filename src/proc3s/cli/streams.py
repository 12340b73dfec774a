"""Output of a command survives any terminal or pipe: closed, full, gone, or not UTF-8."""

import codecs
import contextlib
import errno
import io
import json
import os
import select
import sys
from collections.abc import Iterator
from contextvars import ContextVar
from typing import TextIO, cast

import typer
from pydantic import BaseModel
from pydantic_core import PydanticSerializationError

ESCAPE = "proc3s.escape"
GONE = 141
"""Exit code when nobody reads stdout any more: that of a program which SIGPIPE ends."""
_document: ContextVar[TextIO | None] = ContextVar("document", default=None)


def _escape(error: UnicodeError) -> tuple[str, int]:
    r"""What an encoding lacks as `\uXXXX`, which JSON reads too; beyond 16 bits as two of them."""
    assert isinstance(error, UnicodeEncodeError)
    units = error.object[error.start : error.end].encode("utf-16-be", "surrogatepass")
    pairs = (units[i : i + 2].hex() for i in range(0, len(units), 2))
    return "".join(rf"\u{pair}" for pair in pairs), error.end


class Output(io.TextIOBase):
    """A text stream to a file descriptor, without a buffer, that never raises.

    Once a write fails, the descriptor leads nowhere and `fault` says why. It has no `buffer`, so nobody wraps
    it in another encoding.
    """

    errors = ESCAPE

    def __init__(self, descriptor: int, encoding: str) -> None:
        codecs.register_error(ESCAPE, _escape)
        self._descriptor, self._encoding = descriptor, encoding
        self.fault: OSError | None = None

    @property
    def encoding(self) -> str:  # type: ignore[override]
        """The name of its encoding."""
        return self._encoding

    def write(self, text: str) -> int:
        """Write all of it."""
        data = memoryview(text.encode(self._encoding, ESCAPE))
        try:
            while data:
                data = data[self._some(data) :]
        except OSError as error:
            self.fault = error
            _lead(os.open(os.devnull, os.O_WRONLY), self._descriptor)
        return len(text)

    def _some(self, data: memoryview) -> int:
        try:
            return os.write(self._descriptor, data)
        except BlockingIOError:  # a terminal or pipe that another process made so
            select.select([], [self._descriptor], [])
            return 0

    def fileno(self) -> int:
        """The file descriptor."""
        return self._descriptor

    def isatty(self) -> bool:
        """Whether it is a terminal."""
        return os.isatty(self._descriptor)

    def writable(self) -> bool:
        """It is."""
        return True

    def apart(self) -> "Output":
        """The same stream by a descriptor of its own; whatever is written to this one goes to stderr now."""
        own = Output(os.dup(self._descriptor), self._encoding)
        os.dup2(2, self._descriptor)
        return own


def _lead(source: int, descriptor: int) -> None:
    os.dup2(source, descriptor)
    os.close(source)


def take_streams() -> Output:
    """Put `Output` in the place of stdout and stderr; gives that of stdout.

    Descriptors that are closed lead nowhere from now on, so that no other file gets their numbers.
    """
    for descriptor in range(3):
        try:
            os.fstat(descriptor)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # the lowest that is free
    streams = [Output(n, getattr(s, "encoding", "utf-8")) for n, s in ((1, sys.stdout), (2, sys.stderr))]
    sys.stdout, sys.stderr = streams
    return streams[0]


def exit_code(code: int, out: Output) -> int:
    """The exit code of a command, or what became of its output; says so if that is not a closed pipe."""
    if out.fault is None:
        return code
    if out.fault.errno == errno.EPIPE:
        return GONE
    typer.echo(f"proc3s: stdout cannot be written: {out.fault.strerror}", err=True)
    return 2


@contextlib.contextmanager
def document_alone() -> Iterator[None]:
    """Inside, only `print_document` reaches stdout.

    All other output goes to stderr, be it of a plugin, a library in C or a child process.
    """
    stdout = sys.stdout
    document = stdout.apart() if isinstance(stdout, Output) else stdout
    token = _document.set(cast(TextIO, document))
    try:
        with contextlib.redirect_stdout(sys.stderr):
            yield
    finally:
        _document.reset(token)
        if isinstance(stdout, Output) and isinstance(document, Output):
            stdout.fault = document.fault


def print_document(text: str) -> None:
    """Print what the command was called for; see `document_alone`."""
    typer.echo(text, file=_document.get(), nl=text[-1:] not in ("", "\n"))


def json_of(model: BaseModel) -> str:
    """A model as indented JSON, also with the path of a file whose name is not UTF-8."""
    try:
        return model.model_dump_json(indent=2)
    except PydanticSerializationError:
        return json.dumps(model.model_dump(mode="json"), indent=2, ensure_ascii=False)
