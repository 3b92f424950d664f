"""Functions that add shapes, lights and models to a world."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from linkwright.diagnostics import phrase
from linkwright.sdf.editing import writing
from linkwright.sdf.editing.changing import pose_in_world
from linkwright.sdf.editing.errors import EditError
from linkwright.sdf.editing.shapes import ShapeKind, format_lengths, is_size, make_element, make_geometry, make_inertial
from linkwright.sdf.editing.text import WorldText
from linkwright.sdf.includes import resolve_includes
from linkwright.sdf.lights import Light
from linkwright.sdf.models import Include, Model
from linkwright.sdf.resources import Missing
from linkwright.sdf.worlds import Sdf, World
from linkwright.xmltree import Element

LightKind = Literal["point", "directional", "spot"]


@dataclass(frozen=True, slots=True)
class NewShape:
    """The defaults of a new shape: its size in m, its color and its mass in kg.

    The color is red, green and blue from 0 to 1. A mass of None makes the shape static.
    """

    size: tuple[float, ...]
    color: tuple[float, float, float]
    mass: float | None = 1.0


DEFAULT_SHAPES: dict[ShapeKind, NewShape] = {
    "box": NewShape((0.5, 0.5, 0.5), (0.9, 0.4, 0.1)),
    "cylinder": NewShape((0.25, 0.5), (0.2, 0.5, 0.8)),
    "sphere": NewShape((0.25,), (0.3, 0.7, 0.3)),
    "wall": NewShape((2.0, 0.1, 1.0), (0.8, 0.8, 0.75), None),
    "ramp": NewShape((1.5, 1.0, 0.3), (0.85, 0.65, 0.35), None),
}
_LIGHTS: dict[LightKind, tuple[Element, ...]] = {
    "point": (
        make_element("diffuse", "0.8 0.8 0.8 1"),
        make_element("specular", "0.2 0.2 0.2 1"),
        make_element(
            "attenuation", make_element("range", "20"), make_element("constant", "0.5"), make_element("linear", "0.1")
        ),
    ),
    "directional": (
        make_element("cast_shadows", "true"),
        make_element("diffuse", "0.8 0.8 0.8 1"),
        make_element("specular", "0.2 0.2 0.2 1"),
        make_element("direction", "-0.5 0.1 -0.9"),
    ),
    "spot": (
        make_element("cast_shadows", "true"),
        make_element("diffuse", "0.8 0.8 0.8 1"),
        make_element("specular", "0.2 0.2 0.2 1"),
        make_element(
            "attenuation", make_element("range", "20"), make_element("constant", "0.5"), make_element("linear", "0.1")
        ),
        make_element("direction", "0 0 -1"),
        make_element(
            "spot", make_element("inner_angle", "0.4"), make_element("outer_angle", "0.8"), make_element("falloff", "1")
        ),
    ),
}
_ENTITY_TAGS = ("model", "include", "light", "actor")
"""New elements are inserted after the last element with one of these tags."""


def add_shape(
    world: WorldText, kind: ShapeKind, pose: Sequence[float], size: Sequence[float] = ()
) -> tuple[WorldText, str]:
    """Add a model that consists of one simple shape.

    Args:
        world: the world, which stays unchanged.
        kind: the kind of shape; walls and ramps are static, the others have a mass of 1 kg.
        pose: the pose of the shape's center in the world: x, y, z in m, roll, pitch, yaw in rad.
        size: the size as in `SimpleShape`; empty for the default size.

    Returns:
        The changed world, and the name of the model.

    Raises:
        EditError: the pose or the size is invalid.
    """
    defaults = DEFAULT_SHAPES[kind]
    shape_size = tuple(map(float, size)) or defaults.size
    if not is_size(kind, shape_size):
        raise EditError(
            phrase("'{numbers}' is not a valid size for a {kind}", numbers=" ".join(map(str, size)), kind=kind)
        )
    name = world.choose_free_name(kind)
    color = format_lengths((*defaults.color, 1.0))
    children = [
        make_element("collision", *make_geometry(kind, shape_size), name="collision"),
        make_element(
            "visual",
            *make_geometry(kind, shape_size),
            make_element("material", make_element("ambient", color), make_element("diffuse", color)),
            name="visual",
        ),
    ]
    if defaults.mass is not None:
        children.insert(0, make_inertial(kind, shape_size, defaults.mass))
    static_elements = [] if defaults.mass is not None else [make_element("static", "true")]
    link = make_element("link", *children, name=kind if kind in ("wall", "ramp") else "link")
    model = make_element("model", writing.make_pose_element(pose_in_world(pose)), *static_elements, link, name=name)
    return _insert(world, model), name


def add_light(world: WorldText, kind: LightKind, pose: Sequence[float]) -> tuple[WorldText, str]:
    """Add a light with default properties.

    Args:
        world: the world, which stays unchanged.
        kind: the kind of light.
        pose: the pose of the light in the world: x, y, z in m, roll, pitch, yaw in rad.

    Returns:
        The changed world, and the name of the light.

    Raises:
        EditError: the pose is invalid.
    """
    name = world.choose_free_name(f"{kind}_light")
    light = make_element("light", writing.make_pose_element(pose_in_world(pose)), *_LIGHTS[kind], name=name, type=kind)
    return _insert(world, light), name


def add_include(world: WorldText, address: str, pose: Sequence[float]) -> tuple[WorldText, str]:
    """Add an include of a model from another file.

    Args:
        world: the world, which stays unchanged.
        address: ``model://NAME``, or any other value that ``<uri>`` may have.
        pose: the pose of the model's frame in the world: x, y, z in m, roll, pitch, yaw in rad.

    Returns:
        The changed world, and the name of the included model.

    Raises:
        EditError: there is no such model, or the pose is invalid.
    """
    address = address.strip()
    if not address:
        raise EditError(phrase("'{uri}' does not name a model", uri=address))
    model_path = world.finder.model(address, world.path.parent)
    if isinstance(model_path, Missing):
        raise EditError(model_path.reason)
    include_world = World(includes=(Include(address),))
    included = resolve_includes(Sdf("1.6", worlds=(include_world,)), world.path, world.finder).sdf.worlds[0]
    entities: tuple[Model | Light, ...] = (*included.models, *included.lights)
    if not entities:
        raise EditError(phrase("there is no model in '{address}'", address=address))
    name = world.choose_free_name(entities[0].name)
    pose_element = writing.make_pose_element(pose_in_world(pose))
    return _insert(
        world, make_element("include", make_element("uri", address), make_element("name", name), pose_element)
    ), name


def _insert(world: WorldText, element: Element) -> WorldText:
    return world.apply_edits([writing.make_insertion_edit(world.element, [element], after=_ENTITY_TAGS)])
