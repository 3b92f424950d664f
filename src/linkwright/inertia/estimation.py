"""Estimate a link's mass properties from its shapes."""

from __future__ import annotations

from linkwright.diagnostics import LinkwrightError, Phrase, phrase, term
from linkwright.geometry.mass import MassProperties, combine
from linkwright.geometry.shapes import MAX_COORDINATE, shape_bounds
from linkwright.geometry.solids import shape_properties
from linkwright.inertia.mesh_library import MeshLibrary
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.loading.lean_typing import Literal
from linkwright.urdf import Collision, Link, Mesh, Visual

ShapeKind = Literal["collision", "visual"]

DEFAULT_DENSITY = 1000.0
"""The density of water in kg/m3. Most links of robots have a similar mean density, including their cavities."""


_MIN_VOLUME = 1e-18
"""The volume in m3 below which a shape counts as having no volume: that of a cube with edges of 0.001 mm."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """The mass properties of a link estimated from its shapes.

    Attributes:
        link: the link's name.
        properties: the mass properties in the link frame; None if no shape has a volume.
        kind: the kind of shapes that were used; None if there are none.
        shapes: the number of shapes that were used.
        basis: the source of the mass: ``mass`` (requested), ``density`` (requested or the default), ``present`` (the
            link's own ``<mass>``).
        density: the resulting mean density in kg/m3; 0 without properties.
        notes: remarks for the user, such as a hull in place of a mesh, or a shape that was not used.
    """

    link: str
    properties: MassProperties | None
    kind: ShapeKind | None
    shapes: int
    basis: Literal["mass", "density", "present"]
    density: float
    notes: tuple[Phrase, ...] = ()


def estimate(
    link: Link,
    meshes: MeshLibrary,
    *,
    density: float | None = None,
    mass: float | None = None,
    preferred_kind: ShapeKind = "collision",
) -> Estimate:
    """Estimate the mass properties of a link from its shapes, filled with a uniform density.

    Overlapping parts of shapes count twice. The mass is the requested mass, else the mass from the requested density,
    else the mass of the link in the file, else the mass from `DEFAULT_DENSITY`.

    Args:
        link: the link.
        meshes: the library that reads the link's meshes.
        density: the requested density in kg/m3.
        mass: the requested mass in kg.
        preferred_kind: the kind of shapes to use. If the link has none of these with a volume, the other kind is used.
    """
    notes: list[Phrase] = []
    kind: ShapeKind | None = None
    solids: list[MassProperties] = []
    other_kind: ShapeKind = "visual" if preferred_kind == "collision" else "collision"
    for candidate_kind in (preferred_kind, other_kind):
        shapes = link.collisions if candidate_kind == "collision" else link.visuals
        solids = [
            shape_solid
            for shape in shapes
            if (shape_solid := _shape_solid(shape, candidate_kind, meshes, notes)) is not None
        ]
        if solids:
            kind = candidate_kind
            break
    basis: Literal["mass", "density", "present"] = "density"
    if mass is not None:
        basis = "mass"
    elif density is None and link.inertial is not None and link.inertial.has_mass:
        basis, mass = "present", link.inertial.mass
    if kind is None:
        return Estimate(link.name, None, None, 0, basis, 0.0, tuple(notes))
    if kind != preferred_kind and (link.collisions if preferred_kind == "collision" else link.visuals):
        notes.append(phrase("the {kind} shapes are used instead", kind=term(kind)))
    solid = combine(solids)
    if mass is not None:
        properties = solid.with_mass(mass)
    else:
        properties = solid.with_scaled_density(DEFAULT_DENSITY if density is None else density)
    return Estimate(link.name, properties, kind, len(solids), basis, properties.mass / solid.mass, tuple(notes))


def _shape_solid(
    shape: Collision | Visual, kind: ShapeKind, meshes: MeshLibrary, notes: list[Phrase]
) -> MassProperties | None:
    """Return the mass properties of a shape with density 1, in the link frame.

    Returns None, and adds a note, if the shape has no volume or cannot be used.
    """
    geometry = shape.geometry
    if max(map(abs, shape.origin.xyz)) > MAX_COORDINATE:
        notes.append(phrase("a {kind} shape is left out: it is too far away", kind=term(kind)))
        return None
    if isinstance(geometry, Mesh):
        try:
            mesh = meshes.load(geometry, shape.element)
        except LinkwrightError as error:
            notes.append(
                phrase("a {kind} mesh is left out: {reason}", kind=term(kind), reason=error.diagnostics[0].message)
            )
            return None
        solid = mesh.solid
        name = geometry.filename.rpartition("/")[2]
        if not solid.mass > _MIN_VOLUME:
            notes.append(phrase("the {kind} mesh '{name}' is left out: it is flat", kind=term(kind), name=name))
            return None
        if not mesh.is_watertight:
            notes.append(
                phrase(
                    "the {kind} mesh '{name}' is not watertight: its convex hull is used", kind=term(kind), name=name
                )
            )
    else:
        shape_name = type(geometry).__name__.lower()
        if max(shape_bounds(geometry).high) > MAX_COORDINATE:
            notes.append(
                phrase("a {kind} {shape} is left out: it is too large", kind=term(kind), shape=term(shape_name))
            )
            return None
        solid = shape_properties(geometry)
        if not solid.mass > _MIN_VOLUME:
            reason = (
                phrase("its volume is negligible") if solid.mass > 0 else phrase("it has a size that is not positive")
            )
            notes.append(
                phrase("a {kind} {shape} is left out: {reason}", kind=term(kind), shape=term(shape_name), reason=reason)
            )
            return None
    return solid.moved(shape.origin)
