"""Language features for interface files: ``.msg``, ``.srv`` and ``.action``."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import phrase
from linkwright.diagnostics.translation import localized
from linkwright.language.completion import Completion, ItemKind
from linkwright.language.format import Document, Format, Symbol, SymbolKind, Target
from linkwright.language.hover import Explanation
from linkwright.messages import catalog
from linkwright.messages.definitions.interfaces import PRIMITIVES, to_snake_case
from linkwright.messages.definitions.parser import SECTIONS
from linkwright.packages import enclosing_package
from linkwright.packages.interface_files import find_interface_file, find_interface_files
from linkwright.packages.share_layout import find_source

_FIELD = re.compile(
    r"^[ \t]*(?P<type>[A-Za-z_][\w/]*)?(?P<bounds>(?:<=\w*)?(?:\[[^\]\n#]*\]?)?)?"
    r"(?:[ \t]+(?P<name>\w*)?(?P<rest>[^\n#]*))?",
    re.MULTILINE,
)
_SEPARATOR = re.compile(r"^---[ \t]*\r?$", re.MULTILINE)
_COMMON_PRIMITIVES = ("float64", "int32", "string", "bool", "uint8", "float32", "int64", "uint32")
_COMMON_TYPES = (
    *("std_msgs/Header", "builtin_interfaces/Time", "builtin_interfaces/Duration"),
    *("geometry_msgs/PoseStamped", "geometry_msgs/Pose", "geometry_msgs/Point", "geometry_msgs/Twist"),
    *("geometry_msgs/Vector3", "geometry_msgs/Quaternion", "geometry_msgs/Transform", "nav_msgs/Path"),
    *("sensor_msgs/Image", "sensor_msgs/PointCloud2", "sensor_msgs/LaserScan"),
)
_MAX_NEIGHBORS = 100
_COMMON_PACKAGES = ("std_msgs", "geometry_msgs", "sensor_msgs", "builtin_interfaces", "nav_msgs")


def is_interface_file(path: Path) -> bool:
    """Return whether a path has the suffix of an interface file."""
    return path.suffix in (".msg", ".srv", ".action")


@dataclass(frozen=True, slots=True)
class _Message:
    """The text of a message type, and the location of its definition."""

    text: str
    target: Target


def _match_line_at(text: str, offset: int) -> re.Match[str] | None:
    """Return the line around an offset, or None if the offset is in a comment."""
    start = text.rfind("\n", 0, offset) + 1
    match = _FIELD.match(text, start)
    return None if match is None or "#" in text[start:offset] else match


def _find_own_package(document: Document) -> str:
    package = enclosing_package(document.file.parent)
    return "" if package is None else package[0]


def _find_message(document: Document, type_name: str) -> _Message | None:
    """Return the message with the type ``Name`` or ``package/Name``, or None if it is unknown."""
    package, slash, name = type_name.rpartition("/")
    if not slash and name == "Header":
        package = "std_msgs"
    package = package.removesuffix("/msg") or _find_own_package(document)
    share = document.finder.find(package) if package else None
    file = None if share is None else find_interface_file(share, "msg", name)
    if file is not None:
        file = Path(find_source(str(file)))
        return _Message(document.other(file), Target(file))
    text = catalog.read_texts(package).get(f"msg/{name}")
    if text is None:
        return None
    source = catalog.get_file(package)
    start = source.read_text(encoding="utf-8").find(f"=== msg/{name}\n")
    return _Message(text, Target(source, start + 4, start + 8 + len(name)))


# --- completion -----------------------------------------------------------------------------------------------


def _complete(document: Document, offset: int) -> Iterator[Completion]:
    line = _match_line_at(document.text, offset)
    if line is None:
        return
    if line["type"] is None or offset <= line.end("type"):
        begin = line.start("type") if line["type"] is not None else offset
        yield from _offer_types(document, document.text[begin:offset], min(begin, offset))
    elif line["name"] is not None and line.start("name") <= offset <= line.end("name"):
        base = line["type"].rpartition("/")[2]
        if base not in PRIMITIVES:
            yield Completion(to_snake_case(base), ItemKind.NAME, line.start("name"))


def _offer_types(document: Document, typed: str, start: int) -> Iterator[Completion]:
    own_package = _find_own_package(document)
    package, slash, _ = typed.partition("/")
    likely = [*dict.fromkeys((*_find_used_types(document, start), *_COMMON_TYPES))]
    if slash:
        names = [f"{package}/{name}" for name in _list_message_names(document, package)]
        ranks = {name: index for index, name in enumerate(likely)}
        for name in sorted(names, key=lambda name: (ranks.get(name, len(ranks)), name)):
            yield Completion(name, ItemKind.NAME, start)
        return
    for primitive in (*_COMMON_PRIMITIVES, *(name for name in PRIMITIVES if name not in _COMMON_PRIMITIVES)):
        yield Completion(primitive, ItemKind.VALUE, start, PRIMITIVES[primitive].idl_name)
    for name in _list_message_names(document, own_package):
        if name != document.file.stem or document.file.suffix != ".msg":
            yield Completion(name, ItemKind.NAME, start, own_package)
    for name in likely:
        yield Completion(name, ItemKind.NAME, start)
    for package in dict.fromkeys((*_COMMON_PACKAGES, *sorted({*catalog.list_packages(), *document.finder.packages()}))):
        for name in _list_message_names(document, package) if package != own_package else ():
            if f"{package}/{name}" not in likely:
                yield Completion(f"{package}/{name}", ItemKind.NAME, start)


def _find_used_types(document: Document, excluded_offset: int) -> list[str]:
    """Return the types from other packages that the package uses, the most used first.

    Args:
        document: the text.
        excluded_offset: the offset of a type in the text that is not counted.
    """
    use_counts: Counter[str] = Counter()
    files = sorted(document.file.parent.glob(f"*{document.file.suffix}"))[:_MAX_NEIGHBORS]
    for file in dict.fromkeys((document.file, *files)):
        text = document.text if file == document.file else document.other(file)
        lines = (
            line for line in _FIELD.finditer(text) if file != document.file or line.start("type") != excluded_offset
        )
        use_counts.update(line["type"] for line in lines if line["type"] and line["name"] and "/" in line["type"])
    return [name for name, _ in use_counts.most_common()]


def _list_message_names(document: Document, package: str) -> list[str]:
    share = document.finder.find(package) if package else None
    own_messages = {} if share is None else find_interface_files(share, "msg")
    known_messages = [name.removeprefix("msg/") for name in catalog.read_texts(package) if name.startswith("msg/")]
    return sorted({*own_messages, *known_messages})


# --- hover, definition and symbols ----------------------------------------------------------------------------


def _explain(document: Document, offset: int) -> Explanation | None:
    line = _match_line_at(document.text, offset)
    if line is None or line["type"] is None or not line.start() <= offset <= line.end():
        return None
    type_name = line["type"]
    is_in_name = line["name"] and line.start("name") <= offset <= line.end("name")
    if not is_in_name and not line.start("type") <= offset <= line.end("type"):
        return None
    start, end = line.span("name" if is_in_name else "type")
    if type_name in PRIMITIVES:
        return Explanation(_describe_primitive(type_name), start, end)
    message = _find_message(document, type_name)
    return None if message is None else Explanation(f"**{type_name}**\n\n```\n{message.text.strip()}\n```", start, end)


def _describe_primitive(name: str) -> str:
    primitive = PRIMITIVES[name]
    if primitive.is_integer:
        text = phrase("`{name}`: an integer from {low} to {high}", name=name, low=primitive.low, high=primitive.high)
    elif primitive.python is float:
        text = phrase("`{name}`: a floating-point number with {bits} bits", name=name, bits=primitive.size * 8)
    else:
        return f"`{name}`: {primitive.idl_name}"
    return localized(text)


def _define(document: Document, offset: int) -> Iterator[Target]:
    line = _match_line_at(document.text, offset)
    if line is not None and line["type"] is not None and offset <= line.end("type"):
        message = None if line["type"] in PRIMITIVES else _find_message(document, line["type"])
        if message is not None:
            yield message.target


def _symbols(document: Document) -> Iterator[Symbol]:
    text = document.text
    separators = [(match.start(), match.end()) for match in _SEPARATOR.finditer(text)]
    bounds = [0, *(end for _, end in separators)], [*(start for start, _ in separators), len(text)]
    names = SECTIONS.get(document.file.suffix[1:], ("",))
    for index, (start, end) in enumerate(zip(*bounds, strict=True)):
        fields = tuple(_find_fields(text, start, end))
        name = names[index].lstrip("_") if index < len(names) else ""
        if not name:
            yield from fields
        else:
            yield Symbol(name, SymbolKind.GROUP, start, end, fields)


def _find_fields(text: str, start: int, end: int) -> Iterator[Symbol]:
    for line in _FIELD.finditer(text, start, end):
        if line["type"] and line["name"]:
            kind = SymbolKind.CONSTANT if (line["rest"] or "").lstrip().startswith("=") else SymbolKind.FIELD
            detail = line["type"] + (line["bounds"] or "")
            yield Symbol(line["name"], kind, line.start("type"), line.end(), (), detail)


INTERFACES = Format(is_interface_file, _complete, _explain, _define, symbols=_symbols)
"""The format of interface files: messages, services and actions."""
