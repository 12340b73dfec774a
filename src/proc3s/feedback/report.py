"""The diagnosis of a round as data: failures and constraints, with their shares."""

from pydantic import BaseModel, ConfigDict

from proc3s.feedback.parameters import BoundHit, Separation


class Failure(BaseModel):
    """One way in which samples failed: at a step by a violation, or by an error of the program."""

    model_config = ConfigDict(frozen=True, use_attribute_docstrings=True)

    kind: str
    """Name of the constraint, or of the program error."""
    text: str
    """The sentence of the violation or the message of the error."""
    step: int | None = None
    """Step of the plan, from 0; None for an error."""
    skill: str | None = None
    """The skill of that step; `goal` where the plan missed the goal."""
    line: int | None = None
    """Line of the program, for an error."""
    source: str | None = None
    """That line."""
    share: int
    """Percent of the samples, as `shares` rounds it so that the text is stable."""
    parameters: str = ""
    """In which samples an error occurred, if not in all: the parameters that tell them from the others."""

    @property
    def told(self) -> str:
        """The failure on one line."""
        if self.step is not None:
            return f"step {self.step} ({self.skill}): {self.text}"
        line = f" (line {self.line}: {(self.source or '').strip()})" if self.line else ""
        return f"{self.kind}: {self.text}{line}" + (f", {self.parameters}" if self.parameters else "")


class ConstraintReport(BaseModel):
    """How one constraint was violated over all samples."""

    model_config = ConfigDict(frozen=True, use_attribute_docstrings=True)

    constraint: str
    """Its name; `goal` where plans missed the goal."""
    share: int
    """Percent of the samples whose first violation it is, as `shares` rounds it."""
    steps: tuple[int, ...]
    """Steps at which it was violated, from 0."""
    texts: tuple[str, ...]
    """Its commonest sentences."""
    best_margin: float
    """The margin of the nearest miss, in the constraint's unit; negative."""
    room: str = ""
    """Of plans that only a rehearsal refused: the most that one of them has without errors, and where."""


class Diagnosis(BaseModel):
    """Why a round did not end in an accepted plan; one object for the LLM, the console and the log."""

    model_config = ConfigDict(frozen=True, use_attribute_docstrings=True)

    samples: int
    """Verdicts taken in the round."""
    alike: bool = False
    """These first samples all raised the same exception at the same line, so that no more were drawn."""
    reached: int = 0
    """Most steps that any sample carried out before its first violation."""
    failures: tuple[Failure, ...] = ()
    """Ways to fail, commonest first."""
    program_errors: tuple[Failure, ...] = ()
    """Why the program could not be used, or had to be stopped."""
    constraints: tuple[ConstraintReport, ...] = ()
    """The same failures by constraint, commonest first."""
    never_violated: tuple[str, ...] = ()
    """Constraints that no sample violated first."""
    separations: tuple[Separation, ...] = ()
    """Parameters whose values tell better samples from worse ones."""
    bound_hits: tuple[BoundHit, ...] = ()
    """Bounds of gen_domain that the better samples press against."""

    @property
    def commonest(self) -> Failure | None:
        """What ended the program, or else the commonest failure of its samples."""
        return next(iter((*self.program_errors, *self.failures)), None)

    @property
    def progress(self) -> tuple[float, float]:
        """How far the round got: furthest step, then the nearest miss."""
        if not self.samples:
            return (-1.0, 0.0)
        return (self.reached, max((report.best_margin for report in self.constraints), default=0.0))
