"""The program that a language model wrote: taken from its answer, locked in, checked and asked for plans."""

from proc3s.sandbox.box import BoxedSketch, Limits, Program, prewarm
from proc3s.sandbox.errors import (
    SandboxUnavailable,
    SketchContractError,
    SketchCrash,
    SketchError,
    SketchIssue,
    SketchMemoryError,
    SketchRuntimeError,
    SketchSyntaxError,
    SketchTimeout,
)

__all__ = [
    "BoxedSketch",
    "Limits",
    "Program",
    "SandboxUnavailable",
    "SketchContractError",
    "SketchCrash",
    "SketchError",
    "SketchIssue",
    "SketchMemoryError",
    "SketchRuntimeError",
    "SketchSyntaxError",
    "SketchTimeout",
    "prewarm",
]
