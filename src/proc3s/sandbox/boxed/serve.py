"""The box's main: lock down first, then load a program and answer rows with plans."""

import contextlib
import faulthandler
import gc
import io
import json
import os
import signal
import struct
import sys
from functools import cache
from typing import Any, TextIO, cast

from .encoding import Unfit
from .loading import LoadedProgram, LoadError, describe
from .lock import REPLIES, REQUESTS, TRACES, Unavailable, lock_down, restrain
from .namespace import Output, import_everything
from .wire import (
    ERROR,
    FIRST_SAMPLE,
    LOAD,
    LOADED,
    LOG,
    MOST_PROBLEMS,
    PLAN,
    PROBE,
    PROBED,
    READY,
    REPLY,
    REQUEST,
    UNAVAILABLE,
)

_RESERVE = 4 << 20


@cache
def prepare() -> tuple[str, ...]:
    """Import all that a program may import, once; returns the names."""
    return import_everything()


def main(memory: int, cpu_seconds: int, locked: bool) -> None:
    """Serve requests until the other side closes the pipe; `memory` is in bytes."""
    importable = prepare()
    try:
        _move_pipes()
        (lock_down if locked else restrain)(memory, cpu_seconds)
    except (Unavailable, OSError) as error:
        _write(_frame(0, UNAVAILABLE, str(error)))
        return
    sys.stdin = io.StringIO("")
    gc.freeze()
    _write(_frame(0, READY, ""))
    Server(importable).run()


def _move_pipes() -> None:
    """Requests, replies and traces to their descriptors; 0 to 2 become /dev/null, the rest closes."""
    for standard, descriptor in enumerate((REQUESTS, REPLIES, TRACES)):
        os.dup2(standard, descriptor)
    nothing = os.open(os.devnull, os.O_RDWR)
    for standard in range(3):
        os.dup2(nothing, standard)
    for name in os.listdir("/proc/self/fd" if sys.platform == "linux" else "/dev/fd"):  # noqa: PTH208 - pathlib is not worth its import here
        if int(name) > TRACES:
            with contextlib.suppress(OSError):  # the listing itself
                os.close(int(name))
    # the other side sends SIGUSR1 to learn which line hangs, even inside C code
    faulthandler.enable(TRACES, all_threads=False)
    faulthandler.register(signal.SIGUSR1, TRACES, all_threads=False, chain=False)


class Server:
    """Answers the requests of one program."""

    def __init__(self, importable: tuple[str, ...]) -> None:
        self.importable = importable
        # given back to tell what happened when all memory is used up
        self._reserve = bytearray(_RESERVE)

    def run(self) -> None:
        """Answer until the pipe closes."""
        while head := _read(REQUEST.size):
            operation, length = REQUEST.unpack(head)
            body = _read(length)
            if operation == LOAD:
                _write(self.load(json.loads(body)))
            elif operation == PROBE:
                _write(_frame(0, PROBED, self.program.probe(*json.loads(body))))
                self.output.take()
            else:
                self.answer(body)

    def load(self, request: dict[str, Any]) -> bytes:
        """Load the program; the reply says what it defines."""
        self.output = Output(request["printed"])
        sys.stdout = sys.stderr = cast(TextIO, self.output)
        try:
            self.program = LoadedProgram(request, self.importable)
        except LoadError as error:
            return _frame(0, ERROR, self._fault(error.__cause__ or error, error.stage))
        except BaseException as error:
            return _frame(0, ERROR, self._fault(error))
        self.columns = struct.Struct(f"<{max(1, self.program.width)}d")
        reply = _frame(0, LOADED, self._contents())
        if len(reply) <= request["frame"]:
            return reply
        return _frame(0, ERROR, self._fault(Unfit("gen_domain holds too many values")))

    def _contents(self) -> dict[str, Any]:
        program = self.program
        return {
            "parameters": [
                {"name": p.name, "line": p.line, "sampler": p.sampler, "args": p.args}
                for p in program.parameters
            ],
            "problems": program.problems[:MOST_PROBLEMS],
            "log": self.output.take(),
        }

    def answer(self, body: bytes) -> None:
        """One reply for each row, written at once."""
        (sample,) = FIRST_SAMPLE.unpack_from(body)
        width = self.program.width
        plan, encode, output = self.program.plan, self.program.encoder.encode, self.output
        for row in self.columns.iter_unpack(body[FIRST_SAMPLE.size :]):
            try:
                actions = plan(sample, row[:width])
                try:
                    numbers, values = encode(actions)
                except Exception as error:
                    raise self._unfit(actions, error) from error
                columns = values.tobytes()
                size = len(numbers)
                reply = REPLY.pack(sample, PLAN, size, size + len(columns)) + numbers + columns
            except BaseException as error:
                reply = _frame(sample, ERROR, self._fault(error))
            if output.length:
                reply = _frame(sample, LOG, output.take()) + reply
            _write(reply)
            sample += 1

    def _fault(self, error: BaseException, stage: str = "runtime") -> dict[str, Any]:
        if isinstance(error, Unfit):
            return {"kind": "contract", "message": str(error), "line": None}
        if isinstance(error, MemoryError):
            self._reserve.clear()
            stage = "memory"
        return describe(error, stage)

    def _unfit(self, actions: Any, error: Exception) -> Unfit:
        text = next((text for text, _ in self.program.encoder.problems(actions)), None)
        return Unfit(text or f"the plan cannot be read: {error}")


def _frame(sample: int, kind: int, content: Any) -> bytes:
    body = json.dumps(content, ensure_ascii=False).encode("utf-8", "replace")
    return REPLY.pack(sample, kind, 0, len(body)) + body


def _read(size: int) -> bytes:
    """Exactly `size` bytes, or none at the end of the pipe."""
    data = os.read(REQUESTS, size)
    while data and len(data) < size:
        more = os.read(REQUESTS, size - len(data))
        data = data + more if more else b""
    return data


def _write(data: bytes) -> None:
    view = memoryview(data)
    while view:
        view = view[os.write(REPLIES, view) :]
