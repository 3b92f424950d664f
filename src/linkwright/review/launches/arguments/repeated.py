"""Report arguments that a launch file of ROS 1 newly declares twice, which roslaunch refuses."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from linkwright.diagnostics import phrase
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.outlines import LaunchOutline
from linkwright.xacro.cache import read_document
from linkwright.xmltree import Element

_CONDITIONS = frozenset({"if", "unless"})


def report_repeated_arguments(pair: FilePair, new: LaunchOutline) -> None:
    """Report the arguments that only the new version declares twice without a condition, outside of groups."""
    if not new.is_ros1 or pair.new_file.suffix == ".py":
        return
    old_names = {element.attributes["name"] for element in _find_repeated(pair.old_file)}
    for element in _find_repeated(pair.new_file):
        name = element.attributes["name"]
        if name not in old_names:
            text = phrase("argument '{name}' is declared twice", name=name)
            pair.add(text, pair.location(element.span()), phrase("roslaunch refuses the file"))


def _find_repeated(file: Path) -> Iterator[Element]:
    """Yield the second declaration of each argument at the top level of a launch file in XML."""
    seen: set[str] = set()
    for element in read_document(str(file)).root.elements():
        name = element.attributes.get("name", "")
        if element.tag != "arg" or not name or not _CONDITIONS.isdisjoint(element.attributes):
            continue
        if name in seen:
            yield element
        seen.add(name)
