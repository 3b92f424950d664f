"""Summarize added macros, and added descriptions that cannot be expanded, by the elements that are written in them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping

from linkwright.diagnostics import Phrase, counted, joined, joined_first, phrase
from linkwright.diagnostics.phrase import as_phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.parts.macro_parameters import format_parameter
from linkwright.review.parts.outline import INCLUDE, PROPERTY, Item, MacroOutline, Outline, iterate_items
from linkwright.review.plugins import format_plugins
from linkwright.xmltree import Element

MAX_MACROS = 4
"""The maximum number of added macros of a file that are shown with their contents."""
_MAX_CONTENTS = 20
"""The maximum number of elements of an added macro or file in a line."""
_COMPONENTS: Mapping[str, Callable[[Phrase], Phrase]] = {
    "joint": lambda names: phrase("joints {names}", names=names),
    "sensor": lambda names: phrase("sensors {names}", names=names),
    "gpio": lambda names: phrase("GPIO {names}", names=names),
}
"""The functions that return the title of the parts of hardware, by tag."""
_MAX_DEVICES = 40
"""The maximum number of devices of an element for Webots in a line."""
_MAX_PLUGIN_VALUES = 6
"""The maximum number of values of each sensor and plugin in a line."""


def format_written_contents(outline: Outline) -> Phrase | None:
    """Return the arguments, included files and elements of a file outside of its macros; None if there are none."""
    items = [*format_arguments(outline), *_summarize_elements(outline.root)]
    return joined_first(items, _MAX_CONTENTS) if items else None


def format_added_macro(macro: MacroOutline, *, shows_contents: bool) -> Phrase:
    """Return the line about an added macro, also with its parameters and contents."""
    text = phrase("macro '{name}' added", name=macro.name)
    contents = _summarize_macro(macro) if shows_contents else None
    return text if contents is None else phrase("{change}: {contents}", change=text, contents=contents)


def _summarize_macro(macro: MacroOutline) -> Phrase | None:
    """Return the parameters of a macro, and the included files and the elements in it; None if it has none."""
    items = _summarize_elements(macro.element)
    elements = joined_first(items, _MAX_CONTENTS) if items else None
    if not macro.parameters:
        return elements
    names = joined_first([format_parameter(parameter) for parameter in macro.parameters.values()], MAX_NAMES)
    parameters = phrase("parameters {names}", names=names)
    return parameters if elements is None else phrase("{parts}; makes {items}", parts=parameters, items=elements)


def format_arguments(outline: Outline) -> Iterator[Phrase]:
    """Yield the arguments of a description with their defaults."""
    for name, element in outline.arguments.items():
        default = element.attributes.get("default")
        if default is None:
            yield phrase("argument '{name}'", name=name)
        else:
            yield phrase("argument '{name}' (default {value})", name=name, value=default or "''")


def _summarize_elements(element: Element) -> list[Phrase]:
    """Return the elements in a macro or description, each once. Included files have their names."""
    items: list[Phrase] = []
    for child in iterate_items(element):
        if child.element.tag == INCLUDE:
            items.append(phrase("includes {name}", name=child.element.attributes.get("filename", "")))
        elif child.element.tag != PROPERTY:
            items.append(_summarize_item(child))
    return list({str(item): item for item in items}.values())


def _summarize_item(item: Item) -> Phrase:
    """Return an element of a macro; one for Gazebo with its sensors and plugins."""
    format_parts = _FORMATTERS.get(item.element.tag)
    contents = [] if format_parts is None else list(format_parts(item.element))
    return phrase("{entry} ({items})", entry=item.key, items=joined(contents)) if contents else as_phrase(item.key)


def _format_plugins(element: Element) -> list[Phrase]:
    return format_plugins(element, _MAX_PLUGIN_VALUES)


def _format_devices(element: Element) -> Iterator[Phrase]:
    """Yield the devices of an element for Webots with their topics, and its plugins."""
    devices = []
    for device in element.walk():
        topic = next((child.text().strip() for child in device.walk() if child.tag == "topicName"), "")
        if device.tag == "device":
            name = device.attributes.get("reference", "")
            is_same = not topic or not name or topic.strip("/") == name
            devices.append((topic or name) if is_same else f"{name} ({topic})")
    if devices:
        yield counted(
            "{count} device: {names}",
            "{count} devices: {names}",
            len(devices),
            names=joined_first(devices, _MAX_DEVICES),
        )
    yield from _format_plugins(element)


def _format_joint(element: Element) -> Iterator[Phrase]:
    """Yield the type, axis and limits of a moving joint, as they are written."""
    kind = element.attributes.get("type", "fixed")
    if kind == "fixed":
        return
    yield as_phrase(kind)
    axis, limit, mimic = (_find_attributes(element, tag) for tag in ("axis", "limit", "mimic"))
    if "xyz" in axis:
        yield phrase("axis {value}", value=axis["xyz"])
    if "lower" in limit or "upper" in limit:
        yield phrase("limits {lower} to {upper}", lower=limit.get("lower", "0"), upper=limit.get("upper", "0"))
    if "joint" in mimic:
        yield phrase("mimics {name}", name=mimic["joint"])


def _find_attributes(element: Element, tag: str) -> Mapping[str, str]:
    """Return the attributes of the only descendant with a tag; none if there are several."""
    found = [child.attributes for child in element.walk() if child.tag == tag]
    return found[0] if len(found) == 1 else {}


def _format_hardware(element: Element) -> Iterator[Phrase]:
    """Yield the plugins of an element of ros2_control, and its joints and sensors with their interfaces."""
    plugins = [child.text().strip() for child in element.walk() if child.tag == "plugin"]
    if any(plugins):
        yield phrase("plugin {names}", names=joined_first(list(filter(None, dict.fromkeys(plugins))), MAX_NAMES))
    names: dict[tuple[str, str, str], list[str]] = {}
    for child in element.walk():
        if child.tag in _COMPONENTS and "name" in child.attributes:
            commands, states = (_format_interfaces(child, f"{word}_interface") for word in ("command", "state"))
            names.setdefault((child.tag, commands, states), []).append(child.attributes["name"])
    for (tag, commands, states), of_tag in names.items():
        title = _COMPONENTS[tag](joined_first(of_tag, MAX_NAMES))
        parts = [phrase("commands {names}", names=commands)] if commands else []
        parts += [phrase("states {names}", names=states)] if states else []
        yield phrase("{entry}: {items}", entry=title, items=joined(parts)) if parts else title


def _format_interfaces(element: Element, tag: str) -> str:
    """Return the interfaces of a joint or sensor of ros2_control with their ranges."""
    texts: list[str] = []
    for child in element.walk():
        if child.tag == tag:
            values = {item.attributes.get("name", ""): item.text().strip() for item in child.elements()}
            is_limited = values.get("min") and values.get("max")
            limits = [f"[{values['min']}, {values['max']}]"] if is_limited else []
            texts.append(" ".join([child.attributes.get("name", ""), *limits]))
    return ", ".join(texts)


_FORMATTERS: Mapping[str, Callable[[Element], Iterable[Phrase]]] = {
    "gazebo": _format_plugins,
    "joint": _format_joint,
    "ros2_control": _format_hardware,
    "webots": _format_devices,
}
"""The functions that yield the contents of elements, by tag."""
