"""Findings on worlds and models in SDF.

Checks that also exist for robots use the same rule, code and message.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from math import isfinite
from pathlib import Path

from linkwright.diagnostics import Diagnostic, Phrase, Severity, phrase
from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.lint.finding import with_related
from linkwright.lint.package import find_package
from linkwright.lint.rules.inertia import NegativeMass, ZeroMass
from linkwright.lint.rules.inertia_tensor import (
    ExcessiveProduct,
    IndefiniteInertia,
    NonPositiveMoment,
    TriangleInequality,
)
from linkwright.lint.tensors import flaw_of
from linkwright.sdf.figures import actor_model
from linkwright.sdf.joints import Axis, Joint
from linkwright.sdf.links import Collision, Inertial, Link, Visual
from linkwright.sdf.mesh_files import shapes_of
from linkwright.sdf.models import Model
from linkwright.sdf.report import described
from linkwright.sdf.resources import Missing, ResourceFinder
from linkwright.sdf.shapes import Cone, Ellipsoid, Heightmap, Mesh
from linkwright.sdf.worlds import Sdf
from linkwright.urdf import model as urdf
from linkwright.xmltree import Element

_FLAWS = {
    rule.kind: rule for rule in (NonPositiveMoment(), ExcessiveProduct(), IndefiniteInertia(), TriangleInequality())
}
_ADDRESSES = ("uri", "filename")
_LEFT_OUT = frozenset({"SDF160", "SDF162"})
"""Findings on models and meshes that are not on this machine; all of them have one fix."""
_RESERVED = "SDF111"
"""A reserved name; a warning where Gazebo classic takes it."""
_PACKAGES_OF_CLASSIC = ("gazebo_ros", "gazebo_ros_pkgs", "gazebo_plugins", "gazebo_dev", "gazebo_ros2_control")
_ZERO_MASS, _NEGATIVE_MASS = ZeroMass(), NegativeMass()


def check_sdf(sdf: Sdf, finder: ResourceFinder) -> Iterator[Diagnostic]:
    """Yield the findings on a file with its includes resolved, once for each location.

    Args:
        sdf: the file.
        finder: the finder of mesh files.
    """
    reported: set[tuple[object, str]] = set()
    models = [*sdf.models, *(model for world in sdf.worlds for model in world.models)]
    found = (diagnostic for model in models for diagnostic in _model(model, static=False))
    actors = [*sdf.actors, *(actor for world in sdf.worlds for actor in world.actors)]
    for finding in (
        *_steps(sdf),
        *found,
        *_axes(models),
        *_missing_meshes([*models, *map(actor_model, actors)], finder),
    ):
        key = (finding.span, str(finding.message))
        if key not in reported:
            reported.add(key)
            yield finding


def merge_missing_resources(found: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Merge the findings on missing models and meshes of a world into one with notes.

    Findings with different codes or severities are not merged. For example, files that Gazebo downloads itself need no
    fix.
    """
    kept: list[Diagnostic] = []
    groups: dict[tuple[str, Severity], list[Diagnostic]] = {}
    for diagnostic in found:
        group = groups.setdefault((diagnostic.code, diagnostic.severity), [])
        if diagnostic.code not in _LEFT_OUT or not group:
            kept.append(diagnostic)
        group.append(diagnostic)
    return [
        with_related(diagnostic, groups[diagnostic.code, diagnostic.severity][1:])
        if diagnostic.code in _LEFT_OUT
        else diagnostic
        for diagnostic in kept
    ]


def adapt_to_classic(found: Iterable[Diagnostic], path: Path) -> Iterator[Diagnostic]:
    """Yield the findings on a world, adapted if its package is for Gazebo classic.

    A warning about a construct that only gz refuses then becomes an information.
    """
    package = find_package(path.absolute().parent)
    manifest = None if package is None else package.manifest
    is_classic = manifest is not None and any(map(manifest.declares, _PACKAGES_OF_CLASSIC))
    for diagnostic in found:
        is_taken = is_classic and diagnostic.code == _RESERVED and diagnostic.severity is Severity.WARNING
        yield diagnostic.with_changes(severity=Severity.INFO) if is_taken else diagnostic


def _steps(sdf: Sdf) -> Iterator[Diagnostic]:
    for world in sdf.worlds:
        for physics in world.physics:
            if not physics.max_step_size > 0 and physics.element is not None:
                place = physics.element.first("max_step_size") or physics.element
                message = phrase("the time step is not positive: {step:g} s", step=physics.max_step_size)
                yield _warning("SDF122", message, place, phrase("0.001 is usual"))


def _model(model: Model, *, static: bool) -> Iterator[Diagnostic]:
    static = static or model.static
    for link in model.links:
        if not static and link.inertial is not None and not link.inertial.auto:
            yield from _inertial(link, link.inertial)
    sizes = [diagnostic for shape in shapes_of(replace(model, models=())) for diagnostic in _size(shape)]
    if sizes:
        yield with_related(sizes[0], sizes[1:])
    for inner in model.models:
        yield from _model(inner, static=static)


def _axes(models: Iterable[Model]) -> Iterator[Diagnostic]:
    """Yield the findings on axes without a direction.

    The findings on fixed joints are merged into one. Gazebo classic writes such axes for all fixed joints, and gz
    refuses them.
    """
    fixed: dict[object, Diagnostic] = {}
    pending = [*models]
    while pending:
        model = pending.pop(0)
        pending += model.models
        for joint, axis, tag in _axes_of(model):
            if axis is None or joint.element is None or any(axis.xyz):
                continue
            place = joint.element.first(tag)
            xyz = place.first("xyz") if place is not None else None
            message = phrase("the axis of {owner} has no direction", owner=described(joint.element))
            found = _warning("SDF122", message, xyz or joint.element, phrase("write its direction, such as 0 0 1"))
            if joint.type == "fixed":
                fixed.setdefault(found.span, found)
            else:
                yield found
    if fixed:
        first, *others = fixed.values()
        yield with_related(first, others)


def _axes_of(model: Model) -> Iterator[tuple[Joint, Axis | None, str]]:
    for joint in model.joints:
        yield joint, joint.axis, "axis"
        yield joint, joint.axis2, "axis2"


def _missing_meshes(models: Iterable[Model], finder: ResourceFinder) -> Iterator[Diagnostic]:
    """Yield a finding for each URI of a missing mesh or heightmap."""
    known: set[str] = set()
    for shape in (shape for model in models for shape in shapes_of(model)):
        geometry, element = shape.geometry, shape.element
        if not isinstance(geometry, Mesh | Heightmap) or element is None or element.source is None:
            continue
        if geometry.uri in known:
            continue
        known.add(geometry.uri)
        found = finder.file(geometry.uri, Path(element.source.name).parent)
        if isinstance(found, Missing):
            message = phrase(
                "'{uri}' of {owner} is left out: {reason}",
                uri=geometry.uri,
                owner=described(element),
                reason=found.reason,
            )
            named = (child for child in element.walk() if child.tag in _ADDRESSES)
            place = next((element for element in named if element.text().strip() == geometry.uri), element)
            yield _warning("SDF162", message, place, found.hint).with_changes(severity=found.severity)


def _inertial(link: Link, inertial: Inertial) -> Iterator[Diagnostic]:
    """Yield the findings of the rules for robots' inertials, and one on non-finite values."""
    tensor = inertial.inertia
    found = urdf.Inertial(
        inertial.mass,
        tensor.ixx,
        tensor.ixy,
        tensor.ixz,
        tensor.iyy,
        tensor.iyz,
        tensor.izz,
        element=inertial.element,
    )
    if not all(map(isfinite, (found.mass, found.ixx, found.ixy, found.ixz, found.iyy, found.iyz, found.izz))):
        message = phrase("the mass or inertia of link '{name}' is not a finite number", name=link.name)
        yield _warning("SDF122", message, inertial.element, phrase("masses are in kg, moments in kg m2"))
        return
    if found.mass <= 0:
        finding = (_NEGATIVE_MASS if found.mass < 0 else _ZERO_MASS).finding(link.name, found)
        yield finding.with_changes(hint=phrase("masses are in kg and positive"))
    flaw = flaw_of(found)
    if flaw is not None and flaw.kind in _FLAWS:
        hint = phrase("a solid box has m (a2 + b2) / 12 about each axis, with a and b its edges across the axis")
        yield _FLAWS[flaw.kind].finding(link.name, found, flaw).with_changes(hint=hint)


def _size(shape: Visual | Collision) -> Iterator[Diagnostic]:
    geometry = shape.geometry
    sizes: tuple[float, ...] = ()
    if isinstance(geometry, Box):
        sizes = geometry.size
    elif isinstance(geometry, Ellipsoid):
        sizes = geometry.radii
    elif isinstance(geometry, Cylinder | Cone | Capsule):
        sizes = (geometry.radius, geometry.length)
    elif isinstance(geometry, Sphere):
        sizes = (geometry.radius,)
    if sizes and not min(sizes) > 0 and shape.element is not None:
        place = shape.element.first("geometry") or shape.element
        message = phrase("a size of {owner} is not positive", owner=described(shape.element))
        yield _warning("SDF122", message, next(place.elements(), place), phrase("sizes are in metres"))


def _warning(code: str, message: Phrase, element: Element | None, hint: Phrase | None) -> Diagnostic:
    span = None if element is None else element.span()
    source = None if element is None else element.source
    return Diagnostic(code, message, span, Severity.WARNING, hint=hint, source=source)
