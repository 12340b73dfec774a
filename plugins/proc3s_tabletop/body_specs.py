"""Bodies as a `domain.yaml` declares them: a shape, its measures in metres, mass and friction."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from proc3s import SpecError
from proc3s.errors import Issue, did_you_mean
from proc3s.specfile import validate
from proc3s_tabletop.bodies import CATEGORIES, Body, Bowl, Box, Cylinder, Mesh, Shape

Length = Annotated[float, Field(gt=0, allow_inf_nan=False)]
Friction = Annotated[float, Field(ge=0, allow_inf_nan=False)]


class BodySpec(BaseModel):
    """What every body has: a mass in kg and coefficients of friction."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)
    made: ClassVar[type[Any]]

    shape: str
    mass: Length
    """kg"""
    friction: Friction = 0.6
    rolling_friction: Friction = 0.0
    spinning_friction: Friction = 0.0

    def body(self, folder: Path | None) -> Body:
        """The body; files are looked for in `folder`."""
        common = {name: getattr(self, name) for name in BodySpec.model_fields if name != "shape"}
        own = {n: getattr(self, n) for n in type(self).model_fields if n not in BodySpec.model_fields}
        return Body(self._shape(own, folder), **common)

    def _shape(self, own: dict[str, Any], folder: Path | None) -> Shape:
        shape: Shape = self.made(**own)
        return shape


class BoxSpec(BodySpec):
    """`{shape: box, size: [0.04, 0.04, 0.04], mass: 0.06}`."""

    made: ClassVar[type[Any]] = Box
    shape: Literal["box"]
    size: tuple[Length, Length, Length]
    """Edges along x, y and z, m."""


class CylinderSpec(BodySpec):
    """`{shape: cylinder, radius: 0.03, height: 0.1, mass: 0.3}`, upright."""

    made: ClassVar[type[Any]] = Cylinder
    shape: Literal["cylinder"]
    radius: Length
    height: Length


class BowlSpec(BodySpec):
    """`{shape: bowl, mass: 0.3}`, with the measures of a cereal bowl unless others are given."""

    made: ClassVar[type[Any]] = Bowl
    shape: Literal["bowl"]
    rim_radius: Length = Bowl.rim_radius
    foot_radius: Length = Bowl.foot_radius
    height: Length = Bowl.height
    wall: Length = Bowl.wall
    wedges: int = Field(Bowl.wedges, ge=6, le=64)

    @model_validator(mode="after")
    def _hollow(self) -> "BowlSpec":
        if self.wall >= min(self.foot_radius, self.height) or self.foot_radius > self.rim_radius:
            raise ValueError("a bowl has wall < foot_radius <= rim_radius, and wall < height")
        return self


class MeshSpec(BodySpec):
    """`{shape: mesh, path: meshes/cup.obj, size: [0.08, 0.08, 0.1], mass: 0.2}`: convex pieces."""

    made: ClassVar[type[Any]] = Mesh
    shape: Literal["mesh"]
    path: str
    """A Wavefront OBJ file beside the `domain.yaml`, in metres, one `o` group a convex piece."""
    size: tuple[Length, Length, Length]
    """Its extent, m; the origin is in the middle."""

    def _shape(self, own: dict[str, Any], folder: Path | None) -> Shape:
        return Mesh(str((folder or Path()) / self.path), self.size)


SHAPES: Mapping[str, type[BodySpec]] = {
    "box": BoxSpec,
    "cylinder": CylinderSpec,
    "bowl": BowlSpec,
    "mesh": MeshSpec,
}


def bodies_of(given: Mapping[str, Any] | None, folder: Path | None = None) -> Mapping[str, Body]:
    """The body of every category; block and bowl where none are given.

    Raises SpecError that names the category and the field.
    """
    if given is None:
        return CATEGORIES
    return {category: _body(f"bodies.{category}", spec, folder) for category, spec in given.items()}


def body_of(categories: Mapping[str, Body], name: str, category: str) -> Body:
    """The body of an object of a state. Raises SpecError for a category without a body."""
    if category not in categories:
        known = ", ".join(sorted(categories))
        raise SpecError([Issue(name, "category", f"no body for {category!r}; there are {known}")])
    return categories[category]


def _body(where: str, given: Any, folder: Path | None) -> Body:
    shape = given.get("shape") if isinstance(given, Mapping) else None
    if not isinstance(shape, str) or shape not in SHAPES:
        text = "is missing" if shape is None else f"there is no shape {shape!r}"
        raise SpecError([Issue(where, "shape", text + did_you_mean(str(shape), SHAPES))])
    return validate(SHAPES[shape], given, where).body(folder)
