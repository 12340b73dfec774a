"""How long, how much, how large: what a program may use up."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Limits:
    """Limits of one program; times in wall-clock seconds unless they say CPU, sizes in bytes."""

    load: float = 2.0
    call: float = 1.0
    batch: float = 30.0
    memory: int = 512 << 20
    """On top of what the worker has when it is ready."""
    cpu: int = 3600
    """CPU seconds over the worker's life: stops it when nobody is left to watch the other limits."""
    frame: int = 256 << 10
    """One reply."""
    replies: int = 32 << 20
    """All replies of one batch."""
    actions: int = 500
    restarts: int = 25
    """Samples that may hang or kill their process before the program is given up."""
    source: int = 64 << 10
    printed: int = 4 << 10
    """Characters kept of what one call, or loading, prints."""
    start: float = 30.0
    """Until a worker is ready, before it has seen any program."""
