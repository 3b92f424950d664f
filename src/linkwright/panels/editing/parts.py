"""The editable parts of a robot with their values and source positions, and the text of edits."""

from __future__ import annotations

from collections.abc import Iterator
from difflib import unified_diff
from pathlib import PurePosixPath

from linkwright.descriptions.editing import WITHOUT_AXIS, EditPlan, EditRequest
from linkwright.geometry.single import Pose, rpy_from_quaternion
from linkwright.page.protocol.editing import EditablePart, EditedFile, EditedPart, PreviewEdit
from linkwright.urdf import Collision, Inertial, Joint, Mesh, Robot, Visual
from linkwright.xmltree import Element
from linkwright.xmltree.positions import attribute_value_range

_AROUND = 1
"""Lines that are shown before and after a change."""


def parts_of(robot: Robot, link_name: str) -> list[EditablePart]:
    """Return the editable parts of a link: the joint above it, its axis, visuals, collisions and inertial."""
    link = robot.links.get(link_name)
    if link is None:
        return []
    return [
        *(part for joint in robot.joints.values() if joint.child == link_name for part in _of_joint(joint)),
        *(_of_shape("visual", link_name, index, shape) for index, shape in enumerate(link.visuals)),
        *(_of_shape("collision", link_name, index, shape) for index, shape in enumerate(link.collisions)),
        *(_of_inertial(link_name, inertial) for inertial in (link.inertial,) if inertial is not None),
    ]


def request_of(message: PreviewEdit) -> EditRequest:
    """Return the edit that a page's message describes."""
    return EditRequest(message.part, message.name, message.index, message.xyz, message.rpy, message.together)


def files_of(plan: EditPlan) -> list[EditedFile]:
    """Return the files that an edit changes, each as the lines of a unified diff without its header."""
    return [EditedFile(path, list(_diff(plan.before[path], text))) for path, text in plan.texts.items()]


def _diff(before: str, after: str) -> Iterator[str]:
    lines = unified_diff(before.splitlines(), after.splitlines(), lineterm="", n=_AROUND)
    yield from (line for line in lines if not line.startswith(("---", "+++")))


def _of_joint(joint: Joint) -> Iterator[EditablePart]:
    xyz, rpy = _numbers(joint.origin)
    yield EditablePart("joint", joint.name, 0, joint.type, xyz, rpy, *_written(joint.element, "origin"))
    if joint.type not in WITHOUT_AXIS:
        yield EditablePart("axis", joint.name, 0, joint.type, list(joint.axis), [], *_written(joint.element, "axis"))


def _of_shape(part: EditedPart, link: str, index: int, shape: Visual | Collision) -> EditablePart:
    geometry = shape.geometry
    title = PurePosixPath(geometry.filename).name if isinstance(geometry, Mesh) else type(geometry).__name__.lower()
    xyz, rpy = _numbers(shape.origin)
    return EditablePart(part, link, index, shape.name or title, xyz, rpy, *_written(shape.element, "origin"))


def _of_inertial(link: str, inertial: Inertial) -> EditablePart:
    xyz, rpy = _numbers(inertial.origin)
    return EditablePart("inertial", link, 0, f"{inertial.mass:g} kg", xyz, rpy, *_written(inertial.element, "origin"))


def _numbers(origin: Pose) -> tuple[list[float], list[float]]:
    """Return the position and the roll, pitch and yaw of a pose, as written in the file where possible."""
    rpy = origin.rpy if origin.quaternion is None else rpy_from_quaternion(origin.quaternion)
    return list(origin.xyz), list(rpy)


def _written(owner: Element | None, tag: str) -> tuple[str, str, int]:
    """Return the attributes ``xyz`` and ``rpy`` of a child element as text, and its file and line.

    If the child is missing, return an empty text and the owner's file and line; an unknown position is an empty file
    name and line 0.
    """
    element = None if owner is None else owner.first(tag)
    place = element or owner
    span = None if place is None else place.span()
    text = ""
    if element is not None and element.source is not None:
        ranges = {name: attribute_value_range(element.source.text, element.offset, name) for name in ("xyz", "rpy")}
        values = {name: element.source.text[slice(*found)] for name, found in ranges.items() if found is not None}
        text = " ".join(f'{name}="{" ".join(value.split())}"' for name, value in values.items())
    return (text, "", 0) if span is None else (text, span.file, span.line)
