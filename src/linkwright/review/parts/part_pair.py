"""Both versions of a changed file with an unexpanded description."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from linkwright.descriptions.comparison import ROS2_CONTROL
from linkwright.diagnostics import Phrase
from linkwright.review.changes import FILE, Change, Effect, ExpandedElement, Location
from linkwright.review.parts.name_substitution import CALL
from linkwright.review.parts.outline import MacroOutline, Outline, uses_name
from linkwright.review.versions import Versions
from linkwright.xmltree import Element


@dataclass
class PartPair:
    """A changed file with an unexpanded description. A comparison adds its changes.

    Attributes:
        versions: the repository before and after the change.
        old_path: the path in the old version.
        new_path: the path in the new version.
        old: the old outline.
        new: the new outline.
        is_complete: whether the file describes a complete robot, so that no other file calls its macros.
        expanded: the elements of changed files that the compared robots show.
        renamed_macros: the new names of the macros that changed files rename, by old name.
        robots: the new outlines of all files of the robots that include the file; empty if some are not known.
        defaults: the arguments that all robots of the new version which include the file declare with one default.
        find_old_macros: a function that returns the definitions of a macro in the old repository.
        find_new_macros: a function that returns the definitions of a macro in the new repository.
        find_old_calls: a function that returns the calls of a macro in the old repository.
        find_new_calls: a function that returns the paths and calls of a macro in the new repository.
        changes: the changes found so far.
    """

    versions: Versions
    old_path: str
    new_path: str
    old: Outline
    new: Outline
    is_complete: bool
    expanded: Collection[ExpandedElement]
    renamed_macros: Mapping[str, str] = field(default_factory=dict)
    robots: Sequence[Outline] = ()
    defaults: Mapping[str, str] = field(default_factory=dict)
    find_old_macros: Callable[[str], Sequence[MacroOutline]] = field(default=lambda _name: ())
    find_new_macros: Callable[[str], Sequence[MacroOutline]] = field(default=lambda _name: ())
    find_old_calls: Callable[[str], Sequence[Element]] = field(default=lambda _name: ())
    find_new_calls: Callable[[str], Iterable[tuple[str, Element]]] = field(default=lambda _name: ())
    changes: list[Change] = field(default_factory=list)

    def add(self, sentence: Phrase, old: Element | None, new: Element | None, reason: Phrase | None = None) -> None:
        """Report a change at the location of the new or else the old element.

        A change with a reason is breaking.
        """
        effect = Effect.CHANGED if reason is None else Effect.BREAKING
        self.changes.append(Change(sentence, effect, reason, self._find_location(old, new)))

    def _find_location(self, old: Element | None, new: Element | None) -> Location | None:
        element, is_old = (old, True) if new is None else (new, False)
        version = self.versions.old if is_old else self.versions.new
        span = None if element is None else element.span()
        path = None if span is None else version.relative(span.file)
        return None if span is None or path is None else Location(path, span.line, span.column, is_old)

    def is_expanded(self, element: Element | None, *, is_old: bool) -> bool:
        """Return whether the compared robots use an element of one of the versions."""
        path = self.old_path if is_old else self.new_path
        return element is not None and ExpandedElement(path, element.offset, is_old) in self.expanded

    def has_robot_with(self, tag: str, name: str) -> bool:
        """Return whether a robot of the new version that includes the file has a link or joint."""
        return any(
            element.tag == tag and element.attributes.get("name") == name
            for outline in self.robots
            for element in outline.root.elements()
        )

    def find_called_macros(self, call: Element) -> Sequence[MacroOutline]:
        """Return the macros of the old repository that an old call may name."""
        return _find_called(self.find_old_macros, call)

    def names_hardware(self, call: Element) -> bool:
        """Return whether the name in an old call of a macro of the repository is only that of a ``<ros2_control>``."""
        macros = self.find_called_macros(call)
        uses = [element for macro in macros for element in macro.element.walk() if uses_name(element, "name")]
        return bool(uses) and all(element.tag == ROS2_CONTROL for element in uses)

    def loses_parameter(self, call: Element, name: str) -> bool:
        """Return whether a call passes a parameter that its macro has only in the old repository."""
        old, new = _find_called(self.find_old_macros, call), _find_called(self.find_new_macros, call)
        return any(name in outline.parameters for outline in old) and not any(name in item.parameters for item in new)

    def is_read(self, *, is_old: bool) -> bool:
        """Return whether the expansion of a compared robot read the file in one of the versions."""
        return ExpandedElement(self.old_path if is_old else self.new_path, FILE, is_old) in self.expanded


def _find_called(find_macros: Callable[[str], Sequence[MacroOutline]], call: Element) -> Sequence[MacroOutline]:
    """Return the macros that an element may call, also with the namespace of an ``<xacro:include>``."""
    name = call.tag.removeprefix(CALL)
    return find_macros(name) or find_macros(name.rpartition(".")[2])
