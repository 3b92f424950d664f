"""Reads an SDF document into worlds and models, and reports all of its errors as findings.

Like libsdformat, the reader continues after an error if it can: a missing value has its default, and an invalid value
counts as missing. If libsdformat rejects the file at that point, the finding is an error.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from linkwright.diagnostics import Diagnostic, did_you_mean, phrase
from linkwright.schema import ElementRule, reader_of
from linkwright.sdf.old_versions import is_old, upgraded
from linkwright.sdf.poses import POSE, SEPARATOR, WORLD
from linkwright.sdf.report import NEWEST, SdfReport
from linkwright.sdf.unread import changes_nothing, links_of_static_models
from linkwright.sdf.worlds import SDF, Sdf
from linkwright.xmltree import Document, Element

_OLD_ROOT = "gazebo"
"""The root of SDF 1.0 to 1.2."""
_FRAME = "frame"
"""The frame that everything with a pose could have in SDF 1.5 and 1.6."""
_VERSION = re.compile(r"1\.([0-9]{1,2})").fullmatch
_NEWEST_FLAT_MINOR = 7
_NEWEST_LENIENT_MINOR = 6
_DEEPEST = 200
"""Elements in elements; a model of ten models in each other has twenty."""
_NAMED = frozenset({"world", "model", "link", "joint", "frame", "light", "actor"})
_SIBLINGS = ("visual", "collision", "sensor", "light")
_OTHER_FORMATS = {
    "robot": phrase("a URDF file"),
    "mujoco": phrase("a MuJoCo model"),
    "gazebo:world": phrase("a world of Gazebo before 1.0"),
    "COLLADA": phrase("a COLLADA mesh"),
    "launch": phrase("a launch file"),
}

WITHOUT_EFFECT = {
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
        "air_speed",
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
"""Words of SDF that have no effect here, by the elements around them, and elements that ros2_control reads itself."""
OPEN = frozenset({"plugin", "gui", "state"})
"""Elements whose content other programs define, and the state that Gazebo saved."""


@dataclass(frozen=True, slots=True)
class Reading:
    """The parsed content of a document, and the findings.

    Attributes:
        sdf: the parsed document; None if it is not SDF.
        diagnostics: all errors and warnings, in the order of the text.
    """

    sdf: Sdf | None
    diagnostics: tuple[Diagnostic, ...]


def read(document: Document) -> Reading:
    """Read an SDF document; errors in its content are reported as findings and never raised."""
    report = SdfReport()
    root = document.root
    if root.tag != "sdf" and not (root.tag == _OLD_ROOT and "version" in root.attributes):
        _explain_root(root, report)
        return Reading(None, report.in_order())
    _check_version(root, report)
    report.is_of_classic = _minor(root) <= _NEWEST_LENIENT_MINOR
    if is_too_deep(root, report):
        return Reading(None, report.in_order())
    sdf: Sdf = read_element(upgraded(root, SDF) if is_old(root) else root, SDF, report)
    if not (sdf.worlds or sdf.models or sdf.lights or sdf.actors):
        hint = phrase("put a <world> or a <model> in it")
        report.error("SDF131", phrase("<sdf> has neither a world nor a model in it"), root, hint=hint)
    return Reading(sdf, report.in_order())


def read_element(element: Element, rule: ElementRule, report: SdfReport) -> Any:
    """Read an element, and report all mistakes in it.

    Check the element with `is_too_deep` first.
    """
    found = reader_of(rule, NEWEST).read(element, element, report)
    flat = _allows_separators(element)
    known = list(_known(element, rule))
    static_links = links_of_static_models(each for each, _ in known)
    for each, each_rule in known:
        _check_names(each, report, flat=flat)
        unread = [
            child
            for child in each.elements()
            if child.tag not in each_rule.child_rules and not _is_ignored(child, each_rule)
        ]
        report.unknown_elements(unread, each_rule, [changes_nothing(child, each, static_links) for child in unread])
    return found


def is_too_deep(root: Element, report: SdfReport) -> bool:
    """Return whether an element is nested too deeply to be read, and report it if so."""
    deep = _too_deep(root)
    if deep is not None:
        message = phrase("elements are nested more than {count} deep", count=_DEEPEST)
        report.reject("SDF133", message, deep, hint=phrase("is a closing tag missing?"))
    return deep is not None


def _explain_root(root: Element, report: SdfReport) -> None:
    if root.tag in _OTHER_FORMATS:
        hint = phrase("this is {format}, not a world or model", format=_OTHER_FORMATS[root.tag])
    elif root.tag in ("world", "model"):
        hint = phrase('put <sdf version="1.6"> around it')
    else:
        hint = did_you_mean(root.tag, ["sdf"]) or phrase("an SDF file has <sdf> as its root")
    report.reject("SDF101", phrase("the root element is <{tag}>, not <sdf>", tag=root.tag), root, hint=hint)


def _check_version(root: Element, report: SdfReport) -> None:
    written = root.attributes.get("version")
    if written is None:
        return  # The reader reports a missing version.
    found = _VERSION(written.strip())
    if found and int(found[1]) <= NEWEST[1]:
        return
    message = phrase("SDF version '{written}' is not known", written=written)
    hint = phrase("the versions are 1.0 to 1.12; the file is read as 1.12")
    report.warning("SDF102", message, root, "version", hint=hint)


def _too_deep(root: Element) -> Element | None:
    """Return an element that is nested too deeply, or None if there is none."""
    waiting = [(root, 0)]
    while waiting:
        element, depth = waiting.pop()
        if depth > _DEEPEST:
            return element
        waiting.extend((child, depth + 1) for child in element.elements())
    return None


def _known(root: Element, rule: ElementRule) -> Iterator[tuple[Element, ElementRule]]:
    """Yield an element and its known descendants in document order, each with its rule.

    Elements whose content other programs define are left out.
    """
    waiting = [(root, rule)]
    while waiting:
        element, rule = waiting.pop()
        if rule.tag in OPEN:
            continue
        yield element, rule
        rules = rule.child_rules
        inner = [(child, rules[child.tag]) for child in element.elements() if child.tag in rules]
        waiting.extend(reversed(inner))


def _is_ignored(element: Element, rule: ElementRule) -> bool:
    """Return whether an unknown element is not reported.

    This applies to an element with a prefix, and to an SDF element that has no effect here.
    """
    tag = element.tag
    return ":" in tag or tag in WITHOUT_EFFECT.get(rule.tag, ()) or (tag == _FRAME and POSE in rule.children)


def _allows_separators(root: Element) -> bool:
    """Return whether names may contain '::' in the file's version.

    Up to SDF 1.7, the parts of an included model became parts of the including model, with such names.
    """
    return _minor(root) <= _NEWEST_FLAT_MINOR


def _minor(root: Element) -> int:
    """Return the minor number of a file's SDF version; the newest minor number for an invalid version."""
    found = _VERSION(root.attributes.get("version", "").strip())
    return NEWEST[1] if found is None else int(found[1])


def _check_names(element: Element, report: SdfReport, *, flat: bool) -> None:
    """Report siblings with the same name, and reserved names.

    Links, joints, frames and models share one namespace. Visuals, collisions, sensors and lights each have their own.
    """
    first: dict[tuple[str, str], Element] = {}
    for child in element.elements():
        name = child.attributes.get("name")
        if name is None or not (child.tag in _NAMED or child.tag in _SIBLINGS):
            continue
        space = child.tag if child.tag in _SIBLINGS else ""
        if not space and (
            (SEPARATOR in name and not flat) or name == WORLD or (name.startswith("__") and name.endswith("__"))
        ):
            report.reserved(child, name)
        before = first.setdefault((space, name), child)
        if before is not child:
            report.twice(child, before)
