"""The editable parts of a robot, with values and source positions, and the text of edits."""

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

_CONTEXT_LINES = 1
"""The number of unchanged lines that are shown before and after a change."""


def find_parts(robot: Robot, link_name: str) -> list[EditablePart]:
    """Return the editable parts of a link.

    These are the parent joint and its axis, the visuals, the collisions and the inertial.
    """
    link = robot.links.get(link_name)
    if link is None:
        return []
    return [
        *(part for joint in robot.joints.values() if joint.child == link_name for part in _find_joint_parts(joint)),
        *(_make_shape_part("visual", link_name, index, shape) for index, shape in enumerate(link.visuals)),
        *(_make_shape_part("collision", link_name, index, shape) for index, shape in enumerate(link.collisions)),
        *(_make_inertial_part(link_name, inertial) for inertial in (link.inertial,) if inertial is not None),
    ]


def make_edit_request(message: PreviewEdit) -> EditRequest:
    """Return the edit that a message of a page describes."""
    return EditRequest(message.part, message.name, message.index, message.xyz, message.rpy, message.together)


def make_edited_files(plan: EditPlan) -> list[EditedFile]:
    """Return the files that an edit changes, each as a unified diff without its header."""
    return [EditedFile(path, list(_make_diff(plan.old_texts[path], text))) for path, text in plan.texts.items()]


def _make_diff(before: str, after: str) -> Iterator[str]:
    lines = unified_diff(before.splitlines(), after.splitlines(), lineterm="", n=_CONTEXT_LINES)
    yield from (line for line in lines if not line.startswith(("---", "+++")))


def _find_joint_parts(joint: Joint) -> Iterator[EditablePart]:
    xyz, rpy = _xyz_and_rpy(joint.origin)
    yield EditablePart("joint", joint.name, 0, joint.type, xyz, rpy, *_find_origin_text(joint.element, "origin"))
    if joint.type not in WITHOUT_AXIS:
        yield EditablePart(
            "axis", joint.name, 0, joint.type, list(joint.axis), [], *_find_origin_text(joint.element, "axis")
        )


def _make_shape_part(part: EditedPart, link: str, index: int, shape: Visual | Collision) -> EditablePart:
    geometry = shape.geometry
    title = PurePosixPath(geometry.filename).name if isinstance(geometry, Mesh) else type(geometry).__name__.lower()
    xyz, rpy = _xyz_and_rpy(shape.origin)
    return EditablePart(part, link, index, shape.name or title, xyz, rpy, *_find_origin_text(shape.element, "origin"))


def _make_inertial_part(link: str, inertial: Inertial) -> EditablePart:
    xyz, rpy = _xyz_and_rpy(inertial.origin)
    return EditablePart(
        "inertial", link, 0, f"{inertial.mass:g} kg", xyz, rpy, *_find_origin_text(inertial.element, "origin")
    )


def _xyz_and_rpy(origin: Pose) -> tuple[list[float], list[float]]:
    """Return the position, and roll, pitch and yaw, of a pose.

    The angles are as written in the file where possible.
    """
    rpy = origin.rpy if origin.quaternion is None else rpy_from_quaternion(origin.quaternion)
    return list(origin.xyz), list(rpy)


def _find_origin_text(owner: Element | None, tag: str) -> tuple[str, str, int]:
    """Return ``xyz`` and ``rpy`` of a child element as text, and the element's file and line.

    If the child is missing, the text is empty, and the owner determines file and line. If the position is unknown,
    the file name is empty and the line is 0.
    """
    element = None if owner is None else owner.first(tag)
    located_element = element or owner
    span = None if located_element is None else located_element.span()
    text = ""
    if element is not None and element.source is not None:
        value_ranges = {
            name: attribute_value_range(element.source.text, element.offset, name) for name in ("xyz", "rpy")
        }
        values = {
            name: element.source.text[slice(*value_range)]
            for name, value_range in value_ranges.items()
            if value_range is not None
        }
        text = " ".join(f'{name}="{" ".join(value.split())}"' for name, value in values.items())
    return (text, "", 0) if span is None else (text, span.file, span.line)
