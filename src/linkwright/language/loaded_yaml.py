"""The content of the YAML files that properties load.

The description is not expanded, because a file that is being typed often has errors.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.language.definitions import NameDefinition, NameKind
from linkwright.language.format import Document
from linkwright.xacro.expressions import yaml_data
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.reader import read_bytes

_LOADED = re.compile(r"""\bload_yaml\(\s*(?:["'](?P<path>[^"']+)["']|(?P<name>\w+))\s*\)(?P<rest>[^{}]*)""")
_KEY = re.compile(r"""\[\s*["']([^"'\]]*)["']\s*\]""")
_SUBSTITUTION = re.compile(r"\$\((find|arg|dirname)\s*([\w.-]*)\)|\$\{(\w+)\}")
_MAX_PASSES = 8


def find_yaml_value(document: Document, name: str, names: Sequence[NameDefinition]) -> Any:
    """Return the value of a property that is loaded from a YAML file, or None for others.

    Args:
        document: the text that uses the property.
        name: the property.
        names: the names that the files of the description define.
    """
    value_text, file = _find_definition(name, NameKind.PROPERTY, names)
    match = _LOADED.search(value_text)
    if match is None or file is None:
        return None
    path = match["path"] or f"${{{match['name']}}}"
    text = _replace_known(path, file, document, names)
    if "$" in text or not text or "\0" in text:
        return None
    target = file.parent / text
    try:
        value: Any = _read_content(target, target.stat().st_mtime_ns)
    except OSError:
        return None
    for key in _KEY.finditer(match["rest"]):
        value = value.get(key[1]) if isinstance(value, dict) else None
    return value


def _find_definition(name: str, kind: NameKind, names: Sequence[NameDefinition]) -> tuple[str, Path | None]:
    """Return the value of a property or argument as written, and the file that defines it."""
    definition = next((candidate for candidate in names if candidate.kind is kind and candidate.name == name), None)
    return ("", None) if definition is None else (definition.detail, definition.file)


def _replace_known(text: str, file: Path, document: Document, names: Sequence[NameDefinition]) -> str:
    """Replace the known properties, arguments and packages in a text."""

    def value(part: re.Match[str]) -> str:
        if part[1] == "find":
            folder = document.finder.find(part[2])
            return part[0] if folder is None else str(folder)
        if part[1] == "dirname":
            return str(file.parent)
        kind = NameKind.ARGUMENT if part[1] == "arg" else NameKind.PROPERTY
        value_text, _ = _find_definition(part[2] or part[3], kind, names)
        return value_text or part[0]

    for _ in range(_MAX_PASSES):
        replaced = _SUBSTITUTION.sub(value, text)
        if replaced == text or len(replaced) > len(text) + 10_000:
            break
        text = replaced
    return text


@lru_cache(maxsize=32)
def _read_content(file: Path, _: int) -> Any:
    """Return the content of a YAML file, cached by its modification time, or None."""
    try:
        return yaml_data.load(decode(read_bytes(file), str(file)), lambda _: 0.0)
    except (OSError, LinkwrightError, yaml_data.YamlError, ValueError):
        return None
