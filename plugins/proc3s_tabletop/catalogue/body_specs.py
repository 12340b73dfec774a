"""Bodies as a `domain.yaml` declares them: a shape, its measures in metres, mass and friction."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BaseModel, ConfigDict, Field, field_validator, model_validator

from proc3s import SpecError
from proc3s.errors import Issue, did_you_mean
from proc3s.specs.yaml_files import validate
from proc3s_tabletop.catalogue import ycb
from proc3s_tabletop.meshes.prepare import prepare
from proc3s_tabletop.objects.body import CATEGORIES, Body
from proc3s_tabletop.objects.shapes import Bowl, Box, Cylinder, Shape

Length = Annotated[float, Field(gt=0, allow_inf_nan=False)]
Angle = Annotated[float, Field(allow_inf_nan=False)]
Friction = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Share = Annotated[float, Field(ge=0.001, le=0.5, allow_inf_nan=False)]


class BodySpec(BaseModel):
    """What every body has: a mass in kg and coefficients of friction."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)
    made: ClassVar[type[Any]]

    shape: str
    """Its kind."""
    mass: Length
    """kg"""
    friction: Friction = 0.6
    """Coefficient of sliding."""
    rolling_friction: Friction = 0.0
    """Coefficient of rolling, m."""
    spinning_friction: Friction = 0.0
    """Coefficient of turning on the spot, m."""

    def body(self) -> Body:
        """The body."""
        common = {name: getattr(self, name) for name in BodySpec.model_fields if name != "shape"}
        own = {n: getattr(self, n) for n in type(self).model_fields if n not in BodySpec.model_fields}
        return Body(self._shape(own), **common)

    def _shape(self, own: dict[str, Any]) -> Shape:
        shape: Shape = self.made(**own)
        return shape


class BoxSpec(BodySpec):
    """`{shape: box, size: [0.04, 0.04, 0.04], mass: 0.06}`."""

    made: ClassVar[type[Any]] = Box
    shape: Literal["box"]
    """Its kind."""
    size: tuple[Length, Length, Length]
    """Edges along x, y and z, m."""


class CylinderSpec(BodySpec):
    """`{shape: cylinder, radius: 0.03, height: 0.1, mass: 0.3}`, upright."""

    made: ClassVar[type[Any]] = Cylinder
    shape: Literal["cylinder"]
    """Its kind."""
    radius: Length
    """m"""
    height: Length
    """m"""


class BowlSpec(BodySpec):
    """`{shape: bowl, mass: 0.3}`, with the measures of a cereal bowl unless others are given."""

    made: ClassVar[type[Any]] = Bowl
    shape: Literal["bowl"]
    """Its kind."""
    rim_radius: Length = Bowl.rim_radius
    """Outer radius at the top, m."""
    foot_radius: Length = Bowl.foot_radius
    """Outer radius at the bottom, m."""
    height: Length = Bowl.height
    """m"""
    wall: Length = Bowl.wall
    """Thickness, m."""
    wedges: int = Field(Bowl.wedges, ge=6, le=64)
    """Convex pieces of the wall, around."""

    @model_validator(mode="after")
    def _hollow(self) -> "BowlSpec":
        if self.wall >= min(self.foot_radius, self.height) or self.foot_radius > self.rim_radius:
            raise ValueError("a bowl has wall < foot_radius <= rim_radius, and wall < height")
        return self


class MeshSpec(BodySpec):
    """`{shape: mesh, path: ./meshes/cup.stl, mass: 0.2}`: any file that trimesh reads: STL, OBJ, PLY."""

    shape: Literal["mesh"]
    """Its kind."""
    path: str
    """A file; `./…` is beside the `domain.yaml`."""
    scale: Length = 1.0
    """Metres for a one in the file: 0.001 where it is in mm."""
    turn: tuple[Angle, Angle, Angle] = (0.0, 0.0, 0.0)
    """Roll, pitch, yaw, rad, that bring it roughly to how it stands."""
    concavity: Share | None = None
    """How hollow a convex piece may be, a share of the longest edge; less makes more pieces, nearer to the
    mesh, and slower. By default a few cuts, or 0.02."""

    def body(self) -> Body:
        """The body at rest. Raises ValueError for a file that is missing or no mesh."""
        shape = prepare(Path(self.path), self.scale, self.turn, self.concavity)
        return Body(shape, self.mass, self.friction, self.rolling_friction, self.spinning_friction)


class YcbSpec(BaseModel):
    """`{shape: ycb, model: 011_banana}`: an object of the YCB set; mass and friction from a table."""

    model_config = BodySpec.model_config

    shape: Literal["ycb"]
    """Its kind."""
    model: str
    """With its number or without."""
    mass: Length | None = None
    """kg; by default that of the table, as what follows."""
    friction: Friction | None = None
    """Coefficient of sliding."""
    rolling_friction: Friction | None = None
    """Coefficient of rolling, m."""
    spinning_friction: Friction | None = None
    """Coefficient of turning on the spot, m."""
    concavity: Share | None = None
    """How hollow a convex piece may be, as of a mesh."""

    @field_validator("model")
    @classmethod
    def _exists(cls, name: str) -> str:
        model = ycb.named(name)
        if model is None:
            raise ValueError(f"there is no YCB model of this name{did_you_mean(name, ycb.models())}")
        return model

    @model_validator(mode="after")
    def _weighed(self) -> "YcbSpec":
        if self.mass is None and self.model not in ycb.table():
            raise ValueError(f"nobody weighed {self.model}: give its mass in kg")
        return self

    def body(self) -> Body:
        """The body at rest."""
        given = self.model_dump(exclude={"shape", "model", "concavity"}, exclude_none=True)
        known = ycb.table().get(self.model)
        shape = prepare(ycb.models()[self.model], concavity=self.concavity)
        return Body(shape, **{**(vars(known) if known else {}), **given})


SHAPES: Mapping[str, type[BodySpec | YcbSpec]] = {
    "box": BoxSpec,
    "cylinder": CylinderSpec,
    "bowl": BowlSpec,
    "mesh": MeshSpec,
    "ycb": YcbSpec,
}


def bodies_of(given: Mapping[str, Any] | None) -> Mapping[str, Body]:
    """The body of every category; block and bowl where none are given.

    Raises SpecError that names the category and the field.
    """
    if given is None:
        return CATEGORIES
    return {category: _body(f"bodies.{category}", spec) for category, spec in given.items()}


def body_of(categories: Mapping[str, Body], name: str, category: str) -> Body:
    """The body of an object of a state. Raises SpecError for a category without a body."""
    if category not in categories:
        known = ", ".join(sorted(categories))
        raise SpecError([Issue(name, "category", f"no body for {category!r}; there are {known}")])
    return categories[category]


def _body(where: str, given: Any) -> Body:
    shape = given.get("shape") if isinstance(given, Mapping) else None
    if not isinstance(shape, str) or shape not in SHAPES:
        text = "is missing" if shape is None else f"there is no shape {shape!r}"
        raise SpecError([Issue(where, "shape", text + did_you_mean(str(shape), SHAPES))])
    spec = validate(SHAPES[shape], given, where)
    try:
        return spec.body()
    except ValueError as error:
        raise SpecError([Issue(where, "path", str(error))]) from error
