"""Expand a description to text with source locations and to robots."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import LinkwrightError
from linkwright.language.includes import real_path
from linkwright.language.workspace import Workspace
from linkwright.urdf import Robot, read
from linkwright.xacro import expand
from linkwright.xmltree import Element, Overlay, parse
from linkwright.xmltree.positions import find_start_tag_end


@dataclass(frozen=True, slots=True)
class ExpandedElement:
    """An element of an expansion and its source.

    Attributes:
        start: the character offset of the start tag in the text of the expansion.
        end: the offset after the start tag.
        file: the file that contains the source of the element.
        source_start: the offset of the start tag in that file.
        source_end: the offset after the start tag in that file.
    """

    start: int
    end: int
    file: Path
    source_start: int
    source_end: int


@dataclass(frozen=True, slots=True)
class ExpandedText:
    """The text of an expansion.

    Attributes:
        text: the text, as `linkwright xacro` writes it.
        elements: the elements, in the order of the text.
    """

    text: str
    elements: tuple[ExpandedElement, ...]

    def element_at(self, offset: int) -> ExpandedElement | None:
        """Return the last element whose start tag begins at or before an offset, or None."""
        return next((element for element in reversed(self.elements) if element.start <= offset), None)

    def elements_from(self, file: Path, offset: int) -> list[ExpandedElement]:
        """Return the elements whose source is the start tag around an offset of a file."""
        return [
            element
            for element in self.elements
            if element.file == file and element.source_start <= offset <= element.source_end
        ]


def expand_to_text(
    workspace: Workspace, texts: Mapping[Path, str], entry: Path, arguments: Mapping[str, str]
) -> ExpandedText:
    """Return the expansion of a description with the source of its elements.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        entry: the description.
        arguments: the values of its arguments, by name.

    Raises:
        LinkwrightError: the description cannot be expanded.
    """
    overlay = Overlay({str(path): text for path, text in texts.items()})
    expansion = expand(entry, arguments, packages=workspace.finder(entry), overlay=overlay)
    text = str(expansion)
    expanded_root = parse(text, str(entry)).root
    elements = []
    for expanded_element, element in zip(expanded_root.walk(), expansion.document.root.walk(), strict=True):
        expanded_range = _find_tag_range(expanded_element)
        source = _find_tag_range(element)
        if expanded_range is not None and source is not None and element.source is not None:
            elements.append(ExpandedElement(*expanded_range, real_path(element.source.name), *source))
    return ExpandedText(text, tuple(elements))


def _find_tag_range(element: Element) -> tuple[int, int] | None:
    if element.source is None:
        return None
    return element.offset, find_start_tag_end(element.source.text, element.offset)


def expand_to_robots(workspace: Workspace, texts: Mapping[Path, str], file: Path) -> Iterator[tuple[Path, Robot]]:
    """Yield the robots of the descriptions that include a file.

    Each valid argument set gives a robot.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        file: a file that the descriptions include, or a description itself.

    Yields:
        The description and its robot.
    """
    overlay = Overlay({str(path): text for path, text in texts.items()})
    for entry in workspace.index.entries(file, texts):
        for arguments, _ in workspace.argument_calls(entry):
            try:
                expansion = expand(entry, arguments, packages=workspace.finder(entry), overlay=overlay)
            except LinkwrightError:
                continue
            robot = read(expansion.document).robot
            if robot is not None:
                yield entry, robot


def is_source_of(file: Path, start: int, element: Element | None) -> bool:
    """Return whether the start tag at an offset of a file is the source of an expanded element."""
    source = None if element is None else element.source
    return element is not None and source is not None and (real_path(source.name), element.offset) == (file, start)
