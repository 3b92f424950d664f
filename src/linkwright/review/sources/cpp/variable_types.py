"""Find the types of the variables into which C++ sources read parameters."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path

from linkwright.review.sources.enclosing_folders import list_enclosing_folders

_LIST = "list"
_TEXT = "string"
_INTEGER_PATTERN = r"(?:(?:unsigned|signed|short|long|int)\b[ \t]*)+|(?:std::)?(?:u?int(?:8|16|32|64)_t|size_t)\b"
_SIMPLE = re.compile(
    rf"(?P<int>{_INTEGER_PATTERN})|(?P<double>float|double)|(?P<bool>bool)|(?P<string>(?:std::)?string)"
)
_TYPE = rf"(?:(?:std::)?vector\s*<[^;{{}}()]*>|{_INTEGER_PATTERN}|(?:float|double|bool|(?:std::)?string)\b)"
_OTHERS = r"(?:\w+\s*(?:=[^;,(){}]*)?,\s*)*"
"""The variables before another one in the same declaration."""
_END = r"\s*(?=[;,=({)])"
_VARIABLE = r"[A-Za-z_]\w*\s*(?:=[^;,(){}]*)?"
_DECLARATION = re.compile(
    rf"(?<![\w:<])(?P<type>{_TYPE})\s*&?\s*(?<=[\s>&])(?P<names>{_VARIABLE}(?:,\s*{_VARIABLE})*){_END}"
)
_FIELD = re.compile(r"^\s*(?P<type>[\w/]+)(?P<array>\[[^\]]*\])?\s+(?P<name>\w+)\s*(?:#.*)?$", re.MULTILINE)
_FIELD_TYPES = ((re.compile(r"u?int\d+|byte|char"), "int"), (re.compile(r"float\d+"), "double"))
_PASSED = re.compile(r"\s*,\s*(?:this\s*->\s*)?(?:(?P<object>\w+)\s*\.\s*)?(?P<name>[A-Za-z_]\w*)\s*[,)]")
_MAX_FOLDERS = 4
"""The maximum number of folders above a source in which packages with messages are searched."""


def normalize_read_type(text: str) -> str:
    """Return the type of a parameter: ``int``, ``double``, ``bool``, ``string`` or ``list``; others unchanged."""
    text = " ".join(text.replace("const ", "").split())
    if "vector" in text:
        return _LIST
    match = _SIMPLE.fullmatch(text)
    return text if match is None or match.lastgroup is None else match.lastgroup


def rejects_values(old: str, new: str) -> bool:
    """Return whether ROS 1 refuses values of an old type for a variable of a new one. It converts numbers."""
    known = {"int": "number", "double": "number", "bool": "bool", _TEXT: _TEXT, _LIST: _LIST}
    kinds = known.get(normalize_read_type(old)), known.get(normalize_read_type(new))
    return None not in kinds and kinds[0] != kinds[1]


class VariableTypes:
    """The types of the variables and members of a C++ source.

    Args:
        path: the path of the source.
        text: the source without comments.
        headers: the texts of the headers that may declare members of its classes.
    """

    def __init__(self, path: Path, text: str, headers: Sequence[str]) -> None:
        self._path = path
        self._text = text
        self._headers = headers

    def find_passed(self, end: int) -> str:
        """Return the normalized type of the variable that a call gets behind the name of a parameter.

        It is empty if it is unknown.

        Args:
            end: the offset of the end of the argument with the name.
        """
        match = _PASSED.match(self._text, end)
        if match is None:
            return ""
        if match["object"] is not None:
            messages = self._find_messages(match["object"])
            types = {_read_field(self._path, package, message, match["name"]) for package, message in messages}
        else:
            types = self._find_types(match["name"], end)
        return types.pop() if len(types) == 1 else ""

    def _find_types(self, name: str, position: int) -> set[str]:
        """Return the types of the declaration before a position in its function, or of all declarations."""
        start = self._text.rfind("\n}", 0, position) + 1
        own = self._declarations.get(name, [])
        local = [kind for place, kind in own if start <= place < position]
        return set(local[-1:]) or {kind for _, kind in own} | self._header_types.get(name, set())

    @cached_property
    def _declarations(self) -> dict[str, list[tuple[int, str]]]:
        """The offsets and types of the declarations in the source, by variable."""
        found: dict[str, list[tuple[int, str]]] = {}
        for name, place, kind in _find_declarations(self._text):
            found.setdefault(name, []).append((place, kind))
        return found

    @cached_property
    def _header_types(self) -> dict[str, set[str]]:
        found: dict[str, set[str]] = {}
        for name, _, kind in (item for text in self._headers for item in _find_declarations(text)):
            found.setdefault(name, set()).add(kind)
        return found

    def _find_messages(self, name: str) -> Iterator[tuple[str, str]]:
        """Yield the package and the name of each type of messages with which a variable is declared."""
        pattern = re.compile(rf"\b(?P<package>\w+)::(?:msg::)?(?P<name>[A-Z]\w*)\s+&?\s*{_OTHERS}{name}\b{_END}")
        for text in (self._text, *self._headers):
            for match in pattern.finditer(text):
                yield match["package"], match["name"]


def _find_declarations(text: str) -> Iterator[tuple[str, int, str]]:
    """Yield the name of each declared variable with the offset of its declaration and its type."""
    for match in _DECLARATION.finditer(text):
        kind = normalize_read_type(match["type"])
        for item in match["names"].split(","):
            yield item.partition("=")[0].strip(), match.start(), kind


def _read_field(path: Path, package: str, message: str, name: str) -> str:
    """Return the type of a field of a message of a package near a source; empty if it is unknown."""
    folders = list_enclosing_folders(path.parent, _MAX_FOLDERS)
    file = next((file for folder in folders if (file := folder / package / "msg" / f"{message}.msg").is_file()), None)
    text = "" if file is None else file.read_text("utf-8", errors="replace")
    field = next((match for match in _FIELD.finditer(text) if match["name"] == name), None)
    if field is None:
        return ""
    if field["array"]:
        return _LIST
    found = (kind for pattern, kind in _FIELD_TYPES if pattern.fullmatch(field["type"]))
    return next(found, field["type"] if field["type"] in ("bool", _TEXT) else "")
