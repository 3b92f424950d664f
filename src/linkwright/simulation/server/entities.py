"""Read models that programs send as URDF or SDF."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from linkwright.descriptions import DescriptionLibrary
from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, has_errors, joined, phrase
from linkwright.sdf.from_urdf import model_from_robot
from linkwright.sdf.includes import resolve_includes
from linkwright.sdf.models import Model
from linkwright.sdf.reader import read
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.shapes import GEOMETRY
from linkwright.sdf.text import parse_as_gazebo
from linkwright.urdf import Robot
from linkwright.xmltree import Element

_SOURCE_NAME = "<the description>"
_SHAPE_PARENTS = ("visual", "collision")


@dataclass(frozen=True, slots=True)
class Entity:
    """A model that was read from URDF or SDF.

    Attributes:
        model: the model, with its includes resolved; links of a URDF robot are not lumped.
        diagnostics: the findings on the description.
        missing_shape_errors: the errors about elements of SDF in ``<geometry>`` that are not shapes.
    """

    model: Model
    diagnostics: tuple[Diagnostic, ...]
    missing_shape_errors: tuple[Diagnostic, ...] = ()


def read_entity(text: str, finder: ResourceFinder, library: DescriptionLibrary) -> Entity:
    """Read a model from URDF or SDF.

    Args:
        text: the URDF or SDF; only the first model of SDF is read, which may be an ``<include>`` directly in ``<sdf>``.
        finder: finds the included files.
        library: the robot descriptions that the process has read.

    Raises:
        LinkwrightError: the text is not XML, or is neither URDF nor SDF; SIM142, the text does not contain a model;
            other errors of the text.
    """
    document, warnings = parse_as_gazebo(text, _SOURCE_NAME)
    if document.root.tag == "robot":
        reading = library.read(text)
        if reading.robot is None or not reading.robot.links:
            raise LinkwrightError(*_select_errors(reading.diagnostics))
        converted = model_from_robot(reading.robot, lump_fixed_joints=False)
        shape_errors = _select_errors(reading.diagnostics) if _lacks_shapes(reading.robot) else ()
        return Entity(converted.model, (*shape_errors, *converted.diagnostics))
    sdf = read(document)
    if sdf.sdf is None:
        raise LinkwrightError(*_select_errors(sdf.diagnostics))
    resolved = resolve_includes(sdf.sdf, Path.cwd() / _SOURCE_NAME, finder)
    findings = (*warnings, *sdf.diagnostics, *resolved.diagnostics)
    if not resolved.sdf.models:
        if has_errors(findings) or resolved.sdf.includes:
            raise LinkwrightError(*_select_errors(findings))
        message = phrase("the description contains no model")
        hint = (
            phrase("send URDF, or SDF with a <model>")
            if not sdf.sdf.worlds
            else phrase("send one of the models of the world: only models can be added")
        )
        raise LinkwrightError(Diagnostic("SIM142", message, hint=hint))
    return Entity(resolved.sdf.models[0], findings, tuple(_find_invalid_shapes(document.root)))


def _lacks_shapes(robot: Robot) -> bool:
    """Return whether a visual or collision of a robot could not be read.

    Gazebo spawns such a robot without it, because urdfdom drops it.
    """
    return any(
        len(link.visuals) + len(link.collisions)
        < sum(element.tag in _SHAPE_PARENTS for element in link.element.elements())
        for link in robot.links.values()
        if link.element is not None
    )


def _find_invalid_shapes(root: Element) -> Iterator[Diagnostic]:
    """Yield an error for each element in ``<geometry>`` that is not a shape of SDF."""
    for parent in root.walk():
        for geometry in parent.elements("geometry") if parent.tag in _SHAPE_PARENTS else ():
            for shape in geometry.elements():
                if shape.tag not in GEOMETRY.child_rules and ":" not in shape.tag:
                    owner_name = parent.attributes.get("name", "")
                    message = phrase(
                        "the <geometry> of {kind} '{name}' contains <{tag}>, which is not a shape",
                        tag=shape.tag,
                        kind=foreign(parent.tag),
                        name=owner_name,
                    )
                    hint = phrase("the shapes are {names}", names=joined(sorted(GEOMETRY.child_rules)))
                    yield Diagnostic("SIM145", message, shape.span(), hint=hint, source=shape.source)


def _select_errors(findings: tuple[Diagnostic, ...] | list[Diagnostic]) -> list[Diagnostic]:
    """Return the findings that are errors, or all findings if none is an error.

    If there are no findings at all, the error SIM142 is returned.
    """
    return (
        [finding for finding in findings if has_errors([finding])]
        or list(findings)
        or [Diagnostic("SIM142", phrase("the description contains no model"))]
    )
