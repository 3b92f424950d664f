"""RViz configurations: displays, tools and views with their properties, frames, and topics."""

from __future__ import annotations

import re
from collections.abc import Iterator
from inspect import cleandoc
from pathlib import Path

from linkwright.diagnostics import phrase
from linkwright.diagnostics.translation import localized
from linkwright.language.completion import Completion, ItemKind
from linkwright.language.definitions import NameKind
from linkwright.language.format import Document, Format, Target
from linkwright.language.hover import Explanation
from linkwright.language.parameter_files import explain_part, target_of, word_at
from linkwright.language.robot_names import robot_names
from linkwright.language.rviz_owners import (
    DISPLAY_ENTRY_POINTS,
    OPTIONS,
    PANEL_NAMES,
    ConfigOwner,
    display_class,
    display_schema,
    load_displays,
    owner_of,
)
from linkwright.language.yaml_outline import YamlCursor, YamlOutline, YamlPosition
from linkwright.language.yaml_symbols import has_colon, snippet_text, sort_by_match, yaml_symbols
from linkwright.loading.extensions import extensions
from linkwright.rviz.config.former_names import to_modern_class
from linkwright.rviz.config.schema import FIXED_FRAME, PropertySpec, value_to_text
from linkwright.rviz.config.tools import TOOL_KINDS
from linkwright.rviz.config.views import ORBIT, VIEW_SCHEMAS

_COMMON_DISPLAYS = (
    "RobotModel",
    "TF",
    "LaserScan",
    "Map",
    "PointCloud2",
    "Image",
    "Path",
    "Odometry",
    "MarkerArray",
    "Grid",
)
"""The displays that most configurations have, offered first."""
_USUAL_FRAMES = ("map", "odom", "world")
_USUAL_TOPICS = {
    "nav_msgs/msg/OccupancyGrid": "/map",
    "nav_msgs/msg/Odometry": "/odom",
    "nav_msgs/msg/Path": "/plan",
    "sensor_msgs/msg/Image": "/camera/image_raw",
    "sensor_msgs/msg/LaserScan": "/scan",
    "sensor_msgs/msg/PointCloud2": "/points",
    "std_msgs/msg/String": "/robot_description",
    "visualization_msgs/msg/MarkerArray": "/visualization_marker_array",
}
"""The usual topic of some message types."""
_TOPIC = re.compile(r"(?m)^[ \t]{0,99}(?:Value|Topic|[\w ]{0,60}Topic): (/[\w/]+)[ \t\r]{0,20}$")


# --- completions ------------------------------------------------------------------------------------------------------


def complete_rviz(document: Document, offset: int) -> list[Completion]:
    """Return the completions at an offset of a configuration, the most likely first."""
    cursor = YamlOutline(document.text).cursor(offset)
    if cursor.position is YamlPosition.NOTHING:
        return []
    items = _offer_keys(document, cursor) if cursor.position is YamlPosition.KEY else _offer_values(document, cursor)
    return sort_by_match(items, cursor.typed)


def _offer_keys(document: Document, cursor: YamlCursor) -> Iterator[Completion]:
    owner = owner_of(cursor.parent_entry)
    present = {child.key for child in cursor.parent_entry.children if child is not cursor.entry}
    has_value = has_colon(document.text, cursor.offset)
    specs = owner.schema
    own_spec = ConfigOwner(owner.role, owner.entry, owner.keys[:-1]).spec(owner.keys[-1]) if owner.keys else None
    if own_spec is not None and own_spec.children and own_spec.kind != "group":
        specs = (PropertySpec("Value", own_spec.kind, own_spec.default, own_spec.description, own_spec.options), *specs)
    for spec in specs:
        if spec.name not in present and not spec.read_only:
            yield _make_property_completion(spec, cursor.start, has_value=has_value)
    if owner.keys[-1:] in (("Links",), ("Frames",)):
        for name in robot_names(document):
            if name.kind is NameKind.LINK and name.name not in present:
                snippet = "" if has_value else f"{snippet_text(name.name)}:\n  $0"
                yield Completion(name.name, ItemKind.NAME, cursor.start, name.file.name, "", snippet)


def _make_property_completion(spec: PropertySpec, start: int, *, has_value: bool) -> Completion:
    default = _default_text(spec)
    detail = f"{spec.kind} = {default}" if default else spec.kind
    value = f": ${{1:{snippet_text(default)}}}" if default else ": $0"
    if spec.kind == "group":
        value = ":\n  $0"
    elif spec.children:
        value = f":\n  Value: ${{1:{snippet_text(default)}}}" if default else ":\n  Value: $0"
    snippet = "" if has_value else spec.name + value
    return Completion(spec.name, ItemKind.ATTRIBUTE, start, detail, _describe_property(spec), snippet)


def _default_text(spec: PropertySpec) -> str:
    return "" if spec.default is None or spec.default == "" else value_to_text(spec, spec.default)


def _describe_property(spec: PropertySpec) -> str:
    default = _default_text(spec)
    lines = [f"**{spec.name}** `{spec.kind}`" + (f" = `{default}`" if default else "")]
    if spec.description:
        lines.append(str(localized(spec.description)))
    if spec.options:
        choices = ", ".join(f"`{option}`" for option in spec.options)
        lines.append(localized(phrase("one of {choices}", choices=choices)))
    if spec.minimum is not None or spec.maximum is not None:
        low = "" if spec.minimum is None else f"{spec.minimum:g}"
        high = "" if spec.maximum is None else f"{spec.maximum:g}"
        lines.append(f"`{low} … {high}`")
    return "\n\n".join(lines)


def _offer_values(document: Document, cursor: YamlCursor) -> Iterator[Completion]:
    parent = cursor.parent_entry.parent
    if parent is None:
        return
    owner, key = owner_of(parent), cursor.parent_entry.key
    if key == "Class":
        for name, purpose in _list_classes(owner):
            yield Completion(name, ItemKind.VALUE, cursor.start, "", purpose)
        return
    if key == "Name":
        yield Completion(_default_name(owner), ItemKind.VALUE, cursor.start)
    spec = owner.spec(key)
    if spec is None:
        return
    if spec.kind == "bool":
        words: tuple[str, ...] = ("true", "false")
    else:
        words = spec.options
    default = _default_text(spec)
    for word in words:
        yield Completion(word, ItemKind.VALUE, cursor.start, localized(phrase("default")) if word == default else "")
    if spec.kind == "frame":
        yield from _offer_frames(document, cursor.start, with_fixed=owner.role != OPTIONS)
    elif spec.kind == "topic" or spec.name.endswith("Topic"):
        message = getattr(display_class(owner.class_name), "MESSAGE", "")
        _, _, typed = word_at(document.text, cursor)
        others = (topic for topic in _find_topics(document) if topic != typed or typed == _USUAL_TOPICS.get(message))
        for topic in dict.fromkeys((*filter(None, (_USUAL_TOPICS.get(message), default)), *others)):
            yield Completion(topic, ItemKind.NAME, cursor.start)
    elif default and not words:
        yield Completion(default, ItemKind.VALUE, cursor.start, localized(phrase("default")))


def _default_name(owner: ConfigOwner) -> str:
    """Return the name that RViz gives to a display, tool, view or panel."""
    if owner.role == "Views":
        return "Current View" if owner.entry.key == "Current" else owner.class_name.rpartition("/")[2]
    return owner.class_name.rpartition("/")[2] or ("root" if owner.role == "" else "")


def _list_classes(owner: ConfigOwner) -> Iterator[tuple[str, str]]:
    """Yield the classes that a display, tool, view or panel may have, each with its purpose."""
    if owner.role == "Displays":
        common_ranks = {f"rviz_default_plugins/{name}": index for index, name in enumerate(_COMMON_DISPLAYS)}
        for name in sorted(
            extensions(DISPLAY_ENTRY_POINTS), key=lambda name: common_ranks.get(name, len(common_ranks))
        ):
            yield name, _find_purpose(name)
    elif owner.role == "Tools":
        for name, tool in TOOL_KINDS.items():
            yield name, tool.name
    elif owner.role == "Views":
        for name in sorted(VIEW_SCHEMAS, key=lambda name: name != ORBIT):
            yield name, ""
    elif owner.role == "Panels":
        for name in PANEL_NAMES:
            yield f"rviz_common/{name}", ""


def _find_purpose(name: str) -> str:
    """Return the purpose of a class of displays or tools, or empty if it is unknown."""
    if name in TOOL_KINDS:
        return TOOL_KINDS[name].name
    display = display_class(name)
    return "" if display is None else cleandoc(display.__doc__ or "").partition("\n\n")[0]


def _offer_frames(document: Document, start: int, *, with_fixed: bool) -> Iterator[Completion]:
    if with_fixed:
        yield Completion(FIXED_FRAME, ItemKind.VALUE, start)
    for name in robot_names(document):
        if name.kind is NameKind.LINK:
            yield Completion(name.name, ItemKind.NAME, start, name.file.name)
    for frame in _USUAL_FRAMES:
        yield Completion(frame, ItemKind.NAME, start, "REP 105")


def _find_topics(document: Document) -> Iterator[str]:
    """Yield the topics in the configuration."""
    yield from dict.fromkeys(match[1] for match in _TOPIC.finditer(document.text))


# --- explanations and definitions -------------------------------------------------------------------------------------


def explain_rviz(document: Document, offset: int) -> Explanation | None:
    """Explain the key or value at an offset of a configuration, or return None."""
    cursor = YamlOutline(document.text).cursor(offset)
    start, end, word = word_at(document.text, cursor)
    if not word:
        return None
    if cursor.position is YamlPosition.KEY:
        owner = owner_of(cursor.parent_entry)
        text = _explain_property(owner, word)
        if not text and {"Links", "Frames", "Tree"} & set(owner.keys):
            text = explain_part(document, word, (NameKind.LINK,))
    else:
        parent = cursor.parent_entry.parent
        owner = owner_of(parent if parent is not None else cursor.parent_entry)
        key = cursor.parent_entry.key
        spec = owner.spec(key)
        text = ""
        if key == "Class":
            text = _explain_class(to_modern_class(word))
        elif spec is not None and spec.kind == "frame":
            text = explain_part(document, word, (NameKind.LINK,))
        text = text or _explain_property(owner, key)
    return Explanation(text, start, end) if text else None


def _explain_property(owner: ConfigOwner, key: str) -> str:
    if key == "Class":
        return _explain_class(owner.class_name)
    spec = owner.spec(key)
    return "" if spec is None else _describe_property(spec)


def _explain_class(name: str) -> str:
    purpose = _find_purpose(name)
    schema = display_schema(name) or VIEW_SCHEMAS.get(name, ())
    properties = ", ".join(f"`{spec.name}`" for spec in schema)
    return "\n\n".join(part for part in (f"**{name}**", purpose, properties) if part) if name else ""


def define_in_rviz(document: Document, offset: int) -> Iterator[Target]:
    """Yield the definition of the link at an offset, in a frame or a list of links."""
    cursor = YamlOutline(document.text).cursor(offset)
    _, _, word = word_at(document.text, cursor)
    if not word:
        return
    keys = cursor.parent_entry.path
    names_link = bool({"Links", "Frames", "Tree"} & set(keys))
    if cursor.position is YamlPosition.VALUE and cursor.parent_entry.parent is not None:
        spec = owner_of(cursor.parent_entry.parent).spec(cursor.parent_entry.key)
        names_link = spec is not None and spec.kind == "frame"
    for name in robot_names(document) if names_link else ():
        if name.kind is NameKind.LINK and name.name == word:
            yield target_of(document, name)
            return


RVIZ_FILES = Format(
    covers=lambda file: Path(file).name.endswith(".rviz"),
    complete=complete_rviz,
    explain=explain_rviz,
    define=define_in_rviz,
    symbols=yaml_symbols,
    prepare=load_displays,
)
