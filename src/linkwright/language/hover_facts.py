"""Facts about links, joints, meshes and packages, in Markdown, for the hover of an editor."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.diagnostics.translation import localized
from linkwright.inertia.mesh_library import MeshLibrary
from linkwright.language.definitions import NameKind
from linkwright.language.expanded import expand_to_robots, is_source_of
from linkwright.language.links import file_references
from linkwright.language.occurrences import Occurrence
from linkwright.language.renaming import occurrence_at
from linkwright.language.valid_parts import expand_valid_parts
from linkwright.language.values import EvaluatedText
from linkwright.language.workspace import Workspace
from linkwright.packages import PackageFinder
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.urdf import Joint, Link, Mesh, Robot, read
from linkwright.urdf.tree import children_of, parent_joints
from linkwright.xmltree import parse
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.reader import read_bytes

_MESH_SUFFIXES = (".stl", ".obj", ".dae")
_MAX_PARTS = 2
_PACKAGE = re.compile(r"(?:package://|\$\(find(?:-pkg-share)?\s+)([\w.-]+)")


def facts_at(
    workspace: Workspace,
    texts: Mapping[Path, str],
    file: Path,
    text: str,
    offset: int,
    values: Sequence[EvaluatedText],
) -> list[str]:
    """Return the facts about the link, joint, mesh or package at an offset, each as Markdown.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        file: the file of the request.
        text: its text.
        offset: the character offset of the cursor.
        values: the values of the expressions in the file.
    """
    finder = workspace.finder(file)
    line_start, line_end = text.rfind("\n", 0, offset) + 1, text.find("\n", offset)
    for match in _PACKAGE.finditer(text, line_start, len(text) if line_end < 0 else line_end):
        if match.start(1) <= offset <= match.end(1):
            package = describe_package(finder, match[1])
            return [] if package is None else [package]
    for link in file_references(text, file, finder, values):
        if link.start <= offset <= link.end:
            mesh = describe_mesh(link.file)
            if mesh is not None:
                return [mesh]
    part = occurrence_at(text, file, offset)
    return [] if part is None else [*_describe_parts(workspace, texts, part, values)]


def _describe_parts(
    workspace: Workspace, texts: Mapping[Path, str], part: Occurrence, values: Sequence[EvaluatedText]
) -> Iterator[str]:
    """Yield the facts about the links or joints that a name denotes when it is evaluated."""
    if part.kind not in (NameKind.LINK, NameKind.JOINT):
        return
    names = [part.name]
    if "$" in part.name:
        whole_value = next((value for value in values if (value.start, value.end) == (part.start, part.end)), None)
        names = [] if whole_value is None else [name.strip("'\"") for name in whole_value.values()]
    robots = [*robots_of(workspace, texts, part.file)]
    source_robots = [robot for robot in robots if _generates_part(robot, part, workspace.text(part.file, texts) or "")]
    if source_robots or part.is_definition:
        robots = source_robots  # Another file may define a link with this name for another robot.
    for name in names[:_MAX_PARTS]:
        facts = next((facts for robot in robots if (facts := describe_part(robot, part.kind, name))), None)
        if facts is not None:
            yield f"**{part.kind.value} {name}**\n\n{facts}"


def _generates_part(robot: Robot, part: Occurrence, text: str) -> bool:
    """Return whether the element around an occurrence generates a link or joint of a robot."""
    start = max(text.rfind(tag, 0, part.start) for tag in ("<link", "<joint"))
    links, joints = robot.links.values(), robot.joints.values()
    elements = (*(link.element for link in links), *(joint.element for joint in joints))
    return any(is_source_of(part.file, start, element) for element in elements)


def robots_of(workspace: Workspace, texts: Mapping[Path, str], file: Path) -> Iterator[Robot]:
    """Yield the robots of the descriptions that include a file.

    Each valid argument set gives one robot. If no description can be expanded, the robots are those in the valid parts
    of the descriptions and of the file.
    """
    is_found = False
    for _, robot in expand_to_robots(workspace, texts, file):
        is_found = True
        yield robot
    entries = workspace.index.entries(file, texts)
    for entry in () if is_found else dict.fromkeys((*entries, file)):
        parts = expand_valid_parts(workspace, texts, entry)
        partial_robot = None if parts is None else read(parts.document).robot
        if partial_robot is not None:
            yield partial_robot


def describe_part(robot: Robot, kind: NameKind, name: str) -> str | None:
    """Return the facts about a link or joint of a robot, or None if the robot lacks it."""
    if kind is NameKind.LINK and name in robot.links:
        return "\n".join(_describe_link(robot, robot.links[name]))
    if kind is NameKind.JOINT and name in robot.joints:
        return "\n".join(_describe_joint(robot.joints[name]))
    return None


def describe_mesh(file: Path) -> str | None:
    """Return the size, triangle count and file size of a mesh, or None if it is unreadable."""
    if file.suffix.lower() not in _MESH_SUFFIXES:
        return None
    try:
        outline = MeshLibrary(PackageFinder(), file.parent).load_outline(Mesh(str(file)))
        length = file.stat().st_size
    except (LinkwrightError, OSError):
        return None
    size = " × ".join(f"{value:.4g}" for value in outline.bounds.size)
    facts = phrase("{size} m, triangles: {count:,}, bytes: {length:,}", size=size, count=outline.count, length=length)
    return f"`{file.name}`: {localized(facts)}"


def describe_package(finder: PackageFinder, name: str) -> str | None:
    """Return the description and the folder of a package, or None if it is not found."""
    folder = finder.find(name)
    if folder is None:
        return None
    try:
        description = Manifest(parse(decode(read_bytes(folder / MANIFEST), MANIFEST), MANIFEST)).text("description")
    except (LinkwrightError, OSError):
        description = ""
    return f"**{name}**" + (f": {description}" if description else "") + f"\n\n`{folder}`"


def _describe_link(robot: Robot, link: Link) -> Iterator[str]:
    parent = parent_joints(robot).get(link.name)
    if parent is None:
        yield "- " + localized(phrase("root of the link tree"))
    else:
        yield "- " + localized(
            phrase(
                "child of `{parent}`, by the {type} joint `{joint}`",
                parent=parent.parent,
                type=parent.type,
                joint=parent.name,
            )
        )
    children = [joint.child for joint in children_of(robot).get(link.name, ())]
    if children:
        yield "- " + localized(phrase("parent of {children}", children=", ".join(f"`{child}`" for child in children)))
    inertial = link.inertial
    if inertial is not None:
        yield "- " + localized(phrase("mass {mass:g} kg", mass=inertial.mass))
        center = " ".join(f"{value:g}" for value in inertial.origin.xyz)
        moments = ", ".join(f"{name} {getattr(inertial, name):.4g}" for name in ("ixx", "iyy", "izz"))
        yield "- " + localized(phrase("center of mass {center} m; {moments} kg m²", center=center, moments=moments))


def _describe_joint(joint: Joint) -> Iterator[str]:
    yield "- " + localized(
        phrase("{type} joint from `{parent}` to `{child}`", type=joint.type, parent=joint.parent, child=joint.child)
    )
    yield "- " + localized(phrase("origin {origin} m", origin=" ".join(f"{value:.4g}" for value in joint.origin.xyz)))
    if joint.type not in ("fixed", "floating"):
        yield "- " + localized(phrase("axis {axis}", axis=" ".join(f"{value:g}" for value in joint.axis)))
    limit = joint.limit
    if limit is not None and joint.type in ("revolute", "prismatic"):
        unit = "m" if joint.type == "prismatic" else "rad"
        yield "- " + localized(
            phrase("limits {lower:g} to {upper:g} {unit}", lower=limit.lower, upper=limit.upper, unit=unit)
        )
