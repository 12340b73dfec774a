"""Which LLM is asked when the command line names none: environment, project, user, in this order."""

import os
import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from pydantic import Field

from proc3s.errors import UsageError
from proc3s.specs.base import Spec
from proc3s.specs.yaml_files import validate
from proc3s.textfiles import read_text

VARIABLE = "PROC3S_LLM"
FILE = "proc3s.toml"
DEFAULT_LLM = "replay"


class Config(Spec):
    """A `proc3s.toml`."""

    llm: str
    """As after `--llm`."""
    llm_options: dict[str, str | int | float | bool] = Field(default_factory=dict)
    """As after `-L`; they hold for this LLM only."""


@dataclass(frozen=True)
class ChosenLLM:
    """The LLM of a run, and who chose it."""

    name: str
    options: Mapping[str, str] = field(default_factory=dict)
    by: str = "default"


def choose_llm(name: str | None, options: Mapping[str, str]) -> ChosenLLM:
    """What `--llm` and `-L` name, else the environment, the project's file, the user's file, the default.

    A file's options count for the LLM that it names, and `-L` goes before them. Raises UsageError or
    SpecError for a file that is wrong.
    """
    configured = next(_configured(), None)
    variable = os.environ.get(VARIABLE, "").strip()
    if name is not None:
        chosen = ChosenLLM(name, by="--llm")
    elif variable:
        chosen = _worded(variable)
    elif configured is not None:
        chosen = configured
    else:
        chosen = ChosenLLM(DEFAULT_LLM)
    inherited = configured.options if configured and configured.name == chosen.name else {}
    return ChosenLLM(chosen.name, {**inherited, **chosen.options, **options}, chosen.by)


def _worded(variable: str) -> ChosenLLM:
    """`NAME -L key=value …`, as on the command line; quotes are for the shell that sets the variable."""
    name, *options = re.split(r"\s+-L[\s=]*", variable)
    for option in options:
        if not re.match(r"\w+=", option):
            raise UsageError(f"{VARIABLE} takes options as in `PROVIDER/MODEL -L key=value`, not {option!r}")
    return ChosenLLM(name, dict(option.split("=", 1) for option in options), VARIABLE)


def files() -> tuple[Path, Path]:
    """Where a `proc3s.toml` may lie: in the working directory, and in the user's configuration folder."""
    import platformdirs

    return Path(FILE), platformdirs.user_config_path("proc3s") / FILE


def _configured() -> Iterator[ChosenLLM]:
    for path in files():
        if path.exists():
            config = _read(path)
            yield ChosenLLM(config.llm, {k: _text(v) for k, v in config.llm_options.items()}, str(path))


def _read(path: Path) -> Config:
    try:
        return validate(Config, tomllib.loads(read_text(path)), str(path))
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"{path} cannot be read: {error}") from error
    except (ValueError, RecursionError) as error:  # of TOML, of a number too long, of too many levels
        raise UsageError(f"{path}: {error}") from error


def _text(value: str | int | float | bool) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
