"""Read the worlds and models of an SDF document, and report its errors as findings.

Like libsdformat, the reader continues after an error if it can: it uses the default for a missing or invalid
value. If libsdformat rejects the file at that point, the finding is an error.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from linkwright.diagnostics import Diagnostic, did_you_mean, phrase
from linkwright.schema import ElementRule, reader_of
from linkwright.sdf.old_versions import is_old, upgrade_element
from linkwright.sdf.poses import POSE, SEPARATOR, WORLD
from linkwright.sdf.report import NEWEST_VERSION, SdfReport
from linkwright.sdf.unread import changes_nothing, find_static_links
from linkwright.sdf.worlds import SDF, Sdf
from linkwright.xmltree import Document, Element

_OLD_ROOT_TAG = "gazebo"
"""The tag of the root element in SDF 1.0 to 1.2."""
_FRAME_TAG = "frame"
"""The child element that any element with a pose could have in SDF 1.5 and 1.6."""
_VERSION = re.compile(r"1\.([0-9]{1,2})").fullmatch
_NEWEST_FLAT_MINOR = 7
_NEWEST_LENIENT_MINOR = 6
_MAX_DEPTH = 200
"""The maximum nesting depth of elements."""
_SHARED_NAMESPACE_TAGS = frozenset({"world", "model", "link", "joint", "frame", "light", "actor"})
_SEPARATE_NAMESPACE_TAGS = ("visual", "collision", "sensor", "light")
_OTHER_FORMATS = {
    "robot": phrase("a URDF file"),
    "mujoco": phrase("a MuJoCo model"),
    "gazebo:world": phrase("a world for Gazebo before version 1.0"),
    "COLLADA": phrase("a COLLADA mesh"),
    "launch": phrase("a launch file"),
}

TAGS_WITHOUT_EFFECT = {
    "actor": {"static"},
    "world": {"audio", "gui"},
    "physics": {"bullet", "dart", "dt", "magnetic_field", "ode", "profile", "simbody", "update_rate"},
    "scene": {"cloud", "shadow_caster_material_name", "shadow_caster_render_back_faces"},
    "sky": {"clouds", "cubemap_uri"},
    "model": {"battery", "gripper", "joint", "ros2_control"},
    "link": {
        "acceleration",
        "audio_sink",
        "audio_source",
        "battery",
        "collision",
        "must_be_base_link",
        "particle_emitter",
        "projector",
        "velocity",
        "wrench",
    },
    "collision": {"auto_inertia_params"},
    "inertial": {"auto_inertia_params", "fluid_added_mass"},
    "visual": {"meta"},
    "mesh": {"optimization", "convex_decomposition"},
    "heightmap": {"use_terrain_paging"},
    "camera": {"projection_type", "save", "view_controller"},
    "depth_camera": {"output"},
    "image": {"anti_aliasing"},
    "lens": {"custom_function", "cutoff_angle", "env_texture_size", "projection", "scale_to_hfov", "type"},
    "sensor": {
        "air_flow",
        "dvl",
        "projector",
        "rfid",
        "rfidtag",
        "transceiver",
        "wireless_receiver",
        "wireless_transmitter",
    },
    "imu": {"topic", "noise"},
    "orientation_reference_frame": {"grav_dir_x"},
    "noise": {"rate", "accel"},
    "light": {"visualize"},
    "limit": {"cfm", "erp"},
    "surface": {"soft_contact"},
    "contact": {"bullet", "collide_without_contact_bitmask", "elastic_modulus", "poissons_ratio"},
    "bullet": {"fdir1", "kd", "kp", "soft_cfm", "soft_erp", "split_impulse", "split_impulse_penetration_threshold"},
    "ode": {
        "bounce",
        "cfm",
        "cfm_damping",
        "erp",
        "fudge_factor",
        "implicit_spring_damper",
        "limit",
        "max_force",
        "suspension",
        "velocity",
    },
    "torsional": {"ode"},
    "spherical_coordinates": {"surface_axis_equatorial", "surface_axis_polar"},
    "road": {"material"},
    "metal": {"subsurface"},
}
"""Child elements, by their parent, that Linkwright recognizes but ignores, and those that ros2_control reads itself."""
OPEN_TAGS = frozenset({"plugin", "gui", "state"})
"""Elements with content of other programs, and the state saved by Gazebo."""


@dataclass(frozen=True, slots=True)
class Reading:
    """The parsed content of a document, and the findings.

    Attributes:
        sdf: the content of the document; None if it is not SDF or is nested too deeply.
        diagnostics: all errors and warnings, in the order of the text.
    """

    sdf: Sdf | None
    diagnostics: tuple[Diagnostic, ...]


def read(document: Document) -> Reading:
    """Return the content of an SDF document, with all errors as findings.

    No error is raised.
    """
    report = SdfReport()
    root = document.root
    if root.tag != "sdf" and not (root.tag == _OLD_ROOT_TAG and "version" in root.attributes):
        _explain_root(root, report)
        return Reading(None, report.in_order())
    _check_version(root, report)
    report.is_of_classic = _find_minor_version(root) <= _NEWEST_LENIENT_MINOR
    if is_too_deep(root, report):
        return Reading(None, report.in_order())
    sdf: Sdf = read_element(upgrade_element(root, SDF) if is_old(root) else root, SDF, report)
    if not (sdf.worlds or sdf.models or sdf.lights or sdf.actors or sdf.includes):
        hint = phrase("put a <world> or a <model> into <sdf>")
        report.error("SDF131", phrase("<sdf> contains neither a world nor a model"), root, hint=hint)
    return Reading(sdf, report.in_order())


def read_element(element: Element, rule: ElementRule, report: SdfReport) -> Any:
    """Return the object that an element describes, and report all errors in the element.

    The caller must first check the element with `is_too_deep`.
    """
    content = reader_of(rule, NEWEST_VERSION).read(element, element, report)
    allows_separators = _allows_separators(element)
    known_elements = list(_iterate_known_elements(element, rule))
    static_links = find_static_links(known_element for known_element, _ in known_elements)
    for nested_element, nested_rule in known_elements:
        _check_names(nested_element, report, flat=allows_separators)
        unread_children = [
            child
            for child in nested_element.elements()
            if child.tag not in nested_rule.child_rules and not _is_ignored(child, nested_rule)
        ]
        report.unknown_elements(
            unread_children,
            nested_rule,
            [changes_nothing(child, nested_element, static_links) for child in unread_children],
        )
    return content


def is_too_deep(root: Element, report: SdfReport) -> bool:
    """Return whether elements in `root` are nested too deeply to be read, and report it if so."""
    deep_element = _find_too_deep(root)
    if deep_element is not None:
        message = phrase("elements are nested more than {count} levels deep", count=_MAX_DEPTH)
        report.reject("SDF133", message, deep_element, hint=phrase("is a closing tag missing?"))
    return deep_element is not None


def _explain_root(root: Element, report: SdfReport) -> None:
    if root.tag in _OTHER_FORMATS:
        hint = phrase("this is {format}, not a world or model", format=_OTHER_FORMATS[root.tag])
    elif root.tag in ("world", "model"):
        hint = phrase('enclose the element in <sdf version="1.6">')
    else:
        hint = did_you_mean(root.tag, ["sdf"]) or phrase("an SDF file has <sdf> as its root")
    report.reject("SDF101", phrase("the root element is <{tag}>, not <sdf>", tag=root.tag), root, hint=hint)


def _check_version(root: Element, report: SdfReport) -> None:
    version_text = root.attributes.get("version")
    if version_text is None:
        return  # The reader reports a missing version.
    version_match = _VERSION(version_text.strip())
    if version_match and int(version_match[1]) <= NEWEST_VERSION[1]:
        return
    message = phrase("SDF version '{version}' does not exist", version=version_text)
    hint = phrase("use a version from 1.0 to 1.12; the file is read as 1.12")
    report.warning("SDF102", message, root, "version", hint=hint)


def _find_too_deep(root: Element) -> Element | None:
    """Return a descendant that is nested too deeply, or None if there is none."""
    pending = [(root, 0)]
    while pending:
        element, depth = pending.pop()
        if depth > _MAX_DEPTH:
            return element
        pending.extend((child, depth + 1) for child in element.elements())
    return None


def _iterate_known_elements(root: Element, rule: ElementRule) -> Iterator[tuple[Element, ElementRule]]:
    """Yield an element and its known descendants in document order, each with its rule.

    The elements in `OPEN_TAGS` and their content are left out.
    """
    pending = [(root, rule)]
    while pending:
        element, rule = pending.pop()
        if rule.tag in OPEN_TAGS:
            continue
        yield element, rule
        rules = rule.child_rules
        known_children = [(child, rules[child.tag]) for child in element.elements() if child.tag in rules]
        pending.extend(reversed(known_children))


def _is_ignored(element: Element, rule: ElementRule) -> bool:
    """Return whether an element without a rule is accepted without a finding.

    Such elements have a namespace prefix, or are valid SDF that has no effect here.
    """
    tag = element.tag
    return ":" in tag or tag in TAGS_WITHOUT_EFFECT.get(rule.tag, ()) or (tag == _FRAME_TAG and POSE in rule.children)


def _allows_separators(root: Element) -> bool:
    """Return whether names may contain '::' in the file's SDF version.

    Up to SDF 1.7, the links of an included model became links of the including model, with such names.
    """
    return _find_minor_version(root) <= _NEWEST_FLAT_MINOR


def _find_minor_version(root: Element) -> int:
    """Return the minor number of a file's SDF version, or else the newest one."""
    version_match = _VERSION(root.attributes.get("version", "").strip())
    return NEWEST_VERSION[1] if version_match is None else int(version_match[1])


def _check_names(element: Element, report: SdfReport, *, flat: bool) -> None:
    """Report siblings with the same name, and reserved names.

    Links, joints, frames and models share one namespace. Visuals, collisions, sensors and lights each have their own.
    """
    first_elements: dict[tuple[str, str], Element] = {}
    for child in element.elements():
        name = child.attributes.get("name")
        if name is None or not (child.tag in _SHARED_NAMESPACE_TAGS or child.tag in _SEPARATE_NAMESPACE_TAGS):
            continue
        namespace = child.tag if child.tag in _SEPARATE_NAMESPACE_TAGS else ""
        if not namespace and (
            (SEPARATOR in name and not flat) or name == WORLD or (name.startswith("__") and name.endswith("__"))
        ):
            report.reserved(child, name)
        first_element = first_elements.setdefault((namespace, name), child)
        if first_element is not child:
            report.twice(child, first_element)
