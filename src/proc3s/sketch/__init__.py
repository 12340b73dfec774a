"""The program that a language model wrote: taken from its answer, locked in, checked and asked for plans."""

from proc3s.sketch.box import BoxedSketch, Limits, Program, prewarm
from proc3s.sketch.errors import (
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
from proc3s.sketch.extract import extract_program

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
    "extract_program",
    "prewarm",
]
