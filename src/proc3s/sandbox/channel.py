"""Talks to one worker: requests out, bounded replies in, and a typed error when it hangs, dies or lies."""

import contextlib
import fcntl
import os
import re
import select
import signal
import time

import numpy as np

from proc3s.domain.values import FloatArray
from proc3s.sandbox.boxed.wire import ERROR, FILENAME, FIRST_SAMPLE, READY, REQUEST, RUN, UNAVAILABLE
from proc3s.sandbox.errors import SandboxUnavailable, SketchCrash, SketchError, SketchTimeout
from proc3s.sandbox.limits import Limits
from proc3s.sandbox.protocol import TEXT, Malformed, Replies, frame_of, parse
from proc3s.sandbox.template import Worker
from proc3s.sandbox.text import Source, message

_PIPE = 512 << 10
"""Capacity asked for the replies, so that the worker goes on while we nap."""
_CHUNK = 30_000
"""Bytes of rows in one request: two of them fit into a pipe, so that neither side waits for the other."""
_MOST_ROWS = 256
_MANY_DUE = 8
_NAP_A_SAMPLE, _LONGEST_NAP = 10e-6, 1e-3
_TRACE_LENGTH = 16 << 10
_TRACE_LINE = re.compile(rb'File "' + re.escape(FILENAME.encode()) + rb'", line (\d{1,7}) in ')


class _Late(Exception):
    """The deadline passed."""


class _Ended(Exception):
    """The worker closed its pipe."""


class Channel:
    """The pipes of one worker. After an error there is nothing to do but `close`."""

    def __init__(self, worker: Worker, source: Source, limits: Limits) -> None:
        self._worker = worker
        self._source = source
        self._limits = limits
        self._requests, self._replies, self._traces = worker.requests, worker.replies, worker.traces
        for descriptor in (self._requests, self._replies, self._traces):
            os.set_blocking(descriptor, False)
        with contextlib.suppress(OSError, AttributeError):  # only slower where there is no so large a pipe
            fcntl.fcntl(self._replies, fcntl.F_SETPIPE_SZ, _PIPE)
        self._poll = select.poll()
        self._poll.register(self._replies, select.POLLIN)

    def close(self) -> None:
        """End the worker; harmless when it has ended."""
        self._worker.close()

    def wait_until_ready(self) -> None:
        """Wait until the worker is locked. Raises SandboxUnavailable."""
        try:
            kind, body = self._frame((READY, UNAVAILABLE), time.monotonic() + self._limits.start)
            reason = parse(TEXT, body)
        except (_Late, _Ended, Malformed):
            lines = self._trace(0.2).decode(errors="replace").strip().splitlines()
            reason = lines[-1] if lines else self._worker.last_line()
            raise SandboxUnavailable(f"the worker does not start ({message(reason or '?')})") from None
        if kind != READY:
            raise SandboxUnavailable(message(reason))

    def ask(
        self, operation: bytes, body: bytes, expected: int, seconds: float, what: str
    ) -> tuple[int, bytes]:
        """Kind (`expected` or ERROR) and body of the one reply to a request. Raises SketchError."""
        deadline = time.monotonic() + seconds
        try:
            self._send(operation, body, deadline)
            return self._frame((expected, ERROR), deadline)
        except _Late:
            raise self._timeout(f"{what} took longer than {seconds:g} s") from None
        except _Ended:
            raise self._crash() from None
        except Malformed as error:
            raise lie(error) from error

    def run(self, rows: FloatArray, replies: Replies) -> None:
        """Send the rows that have no reply yet, feed all replies. Raises SketchError; `replies` keeps what
        came before."""
        begun = replies.done
        rows = rows[begun:]
        per_chunk = max(1, min(_MOST_ROWS, _CHUNK // (8 * rows.shape[1])))
        chunks = [rows[at : at + per_chunk] for at in range(0, len(rows), per_chunk)]
        batch_end = time.monotonic() + self._limits.batch
        call_end = time.monotonic() + self._limits.call
        sent = 0
        try:
            while replies.done < replies.count:
                while sent < len(chunks) and sent - (replies.done - begun) // per_chunk < 2:
                    first = FIRST_SAMPLE.pack(replies.first + begun + sent * per_chunk)
                    try:
                        self._send(RUN, first + chunks[sent].tobytes(), min(call_end, batch_end))
                    except _Ended:
                        chunks = chunks[:sent]  # what it said before it ended is still to be read
                    else:
                        sent += 1
                done = replies.done
                replies.feed(self._read(min(call_end, batch_end)))
                now = time.monotonic()
                # a deadline for each call, not for each read: a reply may drip in byte by byte
                call_end = now + self._limits.call if replies.done > done else call_end
                if now > min(call_end, batch_end) and replies.done < replies.count:
                    raise _Late
                _nap(replies.count - replies.done)
        except _Late:
            late = time.monotonic() > batch_end
            limit = f"the batch took longer than {self._limits.batch:g} s"
            error = self._timeout(
                limit if late else f"one call of gen_plan took longer than {self._limits.call:g} s"
            )
            error.alone = not late
            raise error from None
        except _Ended:
            raise self._crash() from None
        except Malformed as error:
            raise lie(error) from error

    def _send(self, operation: bytes, body: bytes, deadline: float) -> None:
        view = memoryview(REQUEST.pack(operation, len(body)) + body)
        while view:
            try:
                view = view[os.write(self._requests, view) :]
            except BlockingIOError:
                left = deadline - time.monotonic()
                if left <= 0:
                    raise _Late from None
                select.select([], [self._requests], [], left)
            except BrokenPipeError:
                raise _Ended from None

    def _read(self, deadline: float) -> bytes:
        """What has arrived, at least one byte; what is there already is never late."""
        while True:
            try:
                data = os.read(self._replies, 1 << 16)
            except BlockingIOError:
                left = deadline - time.monotonic()
                if left <= 0:
                    raise _Late from None
                self._poll.poll(left * 1000 + 1)
            else:
                if not data:
                    raise _Ended
                return data

    def _frame(self, kinds: tuple[int, ...], deadline: float) -> tuple[int, bytes]:
        buffer = b""
        while (frame := frame_of(buffer, kinds, self._limits)) is None:
            buffer += self._read(deadline)
            if time.monotonic() > deadline:
                raise _Late
        return frame

    def _timeout(self, limit: str) -> SketchTimeout:
        self._worker.exit_code(signal.SIGUSR1)
        error = SketchTimeout(limit, *self._running_line(0.3))
        error.alone = True
        return error

    def _crash(self) -> SketchError:
        code = self._worker.wait(0.5) or 0
        line, text = self._running_line(0.1)
        if code == -signal.SIGXCPU:
            return SketchTimeout(f"the program used more than {self._limits.cpu} s of CPU time", line, text)
        error = SketchCrash(f"the program's process died ({_exit(code)})", line, text)
        error.alone = True
        return error

    def _running_line(self, wait: float) -> tuple[int | None, str | None]:
        """The innermost line of the program in the worker's trace, of which only numbers are believed."""
        lines = (self._source.quote(int(number)) for number in _TRACE_LINE.findall(self._trace(wait)))
        return next((quoted for quoted in lines if quoted[0] is not None), (None, None))

    def _trace(self, wait: float) -> bytes:
        text, deadline = b"", time.monotonic() + wait
        while time.monotonic() < deadline and len(text) < _TRACE_LENGTH:
            if not select.select([self._traces], [], [], 0.02)[0]:
                if text.endswith(b"\n"):
                    break
                continue
            data = os.read(self._traces, 4096)
            if not data:
                break
            text += data
        return text


def _exit(code: int) -> str:
    if -code in set(signal.Signals):
        return signal.Signals(-code).name
    return f"signal {-code}" if code < 0 else f"exit code {code}"


def _nap(due: int) -> None:
    """Let the replies that are due pile up, so that we are not woken for each."""
    if due > _MANY_DUE:
        time.sleep(min(_LONGEST_NAP, due * _NAP_A_SAMPLE))


def lie(error: Malformed) -> SketchError:
    """The error for replies that no honest worker sends."""
    return SketchCrash(f"the program tampered with its process: {error}")


def as_rows(values: FloatArray) -> FloatArray:
    """Rows as they cross: little-endian float64, at least one column."""
    return np.ascontiguousarray(values if values.shape[1] else np.zeros((len(values), 1)), "<f8")
