"""Compare configurations of Gazebo's window: its plugins and their settings, without the layout."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import Phrase, Span, joined_first, phrase, quoted_names
from linkwright.review.changes import MAX_NAMES
from linkwright.review.file_pair import FilePair
from linkwright.review.texts.list_changes import change_text
from linkwright.review.versions import Version
from linkwright.xmltree import Element, parse

_MARKS = ("<gz-gui", "<ignition-gui")
_LAYOUT = frozenset({"gz-gui", "ignition-gui"})
"""The elements of a plugin with its place in the window."""
_SUFFIX = ".config"
_DECLARATION = re.compile(r"\A\s*<\?xml.*?\?>", re.DOTALL)
_MAX_BYTES = 1 << 20


@dataclass(frozen=True)
class _Plugin:
    """A plugin of the window.

    Attributes:
        name: its library, with a number from the second one on.
        settings: the texts and attributes in it, by path.
        span: its location.
    """

    name: str
    settings: Mapping[str, str]
    span: Span | None


def is_gui_file(file: Path) -> bool:
    """Return whether a file is a configuration of Gazebo's window."""
    try:
        if file.suffix != _SUFFIX or file.stat().st_size > _MAX_BYTES:
            return False
        text = file.read_text("utf-8", errors="replace")
    except OSError:
        return False
    return "<plugin" in text and any(mark in text for mark in _MARKS)


def compare_gui_files(pair: FilePair) -> None:
    """Compare two versions of a configuration of Gazebo's window."""
    versions = pair.read(_read)
    if versions is None:
        return
    old, new = ({plugin.name: plugin for plugin in plugins} for plugins in versions)
    for name, plugin in new.items():
        before = old.get(name)
        for key in dict.fromkeys([*plugin.settings, *(before.settings if before is not None else ())]):
            values = ("" if before is None else before.settings.get(key, "")), plugin.settings.get(key, "")
            if before is not None and values[0] != values[1]:
                text = change_text(phrase("plugin '{name}': {key}", name=name, key=key), *(it or "''" for it in values))
                pair.add(text, pair.location(plugin.span))
    added, removed = [name for name in new if name not in old], [name for name in old if name not in new]
    if added:
        pair.add(phrase("plugins added: {names}", names=quoted_names(added)), pair.location(new[added[0]].span))
    if removed:
        location = pair.location(old[removed[0]].span, is_old=True)
        pair.add(phrase("plugins removed: {names}", names=quoted_names(removed)), location)


def gui_contents(version: Version, path: str) -> Phrase | None:
    """Return the plugins of a configuration, or None if there are none."""
    names = [plugin.name for plugin in _read(version.file(path))]
    return phrase("plugins {names}", names=joined_first(names, MAX_NAMES)) if names else None


def _read(file: Path) -> list[_Plugin]:
    """Return the plugins in a file, which has several elements beside each other.

    Raises:
        LinkwrightError: an element is not XML.
    """
    text = file.read_text("utf-8-sig")
    text = _DECLARATION.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    root = parse(f"<gui>{text}</gui>", str(file)).root
    counts: Counter[str] = Counter()
    plugins = []
    for element in root.walk():
        if element.tag == "plugin":
            name = element.attributes.get("filename", "")
            counts[name] += 1
            shown = name if counts[name] == 1 else f"{name} {counts[name]}"
            plugins.append(_Plugin(shown, dict(_list_settings(element)), element.span()))
    return plugins


def _list_settings(element: Element, path: str = "") -> Iterator[tuple[str, str]]:
    """Yield the paths and texts of the elements and attributes in a plugin."""
    counts: Counter[str] = Counter()
    for child in element.elements():
        if child.tag in _LAYOUT:
            continue
        counts[child.tag] += 1
        number = f"[{counts[child.tag]}]" if counts[child.tag] > 1 else ""
        child_path = f"{path} {child.tag}{number}".strip()
        text = " ".join(child.text().split())
        if text:
            yield child_path, text
        yield from ((f"{child_path} {name}", value) for name, value in child.attributes.items())
        yield from _list_settings(child, child_path)
