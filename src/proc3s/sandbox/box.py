"""The boxed sketch: a program of a language model, loaded in a locked worker process of its own."""

import json
import weakref
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from proc3s.domain.plan_batch import PlanBatch, Signature
from proc3s.domain.samplers import Space
from proc3s.domain.values import FloatArray
from proc3s.errors import Proc3sError
from proc3s.sandbox.boxed.wire import ERROR, LOAD, LOADED, PROBE, PROBED
from proc3s.sandbox.channel import Channel, as_rows, lie
from proc3s.sandbox.columns import Columns
from proc3s.sandbox.contract import OpenParameter, in_order, issue, open_parameters, space_of
from proc3s.sandbox.errors import SketchContractError, SketchCrash, SketchError
from proc3s.sandbox.limits import Limits
from proc3s.sandbox.process import launcher
from proc3s.sandbox.protocol import (
    CONTENTS,
    FAULT,
    PROBLEMS,
    Contents,
    Malformed,
    Problems,
    Replies,
    error_of,
    parse,
)
from proc3s.sandbox.restarts import Restarts, in_both, told_of_all
from proc3s.sandbox.template import Kind
from proc3s.sandbox.text import Source, clean, message
from proc3s.specs.domain import SamplerSpec

_DRAWS = 8
"""Samples that must share a fault for it to be one of the program itself."""
_HANGS = 3
"""Samples that must hang for the program to be given up."""

__all__ = ["BoxedSketch", "Limits", "Program", "prewarm"]


@dataclass(frozen=True)
class Program:
    """A program and all that the box must know to run it: plain data.

    `prelude` is trusted Python that defines the constants, the mutable classes of the state, a class for
    each sampler (same name and fields as its spec) and `Action(name, params)`; `initial` is a trusted
    expression that builds the initial state from them.
    """

    source: str
    answer: Literal["sketch", "program", "plan"]
    prelude: str
    initial: str
    signatures: tuple[Signature, ...]
    samplers: tuple[SamplerSpec, ...]
    seed: int = 0


class BoxedSketch:
    """A loaded program. A context manager; `close` may be called any number of times.

    `space` holds its open parameters in the order of gen_plan, `log` what it printed while loading.
    `locked=False` runs the program with your rights, without the kernel's lock; `friendly=False` gives it
    all builtins and Python's own messages for imports, without any loss of safety.
    `probe=False` loads a program that was found to be sound before, and so draws no plan to check.
    Raises SketchError if the program does not load or breaks the contract, SandboxUnavailable if it
    cannot be locked in.
    """

    space: Space
    log: str

    def __init__(
        self,
        program: Program,
        limits: Limits = Limits(),  # noqa: B008 - frozen
        *,
        locked: bool = True,
        friendly: bool = True,
        probe: bool = True,
    ) -> None:
        self._program = program
        self._limits = limits
        self._locked, self._friendly = locked, friendly
        self._source = Source(program.source)
        self._columns = Columns(program.signatures)
        self._next_sample = 0
        self._restarts = Restarts(limits.restarts)
        _check_size(program.source, limits)
        self._start()
        try:
            self.space = space_of(self._load(probe))
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> "BoxedSketch":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the worker."""
        self._end()

    def plans(self, u: FloatArray, first: int | None = None) -> PlanBatch:
        """The plans for points u of the unit cube, shape (n, dim).

        Samples that fail land in the batch's `errors`. So does one that hangs or kills its process, and the
        others go on in a fresh one. If too many do, or a batch exceeds a limit, the box closes and the
        SketchError that is raised has the finished samples as `done`. Samples are numbered over the life of
        the box, and the number seeds `random`; `first` sets the number of the first one, to run a sample of
        an earlier box again. Raises ValueError on a wrong shape.
        """
        if u.ndim != 2 or u.shape[1] != self.space.dim:
            raise ValueError(f"u must have shape (n, {self.space.dim}), not {u.shape}")
        if not self._end.alive:
            raise SketchCrash("the program's process has ended")
        first = self._next_sample if first is None else first
        replies = Replies(first, len(u), self._source, self._limits)
        try:
            self._run(as_rows(self.space.decode(u)), replies)
        except SketchError as error:
            self.close()
            error.done = self._columns.batch(replies)
            raise
        except BaseException:
            self.close()
            raise
        self._next_sample = first + len(u)
        return self._checked(self._columns.batch(replies), replies)

    def _run(self, rows: FloatArray, replies: Replies) -> None:
        while replies.done < replies.count:
            try:
                self._channel.run(rows, replies)
            except SketchError as error:
                self._restarts.spend(error, replies.first + replies.done)
                replies.fail(error)
                self._renew()

    def _checked(self, batch: PlanBatch, replies: Replies) -> PlanBatch:
        if len(batch) < replies.done:
            self.close()
            error = lie(Malformed("a plan does not fit its skills"))
            error.done = batch
            raise error
        return batch

    def _start(self) -> None:
        """Start a worker for this sketch."""
        worker = launcher().take(Kind(self._limits.memory, self._limits.cpu, self._locked))
        self._channel = Channel(worker, self._source, self._limits)
        self._end = weakref.finalize(self, self._channel.close)

    def _renew(self) -> None:
        """Replace a worker that hangs or has died."""
        self.close()
        self._start()
        try:
            again = self._contents()
        except Malformed as error:
            raise lie(error) from error
        if again.parameters != self._declared:
            raise SketchContractError("gen_domain gave other samplers when it was called again")

    def _load(self, probe: bool) -> list[OpenParameter]:
        """Load, check the contract, and return the parameters; all breaches are raised at once."""
        try:
            contents = self._contents()
            self._declared = contents.parameters
            self.log = clean(contents.log, self._limits.printed)
            parameters, issues = open_parameters(contents, self._program.samplers, self._source)
            problems = contents.problems + (self._shared_problems(parameters) if probe else [])
        except Malformed as error:
            raise lie(error) from error
        issues += [issue(text, line, self._source) for text, line in problems]
        if issues:
            raise SketchContractError.of(in_order(issues))
        if any(p.sampler is None for p in parameters):
            raise lie(Malformed("a parameter has no sampler"))
        return parameters

    def _shared_problems(self, parameters: list[OpenParameter]) -> Problems:
        """Problems that the plan at the centre of the space and those of several random draws share.

        Problems of some draws only are left to the samples, which show how often they occur, and where.
        """
        rng = np.random.default_rng(self._program.seed)
        draws, hung = (_DRAWS if parameters else 1), 0
        shared: Problems | None = None
        for sample in range(draws):
            drawn = [number for p in parameters for number in p.drawn(rng if sample else None)]
            try:
                found = self._problems(sample, drawn)
            except SketchError as error:
                hung += 1
                if hung >= min(_HANGS, draws, self._limits.restarts + 1) or not error.alone:
                    raise told_of_all(error, hung) from None
                self._renew()
                found = []
            else:
                if hung:
                    return []  # this draw does not hang
            shared = in_both(shared, found)
            if not shared and not hung:
                return []
        return shared or []

    def _problems(self, sample: int, drawn: list[float | None]) -> Problems:
        body = json.dumps([sample, drawn]).encode()
        _, answer = self._channel.ask(PROBE, body, PROBED, self._limits.call, "one call of gen_plan")
        return parse(PROBLEMS, answer)

    def _contents(self) -> Contents:
        """Load the program. Raises SketchError, Malformed, SandboxUnavailable."""
        self._channel.wait_until_ready()
        body = json.dumps(_request(self._program, self._limits, self._friendly)).encode()
        kind, answer = self._channel.ask(LOAD, body, LOADED, self._limits.load, "loading the program")
        if kind != ERROR:
            return parse(CONTENTS, answer)
        fault = parse(FAULT, answer)
        if fault.kind == "prelude":
            raise Proc3sError(f"the domain's classes or initial state do not run: {message(fault.message)}")
        raise error_of(fault, self._source)


def prewarm(limits: Limits = Limits(), locked: bool = True) -> None:  # noqa: B008 - frozen
    """Start a worker for the next BoxedSketch with these limits now. Raises SandboxUnavailable."""
    launcher().warm(Kind(limits.memory, limits.cpu, locked))


def _check_size(source: str, limits: Limits) -> None:
    size = len(source.encode("utf-8", "surrogatepass"))
    if size > limits.source:
        raise SketchContractError(f"the program has {size} bytes, at most {limits.source} are possible")


def _request(program: Program, limits: Limits, friendly: bool) -> dict[str, Any]:
    return {
        "friendly": friendly,
        "source": program.source,
        "answer": program.answer,
        "prelude": program.prelude,
        "initial": program.initial,
        "seed": program.seed,
        "actions": limits.actions,
        "frame": limits.frame,
        "printed": limits.printed,
        "signatures": [
            (s.skill, [(p.name, p.type, p.choices) for p in s.params]) for s in program.signatures
        ],
        "samplers": {s.name: {"params": s.params, "gives": s.gives} for s in program.samplers},
    }
