"""The reader that converts a URDF document to a robot, and reports all mistakes together.

The reader accepts what urdfdom 3.0.1 accepts and, for files of version 1.1 and 1.2, what urdfdom 6.0.0 accepts. Where
urdfdom stops at the first error, the reader continues. Links, their materials, and joints are read by urdfdom's rules.

If a joint cannot be read, urdfdom refuses the whole model. If a part of a link cannot be read, urdfdom keeps the
link, but without this part and without the parts after it, in the order inertial, visuals, collisions. Linkwright
does the same, and reports all errors.

If a material is defined several times, the first definition applies. Definitions at robot level take precedence over
definitions in links, even over the color in the visual. A definition in a later link does not apply to an earlier
link.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Mapping
from itertools import dropwhile, takewhile

from linkwright.diagnostics import Diagnostic, Note, Phrase, did_you_mean, joined, phrase
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass, replace
from linkwright.loading.lean_typing import Any, TypeVar
from linkwright.schema.reading import UNREADABLE, reader_of
from linkwright.schema.rules import ElementRule, Version
from linkwright.urdf.model import Joint, Limit, Link, Material, Robot, Visual
from linkwright.urdf.report import BLACK, UrdfReport, describe_owner
from linkwright.urdf.schema import AXIS, COLLISION, INERTIAL, JOINT, LIMIT, LINK, MATERIAL, NEWEST_VERSION, VISUAL
from linkwright.urdf.tree import find_root
from linkwright.urdf.values import degrees_hint, looks_like_degree_limits, looks_like_degrees
from linkwright.xmltree import Document, Element

_BOUNDED_TYPES = ("revolute", "prismatic")
_AXIS_TYPES = ("revolute", "continuous", "prismatic", "planar")
_JOINT_WITHOUT_AXIS = replace(JOINT, children=tuple(child for child in JOINT.children if child is not AXIS))


def read_link(element: Element, materials: MaterialTable, findings: UrdfReport) -> Link:
    """Return a link with its readable parts, and add its materials to the table."""
    name = element.attributes.get("name")
    if name is None:
        findings.missing_attribute(element, LINK, LINK.attributes[0], element)
        return Link("", element=element)
    errors = findings.error_count
    values = reader_of(LINK, findings.version).read(element, element, findings)
    if findings.error_count > errors:
        _drop_unreadable_parts(values, findings)
    values["visuals"] = tuple(_resolve_visual(fields, materials, element) for fields in values["visuals"])
    return Link(**values)


def _drop_unreadable_parts(values: dict[str, Any], findings: UrdfReport) -> None:
    """Remove the first unreadable part and all parts after it, as urdfdom does.

    The first error of the unreadable part gets a note on the removed parts.
    """
    element: Element = values["element"]
    inertial = element.first("inertial")
    first_unreadable: tuple[ElementRule, Element] | None = None
    lost_parts: list[Phrase] = []
    if inertial is not None and values["inertial"] is None:
        first_unreadable = INERTIAL, inertial
        lost_parts.append(phrase("the <inertial>"))
    for rule in (VISUAL, COLLISION):
        parts = values[rule.target]
        readable = tuple(takewhile(lambda part: part is not UNREADABLE, parts)) if first_unreadable is None else ()
        if len(readable) < len(parts):
            first_unreadable = first_unreadable or (rule, list(element.elements(rule.tag))[len(readable)])
            lost_parts.append(phrase("{count} <{tag}>", count=len(parts) - len(readable), tag=rule.tag))
        values[rule.target] = readable
    if first_unreadable is not None:
        note = phrase(
            "urdfdom drops these parts of {owner}: {parts}", owner=describe_owner(element), parts=joined(lost_parts)
        )
        findings.annotate(_find_first_error(*first_unreadable, element, findings.version), Note(note))


def _find_first_error(rule: ElementRule, part: Element, owner: Element, version: Version) -> Diagnostic:
    """Return the error at which urdfdom stops reading a part of a link.

    urdfdom reads the children of a part in the order of the rule.
    """
    for child in rule.children:
        part_report = UrdfReport(version)
        element = part.first(child.tag)
        if element is not None:
            reader_of(child, version).read(element, owner, part_report)
        elif child.required:
            part_report.missing_child(part, rule, child, owner)
        if part_report.error_count:
            return part_report.first_error()
    raise AssertionError("a part that cannot be read has an error")


def _resolve_visual(fields: dict[str, Any], materials: MaterialTable, owner: Element) -> Visual:
    material = fields["material"]
    if material is not None:
        fields["material_name"] = material.name
        fields["material"] = materials.resolve(material, owner)
    return Visual(**fields)


class MaterialTable:
    """The materials defined so far, by name, and the references to undefined materials."""

    __slots__ = ("_findings", "_undefined", "materials")

    def __init__(self, findings: UrdfReport) -> None:
        self.materials: dict[str, Material] = {}
        self._findings = findings
        self._undefined: list[tuple[Material, Element]] = []

    def define(self, element: Element, robot: Element) -> None:
        """Add a material at robot level.

        A material without color and texture is black.
        """
        findings = self._findings
        material = read_material(element, robot, findings) or Material("", element=element)
        if material.rgba is None and material.texture is None:
            color = element.first("color")
            if color is None or "rgba" not in color.attributes:
                findings.error(
                    "URDF162",
                    phrase("material '{name}' has neither a color nor a texture, so it is black", name=material.name),
                    color or element,
                    hint=phrase('add <color rgba="0.8 0.8 0.8 1"/>'),
                )
            material = replace(material, rgba=BLACK)
        if material.name in self.materials:
            findings.duplicate("material", material.name, element, self.materials[material.name].element)
        else:
            self.materials[material.name] = material

    def resolve(self, material: Material, owner: Element) -> Material | None:
        """Return the material that applies to a visual, or None if it is not yet defined.

        A material that the visual defines under a new name is added to the table.
        """
        is_definition = material.rgba is not None or material.texture is not None
        if not material.name:
            return material if is_definition else None
        defined_material = self.materials.get(material.name)
        if defined_material is None:
            if not is_definition:
                self._undefined.append((material, owner))
                return None
            self.materials[material.name] = material
            return material
        return defined_material

    def report_undefined(self) -> None:
        """Report the references to materials without a previous definition."""
        for material, owner in self._undefined:
            element = material.element
            assert element is not None
            color = element.first("color")
            if color is not None and "rgba" in color.attributes:
                continue  # the malformed color of this material is reported already
            later_definition = self.materials.get(material.name)
            if later_definition is not None:
                hint = phrase("a later link defines it: move the definition to robot level")
            else:
                hint = did_you_mean(material.name, self.materials) or phrase("define it at robot level")
            message = phrase(
                "material '{name}' of {owner} is not defined", name=material.name, owner=describe_owner(owner)
            )
            self._findings.warning("URDF160", message, element, "name", hint=hint)


def read_material(element: Element, owner: Element, findings: UrdfReport) -> Material | None:
    """Return a material as written, without resolving references, or None if it has no name."""
    material: Material = reader_of(MATERIAL, findings.version).read(element, owner, findings)
    return None if material is UNREADABLE else material


def read_joint(element: Element, findings: UrdfReport) -> Joint:
    """Return a joint.

    If the joint has errors, they are reported, and the model is marked as refused. As in urdfdom, the axis is 1 0 0
    without ``<axis>``, but 0 0 0 for an ``<axis>`` without 'xyz'.
    """
    errors_before = findings.error_count
    rule = JOINT if element.attributes.get("type") in _AXIS_TYPES else _JOINT_WITHOUT_AXIS
    joint: Joint = reader_of(rule, findings.version).read(element, element, findings)
    if joint.type in _BOUNDED_TYPES:
        _check_bounds(element, joint, findings)
    if findings.error_count > errors_before:
        findings.rejected = True
    return joint


def _check_bounds(joint_element: Element, joint: Joint, findings: UrdfReport) -> None:
    element = joint_element.first("limit")
    if element is None:
        findings.missing_child(joint_element, JOINT, LIMIT, joint_element, joint.type)
    elif joint.limit is not None:
        if findings.version >= (1, 2):
            for name in ("lower", "upper"):
                if name not in element.attributes:
                    message = phrase(
                        "<limit> of {kind} {owner} has no '{name}'",
                        kind=joint.type,
                        owner=describe_owner(joint_element),
                        name=name,
                    )
                    hint = phrase("URDF 1.2 requires both 'lower' and 'upper'")
                    findings.error("URDF120", message, element, hint=hint)
        if joint.type == "revolute":
            _check_angles(element, joint.limit, joint_element, findings)


def _check_angles(element: Element, limit: Limit, owner: Element, findings: UrdfReport) -> None:
    if not looks_like_degree_limits(limit.lower, limit.upper):
        return
    for name, value in (("lower", limit.lower), ("upper", limit.upper)):
        if looks_like_degrees(value):
            message = phrase(
                "'{name}' in <limit> of {owner} looks like degrees: '{value}'",
                name=name,
                owner=describe_owner(owner),
                value=element.attributes[name],
            )
            findings.warning("URDF190", message, element, name, hint=degrees_hint(value))


_INTEGER = lazy_pattern(r"\s*([+-]?[0-9]+)")
_OTHER_FORMATS = {
    "sdf": phrase("an SDF model"),
    "mujoco": phrase("a MuJoCo model"),
    "launch": phrase("a launch file"),
    "package": phrase("a package.xml"),
    "COLLADA": phrase("a COLLADA mesh"),
}
_MODEL_TAGS = frozenset({"link", "joint", "material"})
_MAX_NAMES = 3
_MAX_CYCLE = 8

PartT = TypeVar("PartT", Link, Joint)


@dataclass(frozen=True, slots=True)
class Reading:
    """The result of reading a description.

    Attributes:
        robot: the robot, or None if urdfdom would refuse the model. There may be a robot despite errors: like urdfdom,
            Linkwright keeps a model in which a part of a link is malformed, and drops this part.
        diagnostics: all errors and warnings, in source order.
    """

    robot: Robot | None
    diagnostics: tuple[Diagnostic, ...]


def read(document: Document) -> Reading:
    """Return the robot of a URDF document, and all findings.

    Errors in the content are never raised.
    """
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
            (children[child.tag] if child.tag in _MODEL_TAGS else extensions).append(child)

    materials = MaterialTable(findings)
    for element in children["material"]:
        materials.define(element, root)
    links = _index_by_name("link", [read_link(element, materials, findings) for element in children["link"]], findings)
    materials.report_undefined()
    all_joints = [read_joint(element, findings) for element in children["joint"]]
    joints = _index_by_name("joint", all_joints, findings)

    if not links:
        _explain_no_links(root, extensions, findings)
        return None
    _report_leftover_xacro(root, extensions, findings)
    root_name = find_root(links, all_joints, findings)
    _check_mimics(joints, findings)
    return Robot(name, root_name, links, joints, materials.materials, findings.version, tuple(extensions), root)


def _index_by_name(kind: str, parts: Iterable[PartT], findings: UrdfReport) -> dict[str, PartT]:
    """Return links or joints by name, and report repeated names.

    The first part with a name is returned.
    """
    parts_by_name: dict[str, PartT] = {}
    for part in parts:
        first = parts_by_name.setdefault(part.name, part)
        if first is not part:
            assert part.element is not None
            findings.duplicate(kind, part.name, part.element, first.element)
    return parts_by_name


def _read_version(root: Element, findings: UrdfReport) -> Version:
    version_text = root.attributes.get("version")
    if version_text is None:
        return 1, 0
    parts = version_text.split(".")
    numbers = [int(match[1]) for part in parts if (match := _INTEGER.fullmatch(part))]
    if len(parts) != 2 or len(numbers) != 2 or min(numbers) < 0:
        message = phrase("'version' of <robot> is not of the form x.y: '{version}'", version=version_text)
        findings.reject("URDF104", message, root, "version", hint=phrase("write 1.0, 1.1 or 1.2, or leave it out"))
        return NEWEST_VERSION
    version = numbers[0], numbers[1]
    if not (1, 0) <= version <= NEWEST_VERSION:
        message = phrase("there is no URDF version '{version}'", version=version_text)
        findings.reject("URDF104", message, root, "version", hint=phrase("write 1.0, 1.1 or 1.2"))
        return NEWEST_VERSION
    return version


def _explain_root(root: Element, findings: UrdfReport) -> None:
    if root.tag.startswith("xacro:"):
        hint = phrase("a xacro file also has <robot> as its root")
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
    xacro_elements = [element for element in extensions if element.tag.startswith("xacro:")]
    if not xacro_elements:
        return
    names = list(dict.fromkeys(f"<{element.tag}>" for element in xacro_elements))
    names_text = joined(names[:_MAX_NAMES])
    if len(names) > _MAX_NAMES:
        names_text = phrase("{names}, ...", names=names_text)
    hint = phrase("expand the file with xacro")
    if "xmlns:xacro" not in root.attributes:
        hint = phrase('expand the file with xacro; <robot> must declare xmlns:xacro="http://www.ros.org/wiki/xacro"')
    findings.warning(
        "URDF102",
        phrase("xacro did not evaluate {expressions}, which URDF readers ignore", expressions=names_text),
        xacro_elements[0],
        hint=hint,
    )


def _check_mimics(joints: dict[str, Joint], findings: UrdfReport) -> None:
    """Report mimic joints that follow a missing joint or form a cycle.

    urdfdom does not check this.
    """
    cycles = _find_mimic_cycles(joints)
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
        if joint.name in cycles:
            message = phrase("joint '{name}' mimics itself", name=joint.name)
            if target != joint.name:
                value = " -> ".join((*cycles[joint.name], joint.name))
                message = phrase("the mimic joints form a cycle: {value}", value=value)
            findings.warning("URDF181", message, element, "joint", hint=phrase("remove <mimic> from one of the joints"))


def _find_mimic_cycles(joints: Mapping[str, Joint]) -> dict[str, list[str]]:
    """Return the mimic joints on a cycle, each with the names on the cycle from there on.

    Long lists of names are shortened.
    """
    leaders = {joint.name: joint.mimic.joint for joint in joints.values() if joint.mimic is not None}
    cycles: dict[str, list[str]] = {}
    seen_names: set[str] = set()
    for start in leaders:
        path: dict[str, None] = {}
        name = start
        while name in leaders and name not in seen_names:
            seen_names.add(name)
            path[name] = None
            name = leaders[name]
        if name in path:
            cycle = [*dropwhile(name.__ne__, path)]
            twice, ellipsis = [*cycle, *cycle], ["..."] if len(cycle) > _MAX_CYCLE else []
            shown_count = min(len(cycle), _MAX_CYCLE)
            cycles.update((name, [*twice[k : k + shown_count], *ellipsis]) for k, name in enumerate(cycle))
    return cycles
