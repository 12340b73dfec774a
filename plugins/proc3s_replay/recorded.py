"""Answers of a model that come with proc3s: recordings like any other, kept beside this module."""

from pathlib import Path

from proc3s import LLMError
from proc3s_replay.replay import Options, Replay

FOLDER = Path(__file__).parent / "recordings"


def recorded(argument: str, options: Options) -> Replay:
    """A replay of the bundled recordings. Raises LLMError for a name behind `recorded`."""
    if argument:
        raise LLMError(f"recorded plays what comes with proc3s; for {argument} it is --llm replay:{argument}")
    return Replay(str(FOLDER), options, record=Path("answers"))  # not into the installation
