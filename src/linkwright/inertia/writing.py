"""Write computed ``<inertial>`` elements into the source files of links."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, SourceText, display_path, foreign, phrase
from linkwright.files.whole_files import write_whole_file
from linkwright.geometry.mass import MassProperties
from linkwright.inertia.source_edits import NotWritableError, create_edits
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.urdf import Link, Robot
from linkwright.xmltree.patches import Replacement, apply
from linkwright.xmltree.reader import read_bytes

_BYTE_ORDER_MARK = "\ufeff"


@dataclass(frozen=True, slots=True)
class WriteResult:
    """The result of writing.

    Attributes:
        files: the files that changed, in the order of their links.
        links: the links whose ``<inertial>`` was written to a file.
        refusals: the reason why a link could not be written, as a clause, by link name.
    """

    files: tuple[Path, ...]
    links: tuple[str, ...]
    refusals: Mapping[str, str]


def write_inertials(robot: Robot, properties: Mapping[str, MassProperties]) -> WriteResult:
    """Write mass properties to the source files of links, without changing any other text.

    Args:
        robot: the robot, read from a file, possibly through xacro.
        properties: the mass properties in the link frame, by link.

    Raises:
        LinkwrightError: INR201, a file cannot be written.
    """
    return write_edits({name: partial(create_link_edits, robot, name, properties[name]) for name in properties})


def create_link_edits(robot: Robot, name: str, properties: MassProperties) -> tuple[SourceText, list[Replacement]]:
    """Return a source text and the edits that give a link of a robot these mass properties.

    Args:
        robot: the robot, read from a file, possibly through xacro.
        name: the name of the link.
        properties: the mass properties in the link frame.

    Raises:
        NotWritableError: as for `create_edits`, or the text of the link also defines other links.
    """
    position = _get_source_position(robot.links[name])
    if any(_get_source_position(other) == position for other in robot.links.values() if other.name != name):
        raise NotWritableError(phrase("its text in the file defines several links"))
    return create_edits(robot.links[name], properties)


def write_edits(edit_functions: Mapping[str, Callable[[], tuple[SourceText, list[Replacement]]]]) -> WriteResult:
    """Apply edits of several elements, writing each file once.

    Args:
        edit_functions: for each name, a function that returns a text as it was read and its edits; it may raise
            `NotWritableError`.

    Returns:
        The result, with these names in place of links.

    Raises:
        LinkwrightError: INR201, a file cannot be written.
    """
    refusals: dict[str, str] = {}
    edits: dict[str, list[Replacement]] = {}
    texts: dict[str, str] = {}
    names: dict[str, list[str]] = {}
    for name, find_edits in edit_functions.items():
        try:
            source, changes = find_edits()
            if source.name not in texts:
                texts[source.name] = _read_unchanged(source.name, source.text)
        except NotWritableError as error:
            refusals[name] = str(error)
            continue
        edits.setdefault(source.name, []).extend(changes)
        names.setdefault(source.name, []).append(name)
    for file, changes in edits.items():
        _save(file, texts[file], changes)
    return WriteResult(
        tuple(map(Path, edits)), tuple(name for link_names in names.values() for name in link_names), refusals
    )


def _get_source_position(link: Link) -> tuple[str, int]:
    element = link.element
    return ("", id(link)) if element is None or element.source is None else (element.source.name, element.offset)


def _read_unchanged(file: str, text: str) -> str:
    """Return the current text of a file, including any byte order mark.

    Raises:
        NotWritableError: if the file has changed since `text` was read, cannot be read, or is not UTF-8.
    """
    try:
        current_text = read_bytes(file).decode("utf-8")
    except UnicodeDecodeError:
        raise NotWritableError(phrase("its file is not UTF-8")) from None
    except LinkwrightError:
        raise NotWritableError(phrase("it is not written in a file")) from None
    if current_text.removeprefix(_BYTE_ORDER_MARK) != text:
        raise NotWritableError(phrase("its file has changed since it was read"))
    return current_text


def _save(file: str, text: str, changes: list[Replacement]) -> None:
    byte_order_mark = _BYTE_ORDER_MARK if text.startswith(_BYTE_ORDER_MARK) else ""
    new_text = byte_order_mark + apply(text.removeprefix(_BYTE_ORDER_MARK), changes)
    try:
        write_whole_file(file, new_text)
    except OSError as error:
        message = phrase(
            "cannot write '{path}': {reason}", path=display_path(file), reason=foreign(error.strerror or error)
        )
        raise LinkwrightError(Diagnostic("INR201", message, hint=phrase("make the file writable"))) from None
