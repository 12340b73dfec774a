"""Values as the Python source that builds them."""

import dataclasses
import math
from typing import Any


def source_text(value: Any, decimals: int | None = None) -> str:
    """A value as the Python expression that builds it: what the LLM reads and what the box evaluates.

    `decimals` rounds numbers for reading; without it every float keeps its full precision.
    Raises ValueError on a number that is not finite.
    """
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        inside = ((f.name, getattr(value, f.name)) for f in dataclasses.fields(value))
        return f"{type(value).__name__}({', '.join(f'{n}={source_text(v, decimals)}' for n, v in inside)})"
    if isinstance(value, tuple | list):
        return f"[{', '.join(source_text(v, decimals) for v in value)}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{k!r}: {source_text(v, decimals)}' for k, v in value.items())}}}"
    if isinstance(value, float):
        if not math.isfinite(value):
            raise ValueError(f"{value} is not a finite number")
        return repr(value if decimals is None else round(value, decimals) + 0.0)
    return repr(value)
