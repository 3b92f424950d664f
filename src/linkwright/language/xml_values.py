"""Complete attribute values and element texts in descriptions and worlds."""

from __future__ import annotations

import re
from collections.abc import Generator, Iterable, Iterator, Sequence
from pathlib import Path

from linkwright.diagnostics import phrase
from linkwright.diagnostics.translation import localized
from linkwright.language.completion import Completion, ItemKind, definitions_of_kind, sorted_by_use
from linkwright.language.cursor import Cursor
from linkwright.language.definitions import NameDefinition, NameKind
from linkwright.language.expression_completion import (
    blocks_in_scope,
    complete_expression,
    complete_substitution,
    package_completions,
)
from linkwright.language.extension_schema import (
    HARDWARE_PLUGIN,
    INTERFACE_NAME,
    JOINT_NAME,
    PARAMETER_NAME,
    PART_NAME,
)
from linkwright.language.format import Document
from linkwright.language.hardware_plugins import hardware_parameters, hardware_plugins
from linkwright.language.occurrences import kinds_of_reference, kinds_of_text
from linkwright.language.outline import Outline, OutlineElement
from linkwright.language.robot_names import part_names
from linkwright.language.simulator_plugins import find_plugin, simulator_plugins
from linkwright.lint.extension_names import INTERFACE_NAMES
from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.values import TRUTH
from linkwright.urdf.values import JOINT_TYPE, JOINT_TYPES
from linkwright.xmltree.tokens import Token

_SENSOR_TYPES = (
    *("camera", "depth_camera", "rgbd_camera", "gpu_lidar", "lidar", "imu", "contact", "navsat", "force_torque"),
    *("altimeter", "magnetometer", "air_pressure", "air_speed", "logical_camera"),
    *("segmentation_camera", "boundingbox_camera", "thermal_camera"),
    *("ray", "gpu_ray", "gps", "sonar", "depth", "multicamera", "wireless_receiver", "wireless_transmitter"),
)
_CHOICES: dict[tuple[str, str], tuple[str, ...]] = {
    ("xacro:property", "scope"): ("parent", "global"),
    ("xacro:property", "lazy_eval"): ("false", "true"),
    ("xacro:include", "optional"): ("true", "false"),
    ("sensor", "type"): _SENSOR_TYPES,
    ("physics", "type"): ("ode", "bullet", "dart", "simbody", "ignored"),
    ("noise", "type"): ("gaussian", "gaussian_quantized", "none"),
    ("shader", "type"): ("pixel", "vertex", "normal_map_object_space", "normal_map_tangent_space"),
}
_INTERFACE_PARAMETERS = {
    "initial_value": "the value at the start",
    "min": "the least command",
    "max": "the greatest command",
}
_KINDS_OF_TYPES = {JOINT_NAME: (NameKind.JOINT,), PART_NAME: (NameKind.LINK, NameKind.JOINT)}
_OUTPUT_TYPES = ("sensor_msgs/LaserScan", "sensor_msgs/PointCloud2", "sensor_msgs/PointCloud", "sensor_msgs/Range")
_PATH_ATTRIBUTES = frozenset({"filename", "file", "uri", "url"})
_PATH_TAGS = frozenset({"uri", "parameters", "albedo_map", "normal_map", "roughness_map", "metalness_map", "heightmap"})
_PACKAGE = re.compile(r"^(package|model)://([^/]*)$")
_PATH = re.compile(r"^(?:(?:package|model)://|\$\(find\s+)([^/)]+)\)?/(.*)$")
_IN_EXPRESSION = re.compile(r"^\$\(find\s+\$\{(\w+)\}\)/")
_SUFFIXES = {
    "xacro:include": (".xacro", ".urdf"),
    "mesh": (".stl", ".dae", ".obj"),
    "parameters": (".yaml", ".yml"),
    "texture": (".png", ".jpg"),
}
_MAX_SHOWN_FILES = 200


def complete_value(
    document: Document,
    cursor: Cursor,
    rule: ElementRule | None,
    names: Sequence[NameDefinition],
) -> Iterator[Completion]:
    """Yield the values of an attribute.

    Args:
        document: the text.
        cursor: a cursor in the value.
        rule: the rule of the element, or None.
        names: the names that the files of the description define.
    """
    if cursor.attribute is None or cursor.token is None or (yield from _offer_expressions(document, cursor, names)):
        return
    start, tag, name = cursor.offset - len(cursor.typed), cursor.tags[-1], cursor.attribute.name
    if tag == "plugin" and rule is not None:
        yield from _offer_simulator_plugins(document, cursor, start)
        return
    if (tag, name) == ("xacro:insert_block", "name"):
        for block in blocks_in_scope(cursor):
            yield Completion(block.name.lstrip("*"), ItemKind.NAME, start, "block")
        for name_of_block in definitions_of_kind([name for name in names if not name.detail], NameKind.PROPERTY):
            yield Completion(name_of_block.name, ItemKind.NAME, start, "block", name_of_block.file.name)
        return
    attribute = None if rule is None else rule.attribute_rules.get(name)
    yield from _offer_values(_CHOICES.get((tag, name), ()), start)
    if attribute is not None:
        yield from _offer_values_of_type(document, cursor, attribute, start, names)
    kinds = kinds_of_reference(tag, name)
    if (tag, name) == ("joint", "name") and "ros2_control" in cursor.tags:
        kinds = (NameKind.JOINT,)
    yield from _offer_names(document, cursor, kinds, start, names)
    if name in _PATH_ATTRIBUTES:
        yield from complete_path(document, cursor.typed, cursor.offset, _SUFFIXES.get(tag, ()), names)
    yield from _offer_default(cursor.attribute.value, attribute, start)


def complete_text(
    document: Document,
    cursor: Cursor,
    rule: ElementRule | None,
    names: Sequence[NameDefinition],
) -> Iterator[Completion]:
    """Yield the texts that an element may contain.

    Args:
        document: the text.
        cursor: a cursor in the content of the element.
        rule: the rule of the element, or None.
        names: the names that the files of the description define.
    """
    tag, typed = cursor.tags[-1], cursor.typed.lstrip()
    if "\n" in typed or (yield from _offer_expressions(document, cursor, names)):
        return
    if rule is not None and rule.text is None and tag not in _PATH_TAGS:
        return
    start = cursor.offset - len(typed)
    text = None if rule is None else rule.text
    if tag == "output_type":
        yield from _offer_values(_OUTPUT_TYPES, start)
    if text is not None:
        yield from _offer_values_of_type(document, cursor, text, start, names)
    yield from _offer_names(document, cursor, kinds_of_text(tag), start, names)
    if tag in _PATH_TAGS:
        yield from complete_path(document, typed, cursor.offset, _SUFFIXES.get(tag, ()), names)
    yield from _offer_default(None, text, start)


def _offer_expressions(
    document: Document, cursor: Cursor, names: Sequence[NameDefinition]
) -> Generator[Completion, None, bool]:
    """Yield the completions in an expression or substitution, and return whether there is one."""
    if cursor.is_in_expression:
        yield from complete_expression(document, cursor, names)
        return True
    if cursor.substitution is not None:
        yield from complete_substitution(document, cursor, names)
        return True
    return False


def _offer_values(values: Iterable[str], start: int, detail: str = "") -> Iterator[Completion]:
    for value in values:
        yield Completion(value, ItemKind.VALUE, start, detail)


def _offer_default(value: str | None, rule: AttributeRule | None, start: int) -> Iterator[Completion]:
    """Yield the default of a rule, unless the value equals it or the rule is a boolean."""
    if rule is not None and rule.default and rule.default != value and rule.type is not TRUTH:
        yield Completion(rule.default, ItemKind.VALUE, start, localized(phrase("default")))


# --- values by their type ---------------------------------------------------------------------------------------------


def _offer_values_of_type(
    document: Document,
    cursor: Cursor,
    rule: AttributeRule,
    start: int,
    names: Sequence[NameDefinition],
) -> Iterator[Completion]:
    kind = rule.type
    if kind is JOINT_TYPE:
        yield from _offer_values(JOINT_TYPES, start)
    elif " | " in kind.name:
        yield from _offer_values(kind.name.split(" | "), start)
    elif kind is TRUTH:
        for word in ("true", "false"):
            yield from _offer_values((word,), start, localized(phrase("default")) if word == rule.default else "")
    elif kind is HARDWARE_PLUGIN:
        for name, purpose in hardware_plugins(document).items():
            yield Completion(name, ItemKind.VALUE, start, "", purpose)
    elif kind is INTERFACE_NAME:
        yield from _offer_interfaces(document, cursor, start)
    elif kind is PARAMETER_NAME:
        yield from _offer_parameters(document, cursor, start)
    elif kind in _KINDS_OF_TYPES:
        yield from _offer_names(document, cursor, _KINDS_OF_TYPES[kind], start, names)


def _offer_interfaces(document: Document, cursor: Cursor, start: int) -> Iterator[Completion]:
    """Yield the names of interfaces that the component does not have yet."""
    component = find_element_at(document.text, cursor.elements[:-1])
    tag = cursor.tags[-1]
    others = [] if component is None else [sibling for sibling in component.children if sibling.tag.name == tag]
    present_names = {
        _attribute_value(sibling.tag, "name") for sibling in others if sibling.tag.start != cursor.elements[-1].start
    }
    is_joint = len(cursor.tags) < 2 or cursor.tags[-2] == "joint"
    likely = INTERFACE_NAMES if is_joint else (*_find_names_in_text(document.text, tag), *INTERFACE_NAMES)
    yield from _offer_values((name for name in dict.fromkeys(likely) if name not in present_names), start)


def _find_names_in_text(text: str, tag: str) -> list[str]:
    return re.findall(rf"""<{tag}\s[^<>]{{0,99}}?\bname\s*=\s*["']([\w./-]+)["']""", text)


def _offer_parameters(document: Document, cursor: Cursor, start: int) -> Iterator[Completion]:
    """Yield the parameters of hardware or of an interface."""
    component = find_element_at(document.text, cursor.elements[:-1])
    others = [] if component is None else [child for child in component.children if child.tag.name == "param"]
    present_names = {
        _attribute_value(sibling.tag, "name") for sibling in others if sibling.tag.start != cursor.elements[-1].start
    }
    if cursor.tags[-2:-1] == ("hardware",):
        plugin = find_hardware_plugin(document.text, component)
        for parameter in hardware_parameters(document, plugin, start).values():
            if parameter.name not in present_names:
                yield Completion(parameter.name, ItemKind.ATTRIBUTE, start, plugin, parameter.meaning)
    elif cursor.tags[-2:-1] in (("command_interface",), ("state_interface",)):
        for name, meaning in _INTERFACE_PARAMETERS.items():
            if name not in present_names:
                yield Completion(name, ItemKind.ATTRIBUTE, start, "", meaning)


def find_hardware_plugin(text: str, hardware: OutlineElement | None) -> str:
    """Return the plugin in an element ``<hardware>``, or empty if there is none."""
    plugin = next((child for child in hardware.children if child.tag.name == "plugin"), None) if hardware else None
    return "" if plugin is None else text[plugin.tag.end : plugin.end].partition("<")[0].strip()


def find_element_at(text: str, elements: Sequence[Token]) -> OutlineElement | None:
    """Return the innermost of some nested elements in the outline of a text, or None."""
    children, innermost = Outline.of(text).elements, None
    for element in elements:
        innermost = next((candidate for candidate in children if candidate.tag.start == element.start), None)
        children = [] if innermost is None else innermost.children
    return innermost


def _attribute_value(token: Token, name: str) -> str:
    return next((attribute.value or "" for attribute in token.attributes() if attribute.name == name), "")


# --- names ------------------------------------------------------------------------------------------------------------


def _offer_names(
    document: Document,
    cursor: Cursor,
    kinds: Sequence[NameKind],
    start: int,
    names: Sequence[NameDefinition],
) -> Iterator[Completion]:
    """Yield completions of names of some kinds.

    These are the expanded names and, in a macro, the names as written.
    """
    if not kinds:
        return
    names_of_parts = [name for name in part_names(document) if name.kind in kinds]
    defined_names = [name for kind in kinds for name in sorted_by_use(definitions_of_kind(names, kind), document.text)]
    names_in_file = [name for name in defined_names if name.file == document.file]
    in_macro = cursor.macro is not None
    patterns = [name for name in names_in_file if "$" in name.name]
    literal_names = [name for name in defined_names if "$" not in name.name]
    macro = "" if cursor.macro is None else _attribute_value(cursor.macro, "name")
    names_in_macro = [name for name in names_in_file if name.owner == macro] if in_macro else []
    for name in (*names_in_macro, *(patterns if in_macro else ()), *names_of_parts, *literal_names):
        if name.start != start or name.file != document.file:
            yield Completion(name.name, ItemKind.NAME, start, name.detail or name.kind.value, name.file.name)


def _offer_simulator_plugins(document: Document, cursor: Cursor, start: int) -> Iterator[Completion]:
    """Yield the libraries or names of plugins, the plugins for the file's simulator first."""
    assert cursor.attribute is not None
    token, name = cursor.elements[-1], cursor.attribute.name
    library, class_name = _attribute_value(token, "filename"), _attribute_value(token, "name")
    is_classic = ".so" in document.text and "gz-sim" not in document.text and "ignition-gazebo" not in document.text
    plugins = sorted(simulator_plugins().values(), key=lambda plugin: plugin.is_classic != is_classic)
    if name == "filename":
        plugin_of_class = find_plugin("", class_name)
        for plugin in ([] if plugin_of_class is None else [plugin_of_class]) + plugins:
            spelled = _spelled_name(plugin.filename, cursor.typed)
            yield Completion(spelled, ItemKind.VALUE, start, plugin.class_name, plugin.purpose)
    elif name == "name":
        known_plugin = find_plugin(library)
        if known_plugin is not None and known_plugin.class_name:
            yield Completion(
                _spelled_name(known_plugin.class_name, cursor.typed),
                ItemKind.VALUE,
                start,
                library,
                known_plugin.purpose,
            )
        elif known_plugin is not None:
            yield Completion(
                known_plugin.library.removeprefix("gazebo_ros_"), ItemKind.VALUE, start, library, known_plugin.purpose
            )
        for plugin in plugins:
            if plugin.class_name and (known_plugin is None or not known_plugin.is_classic):
                yield Completion(
                    _spelled_name(plugin.class_name, cursor.typed),
                    ItemKind.VALUE,
                    start,
                    plugin.filename,
                    plugin.purpose,
                )


def _spelled_name(name: str, typed: str) -> str:
    """Return the name of a plugin, with an old prefix such as ``ignition-gazebo-`` if typed."""
    if typed.startswith(("ign", "libign")):
        prefix = "lib" if typed.startswith("lib") else ""
        return prefix + name.replace("gz-sim-", "ignition-gazebo-").replace("gz::sim::", "ignition::gazebo::")
    return f"lib{name}" if typed.startswith("libgz") and name.startswith("gz-sim-") else name


# --- paths ------------------------------------------------------------------------------------------------------------


def complete_path(
    document: Document, typed: str, offset: int, endings: Sequence[str], names: Sequence[NameDefinition] = ()
) -> Iterator[Completion]:
    """Yield packages, folders and files that continue a path.

    Args:
        document: the text.
        typed: the typed part of the path.
        offset: the offset of the cursor.
        endings: the suffixes of the expected files, which come first.
        names: the names that the files of the description define.
    """
    package = _PACKAGE.match(typed)
    if package is not None:
        yield from package_completions(document, offset - len(package[2]))
        return
    computed = _IN_EXPRESSION.match(typed)
    if computed is not None:
        value = next(
            (
                definition.detail
                for definition in definitions_of_kind(names, NameKind.PROPERTY)
                if definition.name == computed[1]
            ),
            "",
        )
        typed = f"package://{value}/{typed[computed.end() :]}"
    uri_match = _PATH.match(typed)
    base, subpath = (document.finder.find(uri_match[1]), uri_match[2]) if uri_match else (document.file.parent, typed)
    if uri_match is None:
        for beginning in ("package://", "$(find "):
            if beginning.startswith(typed):
                yield Completion(beginning, ItemKind.VALUE, offset - len(typed))
    if base is not None and "$" not in subpath:
        yield from _offer_files(base, subpath, offset, endings, document.file)


def _offer_files(base: Path, typed: str, offset: int, endings: Sequence[str], own_file: Path) -> Iterator[Completion]:
    subfolder, _, name = typed.rpartition("/")
    try:
        entries = [(entry.is_file(), entry.name) for entry in (base / subfolder).iterdir() if entry != own_file]
    except (OSError, ValueError):
        return

    def rank(entry: tuple[bool, str]) -> tuple[int, bool, str]:
        is_file, file_name = entry
        fits = file_name.lower().endswith(tuple(endings))
        return (0 if fits or not is_file else 1) if endings else 0, is_file, file_name

    for is_file, file_name in sorted(entries, key=rank)[:_MAX_SHOWN_FILES]:
        if not file_name.startswith("."):
            yield Completion(file_name, ItemKind.FILE if is_file else ItemKind.FOLDER, offset - len(name))
