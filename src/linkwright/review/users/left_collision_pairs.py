"""Find semantic descriptions that disable collisions of a link under the name that it had before."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress

from linkwright.diagnostics import LinkwrightError, counted, phrase, quoted_names
from linkwright.review.changes import Change, Effect, Location, Subject, SubjectKind
from linkwright.review.lenient_xml import read_lenient_root
from linkwright.review.versions import Version
from linkwright.xmltree import Element

_SEMANTIC_SUFFIX = ".srdf"
_DESCRIPTION_SUFFIXES = (".urdf", ".xacro")
_RENAMED = "{subject} '{old}' renamed to '{name}'"
_LINK = "link"
_SEPARATOR = " -> "


def find_left_collision_pairs(version: Version, subjects: Sequence[Subject]) -> Iterator[tuple[str, Change]]:
    """Yield the semantic descriptions that disable collisions of a renamed link, each with a change.

    A semantic description belongs to the robot of the same name. It is left out if it also has the new name, or if
    another description of a robot of this name has the link.

    Args:
        version: the new version of the repository.
        subjects: the compared files.
    """
    renamed = {
        subject.path: names
        for subject in subjects
        if subject.kind is SubjectKind.DESCRIPTION and subject.new_path
        if (names := dict(_list_renamed_links(subject)))
    }
    if not renamed:
        return
    semantics = dict(_read_roots(version, (_SEMANTIC_SUFFIX,)))
    descriptions = dict(_read_roots(version, _DESCRIPTION_SUFFIXES)) if semantics else {}
    found: set[str] = set()
    for robot_path, names in renamed.items():
        robot = descriptions.get(robot_path)
        for path, root in semantics.items():
            if path in found or robot is None or _get_name(robot) != _get_name(root) or not _get_name(root):
                continue
            change = _compare(path, root, robot_path, names, descriptions)
            if change is not None:
                found.add(path)
                yield path, change


def _list_renamed_links(subject: Subject) -> Iterator[tuple[str, str]]:
    """Yield the old and the new names of the links that a robot has under another name with all argument sets."""
    for change in subject.changes:
        arguments = change.core.arguments
        if change.core.template == _RENAMED and str(arguments["subject"]) == _LINK and not change.cases:
            yield str(arguments["old"]), change.name
            for names in change.other_names:
                old, separator, new = names.partition(_SEPARATOR)
                if separator:
                    yield old, new


def _compare(
    path: str, root: Element, robot: str, renamed: Mapping[str, str], descriptions: Mapping[str, Element]
) -> Change | None:
    pairs = root.elements("disable_collisions")
    places = {pair.attributes.get(key, ""): pair for pair in pairs for key in ("link1", "link2")}
    same = [other for other in descriptions.values() if _get_name(other) == _get_name(root)]
    links = {link.attributes.get("name", "") for other in same for link in other.walk() if link.tag == _LINK}
    left = [old for old, new in renamed.items() if old in places and new not in places and old not in links]
    if not left:
        return None
    text = phrase("disables collisions of {names}, which '{file}' no longer has", names=quoted_names(left), file=robot)
    reason = counted(
        "MoveIt also checks the disabled collisions of the link, which is {names} now",
        "MoveIt also checks the disabled collisions of the links, which are {names} now",
        len(left),
        names=quoted_names([renamed[name] for name in left]),
    )
    span = places[left[0]].span()
    location = None if span is None else Location(path, span.line, span.column)
    return Change(text, Effect.BREAKING, reason, location)


def _read_roots(version: Version, suffixes: tuple[str, ...]) -> Iterator[tuple[str, Element]]:
    for path in version.paths(suffixes):
        with suppress(LinkwrightError, OSError):
            yield path, read_lenient_root(version.file(path))


def _get_name(root: Element) -> str:
    return root.attributes.get("name", "")
