"""Details of a description for pages: parts, source positions, texts, implausible masses.

This module is imported when the first page requests details.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby, islice
from math import isfinite
from pathlib import Path

import numpy as np

from linkwright.diagnostics import LinkwrightError, SourceText
from linkwright.geometry.single import pose_quaternion, rpy_from_quaternion
from linkwright.lint.by_link import find_inertia_findings
from linkwright.packages import PackageFinder
from linkwright.page.protocol.description import (
    CallSite,
    Description,
    InertiaFinding,
    JointDetails,
    JointMimic,
    LinkDetails,
    SourceRange,
    Written,
)
from linkwright.rviz.robot import get_frame_name, make_link_inertia
from linkwright.urdf import Joint, Link, Mimic, Robot
from linkwright.urdf.plaintext import parse_as_urdfdom
from linkwright.xacro.faults import Frame, frames
from linkwright.xmltree import Element
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.patches import find_element_range
from linkwright.xmltree.reader import read_bytes

_EXPANDED_NAME = ""
_MAX_CALLS = 20


class SourcePositions:
    """The source positions of the links and joints of one description.

    Args:
        text: the expanded description.
    """

    def __init__(self, text: str) -> None:
        self._expanded_elements: dict[tuple[str, str], Element] = {}
        try:
            document, _ = parse_as_urdfdom(text, _EXPANDED_NAME)
        except LinkwrightError:
            return  # This is not expected, because a robot was read from this text.
        for element in document.root.elements():
            key = (element.tag, element.attributes.get("name", ""))
            self._expanded_elements.setdefault(key, element)

    def find(self, tag: str, name: str, element: Element | None) -> Written:
        """Return the positions of a link or joint in the expanded text and in the source files.

        Args:
            tag: ``link`` or ``joint``.
            name: the name of the link or joint.
            element: the element from which the link or joint was read; None if it is unknown.
        """
        expanded_element = self._expanded_elements.get((tag, name))
        expanded_range = None if expanded_element is None else _find_source_range(expanded_element)
        if element is None or element.source is None or element.source.name.startswith("<"):
            return Written(expanded_range, None, [])
        return Written(expanded_range, _find_source_range(element), list(islice(_iterate_calls(element), _MAX_CALLS)))


def _iterate_calls(element: Element) -> Iterator[CallSite]:
    """Yield the macro calls and includes that produced an element.

    They are in order from the innermost, without duplicates.

    They begin with the innermost, without duplicates.
    """
    innermost = element.origin
    if not isinstance(innermost, Frame):
        return
    for site, group in groupby(frames(innermost), key=lambda frame: frame.site):
        span = site.span()
        if span is not None:
            yield CallSite(next(group).macro, span.file, span.line, span.column)


def _find_source_range(element: Element) -> SourceRange | None:
    """Return the source range of an element, or of its tag name if its end is unknown, or None."""
    offsets = find_element_range(element)
    span = element.span() if offsets is None or element.source is None else element.source.span(*offsets)
    if span is None:
        return None
    return SourceRange(span.file, span.line, span.column, span.end_line, span.end_column)


def describe(robot: Robot, text: str, files: list[str], *, display: str, revision: int, prefix: str) -> Description:
    """Return all details of a robot except its shapes.

    Pages already have the shapes. The text is parsed again. This takes as long as reading the description.

    Args:
        robot: the robot that was read from the text.
        text: the expanded description.
        files: the source files of the text.
        display: the ID of the RobotModel display that shows the robot.
        revision: the number of the description, counted for each display.
        prefix: the display's TF Prefix.
    """
    positions = SourcePositions(text)
    parent_joints = {joint.child: joint.name for joint in robot.joints.values()}
    return Description(
        display=display,
        revision=revision,
        name=robot.name,
        root=robot.root,
        links=[_describe_link(link, parent_joints.get(link.name), prefix, positions) for link in robot.links.values()],
        joints=[_describe_joint(joint, positions) for joint in robot.joints.values()],
        files=files,
    )


def _describe_link(link: Link, parent_joint: str | None, prefix: str, positions: SourcePositions) -> LinkDetails:
    return LinkDetails(
        name=link.name,
        frame=get_frame_name(link.name, prefix),
        parent_joint=parent_joint,
        inertia=make_link_inertia(link.inertial),
        written=positions.find("link", link.name, link.element),
    )


def _describe_joint(joint: Joint, positions: SourcePositions) -> JointDetails:
    limit, dynamics, safety = joint.limit, joint.dynamics, joint.safety
    has_range = limit is not None and joint.type in ("revolute", "prismatic")
    quaternion = pose_quaternion(joint.origin)
    return JointDetails(
        name=joint.name,
        kind=joint.type,
        parent=joint.parent,
        child=joint.child,
        xyz=[_finite_or_none(value) or 0.0 for value in joint.origin.xyz],
        rpy=[_finite_or_none(angle) or 0.0 for angle in rpy_from_quaternion(quaternion)],
        quaternion=[_finite_or_none(component) or 0.0 for component in quaternion],
        axis=_normalize_axis(joint.axis),
        lower=_finite_or_none(limit.lower) if limit and has_range else None,
        upper=_finite_or_none(limit.upper) if limit and has_range else None,
        velocity=_finite_or_none(limit.velocity) if limit else None,
        effort=_finite_or_none(limit.effort) if limit else None,
        damping=_finite_or_none(dynamics.damping) if dynamics else None,
        friction=_finite_or_none(dynamics.friction) if dynamics else None,
        soft_lower=_finite_or_none(safety.soft_lower_limit) if safety else None,
        soft_upper=_finite_or_none(safety.soft_upper_limit) if safety else None,
        k_position=_finite_or_none(safety.k_position) if safety else None,
        k_velocity=_finite_or_none(safety.k_velocity) if safety else None,
        mimic=_describe_mimic(joint.mimic),
        written=positions.find("joint", joint.name, joint.element),
    )


def _describe_mimic(mimic: Mimic | None) -> JointMimic | None:
    if mimic is None:
        return None
    return JointMimic(mimic.joint, _finite_or_none(mimic.multiplier) or 0.0, _finite_or_none(mimic.offset) or 0.0)


def _finite_or_none(number: float) -> float | None:
    return float(number) if isfinite(number) else None


def _normalize_axis(axis: tuple[float, float, float]) -> list[float]:
    """Return the axis scaled to length 1, or zeros if its length is 0 or not finite."""
    length = float(np.linalg.norm(axis))
    if not (isfinite(length) and length > 0):
        return [0.0, 0.0, 0.0]
    return [value / length for value in axis]


class SourceTexts:
    """The texts of the source files of one description.

    Other files cannot be read through this class.

    The texts with elements are stored as they were when the description was read. A file that contributed only values,
    such as a YAML file, is read on request.

    Args:
        root: the root element of the description.
        files: the known source files of the description, beginning with the main file.
    """

    def __init__(self, root: Element | None, files: Iterable[Path]) -> None:
        self._read = _index_sources(root)
        self._files: dict[str, Path] = {str(path): path for path in files}

    @property
    def names(self) -> list[str]:
        """The file names, beginning with the main file."""
        return list(dict.fromkeys([*self._files, *self._read]))

    def text(self, name: str) -> str | None:
        """Return the text of a file, or None.

        None means that the file cannot be read, or does not belong to the description.
        """
        source = self._read.get(name)
        if source is not None:
            return source.text
        path = self._files.get(name)
        if path is None:
            return None
        try:
            return decode(read_bytes(path), name)
        except LinkwrightError:
            return None


def _index_sources(root: Element | None) -> dict[str, SourceText]:
    """Return the source texts of elements and of the calls that produced them, by file name."""
    sources: dict[str, SourceText] = {}
    visited_frames: set[int] = set()
    for element in root.walk() if root is not None else ():
        for source in (element.source, *_iterate_call_sources(element, visited_frames)):
            if source is not None and not source.name.startswith("<"):
                sources.setdefault(source.name, source)
    return sources


def _iterate_call_sources(element: Element, visited_frames: set[int]) -> Iterator[SourceText | None]:
    innermost = element.origin
    if not isinstance(innermost, Frame) or id(innermost) in visited_frames:
        return
    visited_frames.add(id(innermost))
    for frame in frames(innermost):
        yield frame.site.source


def find_implausible_inertias(robot: Robot, finder: PackageFinder) -> list[InertiaFinding]:
    """Return the findings about implausible masses and inertias, with the names of the links."""
    return [
        InertiaFinding(link, finding.code, finding.message, finding.hint or "")
        for link, finding in find_inertia_findings(robot, finder)
    ]
