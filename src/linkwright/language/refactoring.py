"""Refactorings at a selection: which may be possible, and their proved edits."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase
from linkwright.language.conversion import NewFile, can_be_converted, convert_to_xacro
from linkwright.language.cursor import name_at
from linkwright.language.definitions import NameDefinition, NameKind
from linkwright.language.extraction import extract_property, selected_value
from linkwright.language.grammar import root_of
from linkwright.language.inertials import fill_in_inertia, link_with_shapes_at
from linkwright.language.inlining import inline_property, property_at
from linkwright.language.macro_extraction import extract_macro, selected_elements
from linkwright.language.proof import Edit, UnprovedError
from linkwright.language.workspace import Workspace
from linkwright.sdf.worlds import SDF

_MAX_TEXT = 500_000
"""Characters; longer descriptions are made by programs."""
_MAX_SHOWN = 30
"""Characters of a selection in a title."""


class Action(Enum):
    """The refactorings, by the kind of code action that the protocol has for them."""

    EXTRACT_PROPERTY = "refactor.extract.property"
    EXTRACT_MACRO = "refactor.extract.macro"
    INLINE_PROPERTY = "refactor.inline.property"
    CONVERT_TO_XACRO = "refactor.rewrite.xacro"
    FILL_IN_INERTIA = "refactor.rewrite.inertia"


@dataclass(frozen=True, slots=True)
class Offer:
    """A refactoring that the text allows; its edits are not proved yet.

    Attributes:
        action: the refactoring.
        title: its title in a menu.
    """

    action: Action
    title: Phrase


@dataclass(frozen=True, slots=True)
class Refactoring:
    """The proved result of a refactoring.

    Attributes:
        edits: the edits.
        new_file: a file that it makes, or None.
    """

    edits: tuple[Edit, ...] = ()
    new_file: NewFile | None = None


def offers_at(text: str, file: Path, start: int, end: int, names: Iterable[NameDefinition] = ()) -> Iterator[Offer]:
    """Yield the refactorings that a text allows at a selection; nothing is expanded.

    Args:
        text: the text of the file, which may be incomplete.
        file: the file.
        start: the character offset of the selection.
        end: the offset after it; equal to `start` for a cursor.
        names: the names that the description defines.
    """
    root = root_of(file)
    if root is None or root is SDF or len(text) > _MAX_TEXT:
        return
    if can_be_converted(text, file):
        title = phrase("write this URDF as xacro, in a new file '{file}'", file=f"{file.name}.xacro")
        yield Offer(Action.CONVERT_TO_XACRO, title)
    if "xmlns:xacro" in text:
        value = selected_value(text, start, end)
        if value is not None:
            shown = text[value.start : value.end]
            shown = shown if len(shown) <= _MAX_SHOWN else f"{shown[:_MAX_SHOWN]}..."
            yield Offer(Action.EXTRACT_PROPERTY, phrase("extract '{value}' to a property", value=shown))
        siblings = selected_elements(text, start, end)
        if siblings:
            title = (
                phrase("extract <{tag}> to a macro", tag=siblings[0].name)
                if len(siblings) == 1
                else phrase("extract {count} elements to a macro", count=len(siblings))
            )
            yield Offer(Action.EXTRACT_MACRO, title)
        word = name_at(text, start)
        name = property_at(text, file, start) if word is not None and _has_one_value(word[0], names) else None
        if name is not None and end <= name.end:
            yield Offer(Action.INLINE_PROPERTY, phrase("inline the property '{name}'", name=name.name))
    link = link_with_shapes_at(text, start)
    if link is not None and link.macro is None:
        title = phrase("fill in the inertia of the link '{name}', computed from its shapes", name=link.value("name"))
        yield Offer(Action.FILL_IN_INERTIA, title)


def _has_one_value(name: str, names: Iterable[NameDefinition]) -> bool:
    """Return whether a property has one definition, which is a value and not a block."""
    definitions = [one for one in names if one.kind is NameKind.PROPERTY and one.name == name]
    return len(definitions) == 1 and bool(definitions[0].detail)


def refactor(
    project: Workspace, texts: Mapping[Path, str], action: Action, file: Path, start: int, end: int
) -> Refactoring:
    """Return the proved edits of a refactoring.

    Args:
        project: the workspace.
        texts: the texts of the open files.
        action: the refactoring.
        file: the file.
        start: the character offset of the selection.
        end: the offset after it.

    Raises:
        LinkwrightError: LANG105, the edits cannot be proved.
    """
    text = project.text(file, texts) or ""
    try:
        result = _ACTIONS[action](project, texts, file, text, (start, end))
    except UnprovedError as error:
        message = phrase("the text stays as it is: {reason}", reason=error.reason)
        raise LinkwrightError(Diagnostic("LANG105", message, error.span)) from None
    return result


_Selection = tuple[int, int]
_NOTHING = phrase("this refactoring does not fit the selection")


def _property_extracted(
    project: Workspace, texts: Mapping[Path, str], file: Path, text: str, selection: _Selection
) -> Refactoring:
    value = selected_value(text, *selection)
    if value is None:
        raise UnprovedError(_NOTHING)
    return Refactoring(extract_property(project, texts, file, text, value))


def _macro_extracted(
    project: Workspace, texts: Mapping[Path, str], file: Path, text: str, selection: _Selection
) -> Refactoring:
    siblings = selected_elements(text, *selection)
    if not siblings:
        raise UnprovedError(_NOTHING)
    return Refactoring(extract_macro(project, texts, file, text, siblings))


def _property_inlined(
    project: Workspace, texts: Mapping[Path, str], file: Path, text: str, selection: _Selection
) -> Refactoring:
    name = property_at(text, file, selection[0])
    if name is None:
        raise UnprovedError(_NOTHING)
    return Refactoring(inline_property(project, texts, name))


def _converted(
    project: Workspace, texts: Mapping[Path, str], file: Path, text: str, _selection: _Selection
) -> Refactoring:
    return Refactoring(new_file=convert_to_xacro(project, texts, file, text))


def _inertia_filled_in(
    project: Workspace, texts: Mapping[Path, str], file: Path, text: str, selection: _Selection
) -> Refactoring:
    link = link_with_shapes_at(text, selection[0])
    if link is None:
        raise UnprovedError(_NOTHING)
    return Refactoring(fill_in_inertia(project, texts, file, text, link))


_ACTIONS: dict[Action, Callable[[Workspace, Mapping[Path, str], Path, str, _Selection], Refactoring]] = {
    Action.EXTRACT_PROPERTY: _property_extracted,
    Action.EXTRACT_MACRO: _macro_extracted,
    Action.INLINE_PROPERTY: _property_inlined,
    Action.CONVERT_TO_XACRO: _converted,
    Action.FILL_IN_INERTIA: _inertia_filled_in,
}
