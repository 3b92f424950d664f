"""The files that an XML text refers to, such as includes, meshes and textures."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from linkwright.diagnostics import LinkwrightError
from linkwright.language.values import EvaluatedText
from linkwright.packages import PackageFinder
from linkwright.xmltree.tokens import Kind, tokens

_PATH_ATTRIBUTES = ("filename", "file", "uri", "path", "url")
_PATH_TAGS = ("uri", "albedo_map", "normal_map", "filename", "parameters", "mesh")
_SCHEME = re.compile(r"^(?:package|model|file)://")
_FIND_SUBSTITUTION = re.compile(r"\$\(find(?:-pkg-share)?\s+([^()\s]+)\)")
_LOAD_YAML = re.compile(r"load_yaml\(\s*(['\"])(?P<path>[^'\"]+)\1")


class FileReference(NamedTuple):
    """A file that a text refers to.

    Attributes:
        start: the character offset of the reference.
        end: the offset after its last character.
        file: the existing file or folder.
    """

    start: int
    end: int
    file: Path


def file_references(
    text: str, file: Path, finder: PackageFinder, values: Iterable[EvaluatedText] = ()
) -> Iterator[FileReference]:
    """Yield the references to existing files and folders in a text, in text order.

    Args:
        text: the text, which may be incomplete.
        file: the file of the text. Relative paths start at its folder.
        finder: finds packages.
        values: the values of the expressions in the text. A reference with expressions needs a single value.
    """
    values_by_range = {(value.start, value.end): value.values() for value in values}
    tag = ""
    for token in tokens(text):
        if token.kind is Kind.START:
            tag = token.name
            for attribute in token.attributes():
                is_path = attribute.name in _PATH_ATTRIBUTES
                value = attribute.value or ""
                yield from _find_reference(value, attribute.value_start, file, finder, values_by_range, is_path=is_path)
        elif token.kind is Kind.TEXT and token.text.strip():
            value = token.text.strip()
            start = token.start + token.text.index(value)
            yield from _find_reference(value, start, file, finder, values_by_range, is_path=tag in _PATH_TAGS)


def _find_reference(
    value: str,
    start: int,
    file: Path,
    finder: PackageFinder,
    values_by_range: dict[tuple[int, int], list[str]],
    *,
    is_path: bool,
) -> Iterator[FileReference]:
    loaded = _LOAD_YAML.search(value)
    begin, end = loaded.span("path") if loaded else (0, len(value))
    path_text = value[begin:end]
    if not (is_path or loaded or _SCHEME.match(path_text) or _FIND_SUBSTITUTION.match(path_text)):
        return
    values = values_by_range.get((start, start + len(value)), ())
    address = _FIND_SUBSTITUTION.sub(lambda match: str(finder.find(match[1]) or match[0]), path_text)
    if "$" in address and not loaded and len(values) == 1:
        address = values[0].strip("'\"")
    target = None if "$" in address else _resolve_address(address, file, finder)
    if target is not None:
        yield FileReference(start + begin, start + end, target)


def _resolve_address(address: str, file: Path, finder: PackageFinder) -> Path | None:
    """Return the file or folder at an address, or None if it does not exist."""
    if not address or "\n" in address or "*" in address:
        return None
    if address.startswith("model://"):
        address = address.replace("model://", "package://", 1)
    try:
        path = finder.resolve(address, file.parent) if _SCHEME.match(address) else file.parent / address
        return path if path.exists() else None
    except (LinkwrightError, OSError, ValueError):
        return None
