"""The declarative half of every plugin: pydantic specs, frozen, closed to unknown keys.

YAML (or a plugin's Python) says *what*, in words and numbers; `target` says which Python says *how*.
"""

import importlib
import re
from string import Formatter
from typing import Annotated, Any, ClassVar

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
)

from proc3s.errors import Issue, SpecError, blame, did_you_mean, worded
from proc3s.specs.given import address

Identifier = Annotated[str, Field(pattern=r"^[A-Za-z_][A-Za-z0-9_]*$", max_length=80)]


ImportString = Annotated[
    str, BeforeValidator(address), Field(pattern=r"^[\w.]+:\w+$", examples=["my_package.world:MyWorld"])
]


Count = Annotated[int, Field(ge=1)]


def _sentence(text: str) -> str:
    """Raises ValueError if a sentence cannot be filled in."""
    placeholders(text)
    return text


Sentence = Annotated[str, AfterValidator(_sentence)]


def placeholders(text: str) -> list[str]:
    """The names in `{…}` of a sentence. Raises ValueError if it is malformed; `{{` and `}}` are braces."""
    try:
        fields = [field for _, field, _, _ in Formatter().parse(text) if field is not None]
        names = [re.split(r"[.[]", field)[0] for field in fields]
        text.format_map(dict.fromkeys(names, "x"))
    except (ValueError, KeyError, IndexError, AttributeError, TypeError) as error:
        raise ValueError(
            f"cannot be filled in ({error}); a detail is named {{so}}, a brace is {{{{"
        ) from error
    if strange := [name for name in names if not name.isidentifier()]:
        raise ValueError(f"a detail has a name, not {strange[0]!r}; a brace is {{{{")
    return names


class Spec(BaseModel):
    """Base of all specs. `kind` is the plural under which `proc3s list` shows them."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True, allow_inf_nan=False)
    kind: ClassVar[str] = ""


class Target(Spec):
    """A Python object to call: `target: "package.module:name"`, with keyword arguments."""

    target: ImportString
    """`package.module:name` of a class or function, in Python also the object; the spec says what it gets."""
    args: dict[str, Any] = Field(default_factory=dict)
    """Further keyword arguments of the call. In a file, `./name` is a path beside the file."""

    def load(self) -> Any:
        """The object that `target` names. Raises SpecError if it cannot be imported."""
        module_name, _, name = self.target.partition(":")
        try:
            with blame("target"):  # a module may raise anything while it is imported
                module = importlib.import_module(module_name)
        except SpecError as error:
            text = f"cannot be imported: {worded(error.__cause__ or error)}"
            raise SpecError([Issue(self.target, "target", text)]) from error
        if not hasattr(module, name):
            public = [n for n in vars(module) if not n.startswith("_")]
            message = f"{module_name} has no {name!r}{did_you_mean(name, public)}"
            raise SpecError([Issue(self.target, "target", message)])
        return getattr(module, name)
