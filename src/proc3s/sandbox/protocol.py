"""Reads a worker's replies on the trusted side: bounded before they are read, checked before they are used.

Whatever a worker sends ends in plain validated data or in one exception, `Malformed`.
"""

from collections.abc import Callable
from typing import Annotated, Literal, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from proc3s.sandbox.boxed.wire import (
    ERROR,
    LOG,
    LONGEST_NAME,
    MOST_PARAMETERS,
    MOST_PROBLEMS,
    MOST_VALUES,
    PLAN,
    REPLY,
)
from proc3s.sandbox.errors import (
    SketchContractError,
    SketchError,
    SketchMemoryError,
    SketchRuntimeError,
    SketchSyntaxError,
)
from proc3s.sandbox.limits import Limits
from proc3s.sandbox.text import Source, clean, message

Line = Annotated[int, Field(ge=1, le=1_000_000)] | None
Integer = Annotated[int, Field(ge=-(2**63), lt=2**63)]
Scalar = float | Integer | str | bool
Problems = Annotated[list[tuple[str, Line]], Field(max_length=MOST_PROBLEMS)]
T = TypeVar("T")


def _identifier(name: str) -> str:
    if not name.isidentifier() or clean(name, LONGEST_NAME, keep="") != name:
        raise ValueError("no identifier")
    return name


class Malformed(Exception):
    """A reply that an honest worker does not send."""


class Reply(BaseModel):
    """Base of what crosses as JSON."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True, allow_inf_nan=False)


class ProgramFault(Reply):
    """An exception of the program."""

    kind: Literal["prelude", "syntax", "runtime", "contract", "memory"]
    message: str
    line: Line


class ReadParameter(Reply):
    """A parameter of gen_plan and the sampler that gen_domain gives it, if it is one."""

    name: Annotated[str, AfterValidator(_identifier)]
    line: Line
    sampler: str | None
    args: dict[str, float | Annotated[list[Scalar], Field(max_length=MOST_VALUES)]]


class Contents(Reply):
    """What a program defines and what is wrong with it."""

    parameters: Annotated[list[ReadParameter], Field(max_length=MOST_PARAMETERS)]
    problems: Problems
    log: str


CONTENTS = TypeAdapter(Contents)
FAULT = TypeAdapter(ProgramFault)
PROBLEMS: TypeAdapter[list[tuple[str, Line]]] = TypeAdapter(Problems, config=ConfigDict(strict=True))
TEXT: TypeAdapter[str] = TypeAdapter(str, config=ConfigDict(strict=True))

_ERRORS: dict[str, Callable[..., SketchError]] = {
    "syntax": SketchSyntaxError,
    "runtime": SketchRuntimeError,
    "contract": SketchContractError,
    "memory": SketchMemoryError,
}


def parse(adapter: TypeAdapter[T], body: bytes) -> T:
    """JSON of an expected shape. Raises Malformed."""
    try:
        return adapter.validate_json(body)
    except (ValidationError, ValueError, RecursionError) as error:
        raise Malformed("a reply is not what it should be") from error


def error_of(fault: ProgramFault, source: Source) -> SketchError:
    """The error that a fault is, quoting the program's line from our own copy."""
    line, text = source.quote(fault.line)
    return _ERRORS[fault.kind](message(fault.message), line, text)


class Replies:
    """The replies to one batch of rows, in order; `feed` takes bytes as they come.

    `first` is the number of the first sample, `count` how many there are. Samples fail one by one in
    `errors`; only exhausted memory and malformed replies end the batch.
    """

    def __init__(self, first: int, count: int, source: Source, limits: Limits) -> None:
        self.first = first
        self.count = count
        self.source = source
        self.limits = limits
        self.sizes: list[tuple[int, int]] = []
        self.skills: list[bytes] = []
        self.values: list[bytes] = []
        self.errors: dict[int, SketchError] = {}
        self.logs: dict[int, str] = {}
        self._rest = b""
        self._received = 0

    @property
    def done(self) -> int:
        """How many samples are finished."""
        return len(self.sizes)

    def feed(self, data: bytes) -> None:
        """Take in what the worker sent. Raises Malformed, SketchContractError, SketchMemoryError."""
        self._received += len(data)
        if self._received > self.limits.replies:
            raise SketchContractError(
                f"the plans of this batch take more than {self.limits.replies >> 20} MiB"
            )
        buffer = self._rest + data
        position, size, frame = 0, len(buffer), self.limits.frame
        while size - position >= REPLY.size:
            sample, kind, actions, length = REPLY.unpack_from(buffer, position)
            if sample != self.first + len(self.sizes) or len(self.sizes) == self.count:
                raise Malformed("a reply is out of order")
            if length > frame:
                raise Malformed(f"a reply of {length} bytes is too long")
            start = position + REPLY.size
            end = start + length
            if end > size:
                break
            if kind == PLAN:
                values = length - actions
                if values < 0 or values & 7 or actions > self.limits.actions:
                    raise Malformed("a plan has the wrong size")
                self.sizes.append((actions, values >> 3))
                self.skills.append(buffer[start : start + actions])
                self.values.append(buffer[start + actions : end])
            else:
                self._take_text(kind, actions, buffer[start:end])
            position = end
        self._rest = buffer[position:]
        if self._rest and self.done == self.count:
            raise Malformed("there are more replies than samples")

    def _take_text(self, kind: int, actions: int, body: bytes) -> None:
        if kind == LOG and not actions and self.done not in self.logs:
            self.logs[self.done] = clean(parse(TEXT, body), self.limits.printed)
            return
        if kind != ERROR or actions:
            raise Malformed("a reply is of an unknown kind")
        fault = parse(FAULT, body)
        if fault.kind not in ("runtime", "contract", "memory"):
            raise Malformed("an error is of an unknown kind")
        error = error_of(fault, self.source)
        if isinstance(error, SketchMemoryError):
            error.alone = True
            raise error
        self.fail(error)

    def fail(self, error: SketchError) -> None:
        """The next sample failed; what came of its reply is dropped."""
        self.errors[self.done] = error
        self.sizes.append((0, 0))
        self._rest = b""


def frame_of(buffer: bytes, kinds: tuple[int, ...], limits: Limits) -> tuple[int, bytes] | None:
    """Kind and body of the only frame in the buffer, None while it is incomplete. Raises Malformed."""
    if len(buffer) < REPLY.size:
        return None
    sample, kind, actions, length = REPLY.unpack_from(buffer)
    if sample or actions or kind not in kinds:
        raise Malformed("a reply is out of order")
    if length > limits.frame:
        raise Malformed(f"a reply of {length} bytes is too long")
    if len(buffer) > REPLY.size + length:
        raise Malformed("there are more replies than requests")
    return (kind, buffer[REPLY.size :]) if len(buffer) == REPLY.size + length else None
