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
from linkwright.lint.tensors import find_first_flaw
from linkwright.sdf.figures import make_actor_model
from linkwright.sdf.joints import Axis, Joint
from linkwright.sdf.links import Collision, Inertial, Link, Visual
from linkwright.sdf.mesh_files import shapes_of
from linkwright.sdf.models import Model
from linkwright.sdf.report import describe_element
from linkwright.sdf.resources import Missing, ResourceFinder
from linkwright.sdf.shapes import Cone, Ellipsoid, Heightmap, Mesh
from linkwright.sdf.worlds import Sdf
from linkwright.urdf import model as urdf
from linkwright.xmltree import Element

_FLAW_RULES = {
    rule.kind: rule for rule in (NonPositiveMoment(), ExcessiveProduct(), IndefiniteInertia(), TriangleInequality())
}
_URI_TAGS = ("uri", "filename")
_MISSING_RESOURCE_CODES = frozenset({"SDF160", "SDF162"})
"""Findings that have a common fix because models and meshes are missing on this machine."""
_RESERVED_NAME_CODE = "SDF111"
"""The finding on a reserved name. It is a warning if Gazebo classic accepts the name."""
_CLASSIC_PACKAGES = ("gazebo_ros", "gazebo_ros_pkgs", "gazebo_plugins", "gazebo_dev", "gazebo_ros2_control")
_ZERO_MASS, _NEGATIVE_MASS = ZeroMass(), NegativeMass()


def check_sdf(sdf: Sdf, finder: ResourceFinder) -> Iterator[Diagnostic]:
    """Yield the findings on a file with its includes resolved, once for each location.

    Args:
        sdf: the file.
        finder: the finder of mesh files.
    """
    reported_keys: set[tuple[object, str]] = set()
    models = [*sdf.models, *(model for world in sdf.worlds for model in world.models)]
    model_findings = (diagnostic for model in models for diagnostic in _model_findings(model, static=False))
    actors = [*sdf.actors, *(actor for world in sdf.worlds for actor in world.actors)]
    for finding in (
        *_step_size_findings(sdf),
        *model_findings,
        *_axis_findings(models),
        *_missing_mesh_findings([*models, *map(make_actor_model, actors)], finder),
    ):
        key = (finding.span, str(finding.message))
        if key not in reported_keys:
            reported_keys.add(key)
            yield finding


def merge_missing_resources(findings: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Merge the findings on missing models and meshes of a world into one with notes.

    Findings with different codes or severities are not merged. For example, files that Gazebo downloads itself need no
    fix.
    """
    merged: list[Diagnostic] = []
    groups: dict[tuple[str, Severity], list[Diagnostic]] = {}
    for diagnostic in findings:
        group = groups.setdefault((diagnostic.code, diagnostic.severity), [])
        if diagnostic.code not in _MISSING_RESOURCE_CODES or not group:
            merged.append(diagnostic)
        group.append(diagnostic)
    return [
        with_related(diagnostic, groups[diagnostic.code, diagnostic.severity][1:])
        if diagnostic.code in _MISSING_RESOURCE_CODES
        else diagnostic
        for diagnostic in merged
    ]


def adapt_to_classic(findings: Iterable[Diagnostic], path: Path) -> Iterator[Diagnostic]:
    """Yield the findings on a world, adapted if its package is for Gazebo classic.

    A warning about a construct that only gz refuses then becomes informational.
    """
    package = find_package(path.absolute().parent)
    manifest = None if package is None else package.manifest
    is_classic = manifest is not None and any(map(manifest.declares, _CLASSIC_PACKAGES))
    for diagnostic in findings:
        is_accepted = is_classic and diagnostic.code == _RESERVED_NAME_CODE and diagnostic.severity is Severity.WARNING
        yield diagnostic.with_changes(severity=Severity.INFO) if is_accepted else diagnostic


def _step_size_findings(sdf: Sdf) -> Iterator[Diagnostic]:
    for world in sdf.worlds:
        for physics in world.physics:
            if not physics.max_step_size > 0 and physics.element is not None:
                element = physics.element.first("max_step_size") or physics.element
                message = phrase("the time step is not positive: {step:g} s", step=physics.max_step_size)
                yield _make_warning("SDF122", message, element, phrase("write a positive time step, such as 0.001"))


def _model_findings(model: Model, *, static: bool) -> Iterator[Diagnostic]:
    static = static or model.static
    for link in model.links:
        if not static and link.inertial is not None and not link.inertial.auto:
            yield from _inertial_findings(link, link.inertial)
    size_findings = [
        diagnostic for shape in shapes_of(replace(model, models=())) for diagnostic in _size_findings(shape)
    ]
    if size_findings:
        yield with_related(size_findings[0], size_findings[1:])
    for nested_model in model.models:
        yield from _model_findings(nested_model, static=static)


def _axis_findings(models: Iterable[Model]) -> Iterator[Diagnostic]:
    """Yield the findings on axes without a direction.

    The findings on fixed joints are merged into one. Gazebo classic writes such axes for all fixed joints, and gz
    refuses them.
    """
    fixed_joint_findings: dict[object, Diagnostic] = {}
    pending = [*models]
    while pending:
        model = pending.pop(0)
        pending += model.models
        for joint, axis, tag in _joint_axes(model):
            if axis is None or joint.element is None or any(axis.xyz):
                continue
            axis_element = joint.element.first(tag)
            xyz = axis_element.first("xyz") if axis_element is not None else None
            message = phrase("the axis of {owner} has no direction", owner=describe_element(joint.element))
            finding = _make_warning(
                "SDF122", message, xyz or joint.element, phrase("write the direction of the axis, such as 0 0 1")
            )
            if joint.type == "fixed":
                fixed_joint_findings.setdefault(finding.span, finding)
            else:
                yield finding
    if fixed_joint_findings:
        first, *others = fixed_joint_findings.values()
        yield with_related(first, others)


def _joint_axes(model: Model) -> Iterator[tuple[Joint, Axis | None, str]]:
    for joint in model.joints:
        yield joint, joint.axis, "axis"
        yield joint, joint.axis2, "axis2"


def _missing_mesh_findings(models: Iterable[Model], finder: ResourceFinder) -> Iterator[Diagnostic]:
    """Yield a finding for each URI of a missing mesh or heightmap."""
    checked_uris: set[str] = set()
    for shape in (shape for model in models for shape in shapes_of(model)):
        geometry, element = shape.geometry, shape.element
        if not isinstance(geometry, Mesh | Heightmap) or element is None or element.source is None:
            continue
        if geometry.uri in checked_uris:
            continue
        checked_uris.add(geometry.uri)
        mesh_file = finder.file(geometry.uri, Path(element.source.name).parent)
        if isinstance(mesh_file, Missing):
            message = phrase(
                "'{uri}' of {owner} is left out: {reason}",
                uri=geometry.uri,
                owner=describe_element(element),
                reason=mesh_file.reason,
            )
            uri_elements = (child for child in element.walk() if child.tag in _URI_TAGS)
            uri_element = next((element for element in uri_elements if element.text().strip() == geometry.uri), element)
            yield _make_warning("SDF162", message, uri_element, mesh_file.hint).with_changes(
                severity=mesh_file.severity
            )


def _inertial_findings(link: Link, inertial: Inertial) -> Iterator[Diagnostic]:
    """Yield the findings on an inertial: those of the rules for robots, and non-finite values."""
    tensor = inertial.inertia
    robot_inertial = urdf.Inertial(
        inertial.mass,
        tensor.ixx,
        tensor.ixy,
        tensor.ixz,
        tensor.iyy,
        tensor.iyz,
        tensor.izz,
        element=inertial.element,
    )
    if not all(
        map(
            isfinite,
            (
                robot_inertial.mass,
                robot_inertial.ixx,
                robot_inertial.ixy,
                robot_inertial.ixz,
                robot_inertial.iyy,
                robot_inertial.iyz,
                robot_inertial.izz,
            ),
        )
    ):
        message = phrase("the mass or inertia of link '{name}' is not a finite number", name=link.name)
        yield _make_warning("SDF122", message, inertial.element, phrase("masses are in kg, moments in kg m2"))
        return
    if robot_inertial.mass <= 0:
        finding = (_NEGATIVE_MASS if robot_inertial.mass < 0 else _ZERO_MASS).finding(link.name, robot_inertial)
        yield finding.with_changes(hint=phrase("give a positive mass in kg"))
    flaw = find_first_flaw(robot_inertial)
    if flaw is not None and flaw.kind in _FLAW_RULES:
        hint = phrase("a solid box has m (a2 + b2) / 12 about each axis, with a and b its edges across the axis")
        yield _FLAW_RULES[flaw.kind].finding(link.name, robot_inertial, flaw).with_changes(hint=hint)


def _size_findings(shape: Visual | Collision) -> Iterator[Diagnostic]:
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
        geometry_element = shape.element.first("geometry") or shape.element
        message = phrase("{owner} has a size that is not positive", owner=describe_element(shape.element))
        yield _make_warning(
            "SDF122", message, next(geometry_element.elements(), geometry_element), phrase("sizes are in meters")
        )


def _make_warning(code: str, message: Phrase, element: Element | None, hint: Phrase | None) -> Diagnostic:
    span = None if element is None else element.span()
    source = None if element is None else element.source
    return Diagnostic(code, message, span, Severity.WARNING, hint=hint, source=source)
