"""The element ``<geometry>``: the shapes of visuals and collisions, with lengths in meters.

Source of the elements and defaults: the SDFormat specification 1.12, ``geometry.sdf`` and the files of each shape.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.geometry.single import Vector3
from linkwright.sdf.values import (
    INTEGER,
    NUMBER,
    TEXT,
    TRUTH,
    VECTOR2,
    VECTOR3,
    object_rule,
    value,
    values,
    without_unreadable,
)


@dataclass(frozen=True, slots=True)
class Plane:
    """An infinite plane through the origin.

    `size` is the extent of its visible part.
    """

    normal: Vector3 = (0.0, 0.0, 1.0)
    size: tuple[float, float] = (1.0, 1.0)


@dataclass(frozen=True, slots=True)
class Ellipsoid:
    """An ellipsoid centered at the origin, with its semi-axes along x, y and z in meters."""

    radii: Vector3 = (1.0, 1.0, 1.0)


@dataclass(frozen=True, slots=True)
class Cone:
    """A cone along z with its tip at the top, centered at half its height.

    Lengths are in meters.
    """

    radius: float = 0.5
    length: float = 1.0


@dataclass(frozen=True, slots=True)
class Submesh:
    """A named part of a mesh file, centered at the origin if `center` is set."""

    name: str
    center: bool = False


@dataclass(frozen=True, slots=True)
class Mesh:
    """A mesh file or one of its submeshes, scaled along x, y and z."""

    uri: str
    scale: Vector3 = (1.0, 1.0, 1.0)
    submesh: Submesh | None = None


@dataclass(frozen=True, slots=True)
class TerrainTexture:
    """A texture of a heightmap: its color image, normal image and edge length in meters.

    The images are URIs.
    """

    diffuse: str = ""
    normal: str = ""
    size: float = 10.0


@dataclass(frozen=True, slots=True)
class Blend:
    """The transition from one texture of a heightmap to the next.

    The transition begins at `min_height`, and extends over `fade_dist`.
    """

    min_height: float = 0.0
    fade_dist: float = 0.0


@dataclass(frozen=True, slots=True)
class Heightmap:
    """Terrain with heights from the gray values of an image, or from a digital elevation model.

    Attributes:
        uri: the address of the file; an image has 2^n + 1 pixels along each side.
        size: the extent along x and y, and the height between the lowest and the highest value.
        position: the offset of the center.
        textures: the textures, from the lowest to the highest.
        blends: the transitions between consecutive textures.
        sampling: the number of heights per pixel.
    """

    uri: str
    size: Vector3 = (1.0, 1.0, 1.0)
    position: Vector3 = (0.0, 0.0, 0.0)
    textures: tuple[TerrainTexture, ...] = ()
    blends: tuple[Blend, ...] = ()
    sampling: int = 2


@dataclass(frozen=True, slots=True)
class Image:
    """A relief with a box wherever an image is brighter than a threshold.

    All boxes have the same height.
    """

    uri: str
    scale: float = 1.0
    threshold: int = 200
    height: float = 1.0
    granularity: int = 1


@dataclass(frozen=True, slots=True)
class Polyline:
    """A polygon in the plane z = 0, extruded along z to `height`."""

    points: tuple[tuple[float, float], ...]
    height: float = 1.0


@dataclass(frozen=True, slots=True)
class Empty:
    """A geometry without a shape."""


NO_SHAPE = Empty()

Shape = (
    Box
    | Capsule
    | Cone
    | Cylinder
    | Ellipsoid
    | Sphere
    | Plane
    | Mesh
    | Heightmap
    | Image
    | Polyline
    | tuple[Polyline, ...]
    | Empty
)


def _first_shape(**shapes: Shape | tuple[Polyline, ...] | None) -> Shape:
    """Return the first shape that is present, in libsdformat's order, or `NO_SHAPE`."""
    return next((shape for shape in shapes.values() if shape), NO_SHAPE)


def _shape_if(kind: type) -> Callable[[Shape], Shape | None]:
    """Return a function that returns its argument if it is a `kind`, and None otherwise.

    The function is used for writing.
    """
    return lambda shape: shape if isinstance(shape, kind) else None


_RADIUS = value("radius", NUMBER, "the radius", "m", default="1", usually_written=True)
_LENGTH = value("length", NUMBER, "the length along z", "m", default="1", usually_written=True)
_HALF = value("radius", NUMBER, "the radius", "m", default="0.5", usually_written=True)
_URI = value(
    "uri",
    TEXT,
    "the address: model://MODEL/PATH, package://PACKAGE/PATH, file://PATH or a relative path",
    default="",
    required=True,
)

GEOMETRY = object_rule(
    _first_shape,
    "geometry",
    "the shape",
    object_rule(
        Box,
        "box",
        "a box centered at the origin",
        value("size", VECTOR3, "the edge lengths along x, y, z", "m", default="1 1 1", usually_written=True),
        get=_shape_if(Box),
    ),
    object_rule(
        Capsule, "capsule", "a cylinder along z with a half sphere at each end", _HALF, _LENGTH, get=_shape_if(Capsule)
    ),
    object_rule(Cone, "cone", "a cone along z with its tip at the top", _HALF, _LENGTH, get=_shape_if(Cone)),
    object_rule(
        Cylinder, "cylinder", "a cylinder along z, centered at the origin", _RADIUS, _LENGTH, get=_shape_if(Cylinder)
    ),
    object_rule(
        Ellipsoid,
        "ellipsoid",
        "an ellipsoid centered at the origin",
        value("radii", VECTOR3, "the semi-axes along x, y, z", "m", default="1 1 1", usually_written=True),
        get=_shape_if(Ellipsoid),
    ),
    object_rule(Sphere, "sphere", "a sphere centered at the origin", _RADIUS, get=_shape_if(Sphere)),
    object_rule(
        Plane,
        "plane",
        "an infinite plane",
        value("normal", VECTOR3, "the normal of the plane", default="0 0 1", usually_written=True),
        value("size", VECTOR2, "the size of the visible part", "m", default="1 1", usually_written=True),
        get=_shape_if(Plane),
    ),
    object_rule(
        Mesh,
        "mesh",
        "a mesh file",
        _URI,
        value("scale", VECTOR3, "the scale factors along x, y, z", default="1 1 1"),
        object_rule(
            Submesh,
            "submesh",
            "a named part of the mesh file",
            value("name", TEXT, "the name of the part in the file", default=""),
            value("center", TRUTH, "whether the part is centered at the origin", default="false"),
        ),
        get=_shape_if(Mesh),
    ),
    object_rule(
        Heightmap,
        "heightmap",
        "terrain with heights from an image",
        _URI,
        value("size", VECTOR3, "the extent along x, y and z", "m", default="1 1 1", usually_written=True),
        value("pos", VECTOR3, "the offset of the center", "m", default="0 0 0", field="position"),
        object_rule(
            TerrainTexture,
            "texture",
            "a texture of the terrain; the first is the lowest",
            value("diffuse", TEXT, "the address of the color image", default=""),
            value("normal", TEXT, "the address of the normal image", default=""),
            value("size", NUMBER, "the edge length of the texture", "m", default="10"),
            is_repeated=True,
            field="textures",
        ),
        object_rule(
            Blend,
            "blend",
            "the transition from one texture to the next",
            value("min_height", NUMBER, "the height at which the transition begins", "m", default="0"),
            value("fade_dist", NUMBER, "the height over which the transition extends", "m", default="0"),
            is_repeated=True,
            field="blends",
        ),
        value("sampling", INTEGER, "the number of heights per pixel", default="2"),
        get=_shape_if(Heightmap),
    ),
    object_rule(
        Image,
        "image",
        "boxes wherever an image is bright",
        _URI,
        value("scale", NUMBER, "the meters per pixel", "m", default="1"),
        value("threshold", INTEGER, "the minimum brightness of a box, from 0 to 255", default="200"),
        value("height", NUMBER, "the height of the boxes", "m", default="1"),
        value("granularity", INTEGER, "the pixels per box along each side", default="1"),
        get=_shape_if(Image),
    ),
    object_rule(
        without_unreadable(Polyline),
        "polyline",
        "a polygon extruded along z; further polygons cut holes",
        values("point", VECTOR2, "x and y of a corner in meters"),
        value("height", NUMBER, "the height along z", "m", default="1", usually_written=True),
        is_repeated=True,
        get=lambda shape: shape if isinstance(shape, tuple) else (),
    ),
    object_rule(Empty, "empty", "no shape", get=_shape_if(Empty)),
    default=NO_SHAPE,
)
