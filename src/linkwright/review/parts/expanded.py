"""Find the elements of changed files that the expansions of the compared robots use."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator

from linkwright.descriptions import Description
from linkwright.review.changes import FILE, ExpandedElement, Subject
from linkwright.review.versions import Version, Versions
from linkwright.xacro.faults import Frame, frames
from linkwright.xmltree import Element


def find_expanded_elements(versions: Versions, old: Description, new: Description) -> Iterator[ExpandedElement]:
    """Yield the elements of changed files that two expansions use.

    These are written elements, macro calls and includes.
    """
    for version, description in ((versions.old, old), (versions.new, new)):
        paths = {file.old_path if version.is_old else file.new_path for file in versions.changed_files}
        yield from _find_used_elements(version, description, {path for path in paths if path})


def find_read_files(versions: Versions, subjects: Iterable[Subject]) -> set[str]:
    """Return the paths of the changed files that compared robots read in both versions, as included files."""
    expanded = {element for subject in subjects for element in subject.expanded}
    return {
        path
        for file in versions.changed_files
        if (path := file.new_path) is not None and path == file.old_path
        if all(ExpandedElement(path, FILE, is_old) in expanded for is_old in (True, False))
    }


def _find_used_elements(version: Version, description: Description, paths: set[str]) -> Iterator[ExpandedElement]:
    names: dict[str, str] = {}
    for file in description.files:
        path = version.relative(file)
        if path in paths:
            names[str(file)] = names[os.path.realpath(file)] = path  # the share folder may link to the file
            yield ExpandedElement(path, FILE, version.is_old)
    if not names:
        return
    visited_frames: set[int] = set()
    for element in description.document.root.walk():
        yield from _find_written_element(element, names, version)
        frame = element.origin if isinstance(element.origin, Frame) else None
        for call_frame in frames(frame):
            if id(call_frame) in visited_frames:
                break
            visited_frames.add(id(call_frame))
            yield from _find_written_element(call_frame.site, names, version)


def _find_written_element(element: Element, names: dict[str, str], version: Version) -> Iterator[ExpandedElement]:
    path = None if element.source is None else names.get(element.source.name)
    if path is not None:
        yield ExpandedElement(path, element.offset, version.is_old)
