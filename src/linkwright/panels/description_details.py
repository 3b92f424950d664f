"""Details of a description for pages: links, joints, source positions, texts and implausible masses.

This module is imported when the first page requests details.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby, islice
from math import isfinite
from pathlib import Path

import numpy as np

from linkwright.diagnostics import LinkwrightError, SourceText
from linkwright.geometry.single import quaternion_of, rpy_from_quaternion
from linkwright.lint.by_link import inertia_findings
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
from linkwright.rviz.robot import frame_of, link_inertia
from linkwright.urdf import Joint, Link, Mimic, Robot
from linkwright.urdf.plaintext import parse_as_urdfdom
from linkwright.xacro.faults import Frame, frames
from linkwright.xmltree import Element
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.patches import element_range
from linkwright.xmltree.reader import read_bytes

_EXPANDED = ""
_MOST_CALLS = 20


class Places:
    """Looks up the source positions of the links and joints of one description.

    Args:
        text: the expanded description.
    """

    def __init__(self, text: str) -> None:
        self._expanded: dict[tuple[str, str], Element] = {}
        try:
            document, _ = parse_as_urdfdom(text, _EXPANDED)
        except LinkwrightError:
            return  # unexpected, because a robot was read from this text
        for element in document.root.elements():
            key = (element.tag, element.attributes.get("name", ""))
            self._expanded.setdefault(key, element)

    def of(self, tag: str, name: str, element: Element | None) -> Written:
        """Return the positions of a link or joint in the expanded text and in the source files.

        Args:
            tag: ``link`` or ``joint``.
            name: the name of the link or joint.
            element: the element from which it was read; None if that is unknown.
        """
        twin = self._expanded.get((tag, name))
        expanded = None if twin is None else _range(twin)
        if element is None or element.source is None or element.source.name.startswith("<"):
            return Written(expanded, None, [])
        return Written(expanded, _range(element), list(islice(_calls(element), _MOST_CALLS)))


def _calls(element: Element) -> Iterator[CallSite]:
    """Yield the macro calls and includes that produced an element, innermost first, without duplicates."""
    innermost = element.origin
    if not isinstance(innermost, Frame):
        return
    for site, group in groupby(frames(innermost), key=lambda frame: frame.site):
        span = site.span()
        if span is not None:
            yield CallSite(next(group).macro, span.file, span.line, span.column)


def _range(element: Element) -> SourceRange | None:
    """Return the source range of an element, or of its tag name if the end is unknown; or None."""
    found = element_range(element)
    span = element.span() if found is None or element.source is None else element.source.span(*found)
    if span is None:
        return None
    return SourceRange(span.file, span.line, span.column, span.end_line, span.end_column)


def account(robot: Robot, text: str, files: list[str], *, display: str, revision: int, prefix: str) -> Description:
    """Return all details of a robot except its shapes, which pages already have.

    This takes as long as reading the text again.

    Args:
        robot: the robot that was read from the text.
        text: the expanded description.
        files: the files from which the text was made.
        display: the ID of the RobotModel display that shows the robot.
        revision: the number of the description, counted for each display.
        prefix: the display's TF Prefix.
    """
    places = Places(text)
    above = {joint.child: joint.name for joint in robot.joints.values()}
    return Description(
        display=display,
        revision=revision,
        name=robot.name,
        root=robot.root,
        links=[_link(link, above.get(link.name), prefix, places) for link in robot.links.values()],
        joints=[_joint(joint, places) for joint in robot.joints.values()],
        files=files,
    )


def _link(link: Link, parent_joint: str | None, prefix: str, places: Places) -> LinkDetails:
    return LinkDetails(
        name=link.name,
        frame=frame_of(link.name, prefix),
        parent_joint=parent_joint,
        inertia=link_inertia(link.inertial),
        written=places.of("link", link.name, link.element),
    )


def _joint(joint: Joint, places: Places) -> JointDetails:
    limit, dynamics, safety = joint.limit, joint.dynamics, joint.safety
    ranged = limit is not None and joint.type in ("revolute", "prismatic")
    quaternion = quaternion_of(joint.origin)
    return JointDetails(
        name=joint.name,
        kind=joint.type,
        parent=joint.parent,
        child=joint.child,
        xyz=[_finite(part) or 0.0 for part in joint.origin.xyz],
        rpy=[_finite(part) or 0.0 for part in rpy_from_quaternion(quaternion)],
        quaternion=[_finite(part) or 0.0 for part in quaternion],
        axis=_unit(joint.axis),
        lower=_finite(limit.lower) if limit and ranged else None,
        upper=_finite(limit.upper) if limit and ranged else None,
        velocity=_finite(limit.velocity) if limit else None,
        effort=_finite(limit.effort) if limit else None,
        damping=_finite(dynamics.damping) if dynamics else None,
        friction=_finite(dynamics.friction) if dynamics else None,
        soft_lower=_finite(safety.soft_lower_limit) if safety else None,
        soft_upper=_finite(safety.soft_upper_limit) if safety else None,
        k_position=_finite(safety.k_position) if safety else None,
        k_velocity=_finite(safety.k_velocity) if safety else None,
        mimic=_mimic(joint.mimic),
        written=places.of("joint", joint.name, joint.element),
    )


def _mimic(mimic: Mimic | None) -> JointMimic | None:
    if mimic is None:
        return None
    return JointMimic(mimic.joint, _finite(mimic.multiplier) or 0.0, _finite(mimic.offset) or 0.0)


def _finite(number: float) -> float | None:
    return float(number) if isfinite(number) else None


def _unit(axis: tuple[float, float, float]) -> list[float]:
    """Return the axis scaled to length 1, or zeros if its length is 0 or not finite."""
    length = float(np.linalg.norm(axis))
    if not (isfinite(length) and length > 0):
        return [0.0, 0.0, 0.0]
    return [part / length for part in axis]


class SourceTexts:
    """The texts of the files of one description; other files cannot be read through this class.

    The texts that contain elements are in memory, as they were when the description was made. A file that contributed
    only values, such as a YAML file, is read on request.

    Args:
        root: the root element of the description.
        files: the known files from which the description was made, the main one first.
    """

    def __init__(self, root: Element | None, files: Iterable[Path]) -> None:
        self._read = _sources(root)
        self._files: dict[str, Path] = {str(path): path for path in files}

    @property
    def names(self) -> list[str]:
        """The names of the files, the main one first."""
        return list(dict.fromkeys([*self._files, *self._read]))

    def text(self, name: str) -> str | None:
        """Return the text of a file, or None if it cannot be read or does not belong to the description."""
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


def _sources(root: Element | None) -> dict[str, SourceText]:
    """Return the texts that contain the elements, and the calls that produced them, by name."""
    found: dict[str, SourceText] = {}
    known: set[int] = set()
    for element in root.walk() if root is not None else ():
        for source in (element.source, *_sites(element, known)):
            if source is not None and not source.name.startswith("<"):
                found.setdefault(source.name, source)
    return found


def _sites(element: Element, known: set[int]) -> Iterator[SourceText | None]:
    innermost = element.origin
    if not isinstance(innermost, Frame) or id(innermost) in known:
        return
    known.add(id(innermost))
    for frame in frames(innermost):
        yield frame.site.source


def implausible(robot: Robot, finder: PackageFinder) -> list[InertiaFinding]:
    """Return the findings about a robot's masses and inertias, each with the name of its link."""
    return [
        InertiaFinding(link, finding.code, finding.message, finding.hint or "")
        for link, finding in inertia_findings(robot, finder)
    ]
