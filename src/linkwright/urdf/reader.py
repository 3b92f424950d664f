"""Reading a URDF document into a robot, and reporting all its mistakes at once.

It accepts what urdfdom 3.0.1 accepts and, for files of version 1.1 and 1.2, what urdfdom 6.0.0 accepts. Where urdfdom
stops at the first error, it continues.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable

from linkwright.diagnostics import Diagnostic, did_you_mean, joined, phrase
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.loading.lean_patterns import lazy_pattern
from linkwright.loading.lean_typing import TypeVar
from linkwright.schema.rules import Version
from linkwright.urdf.elements import MaterialTable, read_joint, read_link
from linkwright.urdf.model import Joint, Link, Robot
from linkwright.urdf.report import UrdfReport
from linkwright.urdf.schema import NEWEST_VERSION
from linkwright.urdf.tree import find_root
from linkwright.xmltree import Document, Element

_INTEGER = lazy_pattern(r"\s*([+-]?[0-9]+)")
_OTHER_FORMATS = {
    "sdf": phrase("an SDF model"),
    "mujoco": phrase("a MuJoCo model"),
    "launch": phrase("a launch file"),
    "package": phrase("a package.xml"),
    "COLLADA": phrase("a COLLADA mesh"),
}
_OWN_TAGS = frozenset({"link", "joint", "material"})
_FIRST_NAMES = 3

PartT = TypeVar("PartT", Link, Joint)


@dataclass(frozen=True, slots=True)
class Reading:
    """The result of reading a description.

    Attributes:
        robot: the robot, or None when urdfdom would refuse the model. It may be there beside errors: urdfdom, and so
            we, keep a model whose link has a malformed part, and drop that part.
        diagnostics: all errors and warnings, in the order of the text.
    """

    robot: Robot | None
    diagnostics: tuple[Diagnostic, ...]


def read(document: Document) -> Reading:
    """Read a URDF document; it never raises for what the document says."""
    findings = UrdfReport()
    robot = _read_robot(document.root, findings)
    return Reading(None if findings.rejected else robot, findings.in_order())


def _read_robot(root: Element, findings: UrdfReport) -> Robot | None:
    if root.tag != "robot":
        _explain_root(root, findings)
        return None
    name = root.attributes.get("name")
    if name is None:
        findings.reject("URDF103", phrase("<robot> has no 'name'"), root, hint=phrase('add name="..."'))
        name = ""
    findings.version = _read_version(root, findings)

    children: defaultdict[str, list[Element]] = defaultdict(list)
    extensions: list[Element] = []
    for child in root.children:
        if isinstance(child, Element):
            (children[child.tag] if child.tag in _OWN_TAGS else extensions).append(child)

    materials = MaterialTable(findings)
    for element in children["material"]:
        materials.define(element, root)
    links = _by_name("link", [read_link(element, materials, findings) for element in children["link"]], findings)
    materials.report_undefined()
    all_joints = [read_joint(element, findings) for element in children["joint"]]
    joints = _by_name("joint", all_joints, findings)

    if not links:
        _explain_no_links(root, extensions, findings)
        return None
    _report_leftover_xacro(root, extensions, findings)
    root_name = find_root(links, all_joints, findings)
    _check_mimics(joints, findings)
    return Robot(name, root_name, links, joints, materials.known, findings.version, tuple(extensions), root)


def _by_name(kind: str, parts: Iterable[PartT], findings: UrdfReport) -> dict[str, PartT]:
    """Return links or joints by name; of several with one name the first."""
    found: dict[str, PartT] = {}
    for part in parts:
        first = found.setdefault(part.name, part)
        if first is not part:
            assert part.element is not None
            findings.duplicate(kind, part.name, part.element, first.element)
    return found


def _read_version(root: Element, findings: UrdfReport) -> Version:
    written = root.attributes.get("version")
    if written is None:
        return 1, 0
    parts = written.split(".")
    numbers = [int(match[1]) for part in parts if (match := _INTEGER.fullmatch(part))]
    if len(parts) != 2 or len(numbers) != 2 or min(numbers) < 0:
        message = phrase("'version' of <robot> is not of the form x.y: '{written}'", written=written)
        findings.reject("URDF104", message, root, "version", hint=phrase("write 1.0, 1.1 or 1.2, or leave it out"))
        return NEWEST_VERSION
    version = numbers[0], numbers[1]
    if not (1, 0) <= version <= NEWEST_VERSION:
        message = phrase("there is no URDF version '{written}'", written=written)
        findings.reject("URDF104", message, root, "version", hint=phrase("the versions are 1.0, 1.1 and 1.2"))
        return NEWEST_VERSION
    return version


def _explain_root(root: Element, findings: UrdfReport) -> None:
    if root.tag.startswith("xacro:"):
        hint = phrase("a xacro file has <robot> as its root too")
    elif root.tag in _OTHER_FORMATS:
        hint = phrase("this is {format}, not a robot description", format=_OTHER_FORMATS[root.tag])
    else:
        hint = did_you_mean(root.tag, ["robot"]) or phrase("a URDF file has <robot> as its root")
    findings.reject("URDF101", phrase("the root element is <{tag}>, not <robot>", tag=root.tag), root, hint=hint)


def _explain_no_links(root: Element, extensions: list[Element], findings: UrdfReport) -> None:
    text = root.source.text if root.source is not None else ""
    macro = re.search(r"<xacro:macro\s[^>]*?name\s*=\s*[\"']([^\"'\s]+)", text)
    if any(element.tag.startswith("xacro:") for element in extensions):
        hint = phrase("expand the file with xacro first")
    elif any(element.tag == "include" for element in extensions):
        hint = phrase("write <xacro:{tag} ...>", tag="include")
    elif macro:
        hint = phrase(
            "it only defines macros: include it in another file and call one there, <xacro:{macro} .../>",
            macro=macro[1],
        )
    else:
        hint = phrase('add <link name="base_link"/>')
    findings.reject("URDF106", phrase("the robot has no links"), root, hint=hint)


def _report_leftover_xacro(root: Element, extensions: list[Element], findings: UrdfReport) -> None:
    left = [element for element in extensions if element.tag.startswith("xacro:")]
    if not left:
        return
    names = list(dict.fromkeys(f"<{element.tag}>" for element in left))
    shown = joined(names[:_FIRST_NAMES])
    if len(names) > _FIRST_NAMES:
        shown = phrase("{names}, ...", names=shown)
    hint = phrase("expand the file with xacro")
    if "xmlns:xacro" not in root.attributes:
        hint = phrase('expand the file with xacro; <robot> must declare xmlns:xacro="http://www.ros.org/wiki/xacro"')
    findings.warning(
        "URDF102", phrase("xacro did not evaluate {shown}, which URDF readers ignore", shown=shown), left[0], hint=hint
    )


def _check_mimics(joints: dict[str, Joint], findings: UrdfReport) -> None:
    """Report mimic joints without a leader, which urdfdom does not check."""
    for joint in joints.values():
        if joint.mimic is None:
            continue
        assert joint.element is not None
        element = joint.element.first("mimic")
        assert element is not None
        target = joint.mimic.joint
        if target not in joints:
            message = phrase("joint '{name}' mimics '{target}', which does not exist", name=joint.name, target=target)
            findings.warning(
                "URDF180", message, element, "joint", hint=did_you_mean(target, joints.keys() - {joint.name})
            )
            continue
        chain = [joint.name]
        while target in joints and target not in chain:
            chain.append(target)
            mimic = joints[target].mimic
            if mimic is None:
                break
            target = mimic.joint
        else:
            if target == joint.name:
                message = phrase("joint '{name}' mimics itself", name=joint.name)
                if len(chain) > 1:
                    message = phrase("the mimic joints form a cycle: {value}", value=" -> ".join([*chain, target]))
                findings.warning("URDF181", message, element, "joint", hint=phrase("one joint must move by itself"))
