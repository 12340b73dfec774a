"""What can go wrong with a program, as errors that a language model and a person can act on."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from proc3s.domain.plan_batch import PlanBatch
from proc3s.errors import Proc3sError


@dataclass(frozen=True)
class SketchIssue:
    """One breach of the contract; `line` counts from 1, `source` is the text of that line."""

    message: str
    line: int | None = None
    source: str | None = None

    def __str__(self) -> str:
        return self.message if self.line is None else f"line {self.line}: {self.message}"


class SketchError(Exception):
    """A program, or one sample of it, failed.

    `line` and `source` point into the program where that is known. `done` holds the finished samples
    when a batch was cut short. `issues` lists every breach of the contract. `alone` says that only the
    sample at hand failed, though it took its process with it: others may do in a fresh one.
    """

    alone = False

    def __init__(
        self,
        message: str,
        line: int | None = None,
        source: str | None = None,
        issues: Sequence[SketchIssue] = (),
        done: PlanBatch | None = None,
    ) -> None:
        super().__init__(message)
        self.message = message
        self.line = line
        self.source = source
        self.issues = tuple(issues)
        self.done = done

    @property
    def kind(self) -> str:
        """The name of the class, for logs and feedback."""
        return type(self).__name__

    def __str__(self) -> str:
        return self.message if self.line is None else f"line {self.line}: {self.message}"

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.message, self.line, self.source, self.issues, self.done)


class SketchSyntaxError(SketchError):
    """The text is no Python."""


class SketchRuntimeError(SketchError):
    """The program raised an exception."""


class SketchContractError(SketchError):
    """The program runs but is not what was asked for; `issues` has all the reasons."""

    @classmethod
    def of(cls, issues: Sequence[SketchIssue]) -> "SketchContractError":
        """One error for all issues; it has a line only if there is just one."""
        if len(issues) == 1:
            return cls(issues[0].message, issues[0].line, issues[0].source, issues)
        return cls("\n".join(map(str, issues)), issues=issues)


class SketchTimeout(SketchError):
    """Loading, one call or a batch took too long."""


class SketchMemoryError(SketchError):
    """The program wanted more memory than it may have."""


class SketchCrash(SketchError):
    """The program's process died, or answered something that no honest program makes it answer."""


class SandboxUnavailable(Proc3sError):
    """Programs cannot be locked in on this machine, so none is run."""

    def __init__(self, reason: str) -> None:
        super().__init__(
            f"programs written by a language model cannot be locked in here: {reason}. They need Linux "
            "(x86-64 or arm64) with seccomp filters: use such a machine, a container, a virtual machine or "
            "WSL 2, leave the sandbox or container profile that forbids the filter, or run them unlocked, "
            "with all your rights and at your own risk, by --unsafe-exec"
        )
        self.reason = reason

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.reason,)
