"""What a check says, before it is put into words for a person."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    """What is wrong; a note where `error` is not set. `where` and `mend` replace what the check says."""

    text: str
    where: str = ""
    mend: str = ""
    error: bool = True
