"""The classes that packages export through pluginlib, such as hardware and controllers."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from weakref import WeakKeyDictionary

from linkwright.language.format import Document, NotYetKnownError
from linkwright.language.workspace import Workspace
from linkwright.packages import enclosing_package, install_prefix, is_installed
from linkwright.packages.readers.entry_points import read_text
from linkwright.xmltree.tokens import Kind, Token, tokens

_EXPORT = re.compile(r"(?i)\bpluginlib_export_plugin_description_file\s{0,9}\(\s{0,99}([\w-]+)\s{1,99}\"?([^\s\")]+)")
_CACHE_LIFETIME_S = 10.0
"""The maximum age of the exported classes, in seconds."""


@dataclass(frozen=True, slots=True)
class PluginClass:
    """A class that a package exports.

    Attributes:
        name: the lookup name of the class, such as ``diff_drive_controller/DiffDriveController``.
        type: the class in C++.
        base: the package of the base class, such as ``hardware_interface``.
        description: its description, or empty.
        package: the folder of the package.
        file: the file that exports it.
        start: the offset of the name in the file.
    """

    name: str
    type: str
    base: str
    description: str
    package: Path
    file: Path
    start: int


_classes: WeakKeyDictionary[Workspace, tuple[float, list[PluginClass]]] = WeakKeyDictionary()


def plugin_classes(document: Document, base: str) -> list[PluginClass]:
    """Return the exported classes whose base class belongs to a package.

    Args:
        document: the file of the request.
        base: the package of the base classes.

    Raises:
        NotYetKnownError: the packages were never read, and the document does not wait.
    """
    return [plugin for plugin in _list_classes(document) if plugin.base == base]


def _list_classes(document: Document) -> list[PluginClass]:
    cached = _classes.get(document.workspace)
    if cached is not None and time.monotonic() - cached[0] <= _CACHE_LIFETIME_S:
        return cached[1]
    if document.waits:
        folders = dict.fromkeys((*document.workspace.index.packages, *document.finder.packages().values()))
        classes = {plugin.name: plugin for folder in folders for plugin in _find_exported_classes(folder)}
        cached = _classes[document.workspace] = time.monotonic(), list(classes.values())
    elif cached is None:
        raise NotYetKnownError
    else:
        document.refreshes.append(partial(_list_classes, replace(document, waits=True)))
    return cached[1]


def _find_exported_classes(folder: Path) -> Iterator[PluginClass]:
    """Yield the classes that a package exports."""
    for base, file in _find_plugin_descriptions(folder):
        yield from _parse_classes(read_text(file), base, folder, file)


def _find_plugin_descriptions(folder: Path) -> Iterator[tuple[str, Path]]:
    """Yield the base class package and path of each plugin description of a package."""
    if is_installed(folder):
        prefix, end = install_prefix(folder), "__pluginlib__plugin"
        for index in (prefix / "share/ament_index/resource_index").glob(f"*{end}/{folder.name}"):
            yield from ((index.parent.name.removesuffix(end), prefix / line) for line in read_text(index).split())
        return
    text = read_text(folder / "CMakeLists.txt")
    package = enclosing_package(folder)
    name = folder.name if package is None else package[0]
    for match in _EXPORT.finditer(text):
        yield match[1], folder / match[2].replace("${PROJECT_NAME}", name)


def _parse_classes(text: str, base: str, folder: Path, file: Path) -> Iterator[PluginClass]:
    current: Token | None = None
    tag = description = ""
    for token in tokens(text):
        if token.kind is Kind.START:
            tag = token.name
            if tag == "class":
                current, description = token, ""
                if token.is_empty_element:
                    yield from _parse_class(token, "", base, folder, file)
                    current = None
        elif token.kind is Kind.TEXT and tag == "description":
            description += token.text
        elif token.kind is Kind.END:
            tag = ""
            if token.name == "class" and current is not None:
                yield from _parse_class(current, " ".join(description.split()), base, folder, file)
                current = None


def _parse_class(token: Token, description: str, base: str, folder: Path, file: Path) -> Iterator[PluginClass]:
    attributes = {attribute.name: attribute for attribute in token.attributes()}
    name_attribute = attributes.get("name") or attributes.get("type")
    if name_attribute is not None and name_attribute.value:
        kind = attributes["type"].value if "type" in attributes else None
        yield PluginClass(name_attribute.value, kind or "", base, description, folder, file, name_attribute.value_start)
