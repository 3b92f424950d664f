"""Renaming of macros, parameters, properties, arguments, links, joints and materials, proved by expansions.

The edits are tried on the descriptions that include the file, with each set of arguments that their callers pass. A
macro, parameter, property or argument may be renamed if all expansions stay equal. A link, joint or material may be
renamed if the expansions differ in names alone, and every name that changes has one new name wherever it occurs.
"""

from __future__ import annotations

import ast
import keyword
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, SourceText, Span, phrase, term
from linkwright.language.definitions import NameKind
from linkwright.language.grammar import root_of
from linkwright.language.includes import real
from linkwright.language.mentions import Mention, mentions_in
from linkwright.language.occurrences import Occurrence, kinds_of_reference, kinds_of_text, occurrences_in
from linkwright.language.proof import Edit, ExpansionPair, ExpansionProof, UnprovedError
from linkwright.language.workspace import Workspace
from linkwright.sdf.worlds import SDF
from linkwright.xacro.faults import Frame, frames
from linkwright.xmltree import Element, Text
from linkwright.xmltree.positions import attribute_value_range

_OF_ROBOT = (NameKind.LINK, NameKind.JOINT, NameKind.MATERIAL)
_NAME = re.compile(r"[^\s<>&\"']+")
_ONE_NAME = re.compile(r"\$\{\s*(\w+)\s*\}")
_MOST_ROUNDS = 4
"""How often references that still have an old name are searched."""


@dataclass(frozen=True, slots=True)
class Renaming:
    """A proved renaming.

    Attributes:
        edits: the edits, in the order of files and offsets.
        names: the names of links, joints and materials that change, old name -> new name.
        unchanged: mentions of these names that are not certain to mean them; the edits leave them unchanged.
    """

    edits: tuple[Edit, ...]
    names: Mapping[str, str] = field(default_factory=dict)
    unchanged: tuple[Mention, ...] = ()


def occurrence_at(text: str, file: Path, offset: int) -> Occurrence | None:
    """Return the name at an offset that can be renamed; None if there is none."""
    if root_of(file) is SDF:  # the names of a model have scopes of their own
        return None
    found = [name for name in occurrences_in(text, file) if name.start <= offset <= name.end]
    return min(found, key=lambda name: (name.end - name.start, not name.is_definition), default=None)


def references(project: Workspace, texts: Mapping[Path, str], name: Occurrence) -> list[Occurrence]:
    """Return the places in a description that mean the same name, in all of its files.

    Args:
        project: the workspace.
        texts: the texts of the open files.
        name: the name.
    """
    found: dict[Path, list[Occurrence]] = {}
    pending = [name.file]
    is_shared = name.kind not in _OF_ROBOT  # a link of another robot with the same name is another link
    for start in pending:
        for file in project.index.related(start, texts):
            if file not in found:
                uses = occurrences_in(project.text(file, texts) or "", file)
                found[file] = [use for use in uses if _is_same(use, name)]
                if found[file] and is_shared:
                    pending.append(file)
    return [use for uses in found.values() for use in uses]


def rename(project: Workspace, texts: Mapping[Path, str], name: Occurrence, new: str) -> Renaming:
    """Return the edits that rename something.

    Args:
        project: the workspace.
        texts: the texts of the open files.
        name: the name, as `occurrence_at` returns it.
        new: the new name, as it is to be written at the place of the old one.

    Raises:
        LinkwrightError: LANG102, the new name is not valid; LANG103, it exists; LANG104, the edits cannot be proved.
    """
    _check_new_name(name, new)
    seeds = references(project, texts, name)
    if not any(seed.is_definition for seed in seeds) and name.kind not in _OF_ROBOT:
        raise _unproved(phrase("'{name}' is not defined in the files of the workspace", name=name.name), name)
    taken = next((other for other in references(project, texts, _named(name, new)) if other.is_definition), None)
    if taken is not None:
        message = phrase("{kind} '{name}' already exists", kind=term(name.kind.value), name=new)
        raise LinkwrightError(Diagnostic("LANG103", message, _span(project, texts, taken)))
    try:
        return _proved(_Proof(project, texts, name, new), seeds)
    except UnprovedError as error:
        raise _unproved(error.reason, name, error.span) from None


def _proved(proof: _Proof, seeds: Iterable[Occurrence]) -> Renaming:
    """Return the renaming with edits at the occurrences of the name, and those that follow from them."""
    name = proof.name
    proof.edits.update(Edit(seed.file, seed.start, seed.end, proof.new) for seed in seeds)
    if name.kind not in _OF_ROBOT:
        if name.kind is NameKind.ARGUMENT:
            proof.rename_argument()
        proof.check_equal()
        return Renaming(tuple(sorted(proof.edits)))
    names = proof.follow()
    return Renaming(tuple(sorted(proof.edits)), names, proof.unchanged)


def _is_same(other: Occurrence, name: Occurrence) -> bool:
    if (other.kind, other.name) != (name.kind, name.name):
        return False
    if name.kind is NameKind.PARAMETER:
        return other.owner == name.owner
    is_template = name.kind in _OF_ROBOT and "$" in name.name
    return not is_template or (other.file, other.owner) == (name.file, name.owner)


def _named(name: Occurrence, new: str) -> Occurrence:
    return Occurrence(name.kind, new, name.file, name.start, name.is_definition, name.owner)


def _check_new_name(name: Occurrence, new: str) -> None:
    is_variable = name.kind not in _OF_ROBOT
    is_valid = new.isidentifier() and not keyword.iskeyword(new) if is_variable else bool(new.strip())
    if name.kind is NameKind.MACRO or (name.kind in _OF_ROBOT and "$" not in new):
        is_valid = _NAME.fullmatch(new) is not None
    if not is_valid:
        message = phrase("'{new}' is not a valid name of a {kind}", new=new, kind=term(name.kind.value))
        hint = phrase("use letters, digits and underscores, and begin with a letter")
        raise LinkwrightError(Diagnostic("LANG102", message, hint=hint))


def _unproved(message: Phrase, name: Occurrence, span: Span | None = None) -> LinkwrightError:
    return LinkwrightError(
        Diagnostic("LANG104", phrase("'{name}' is not renamed: {why}", name=name.name, why=message), span)
    )


def _span(project: Workspace, texts: Mapping[Path, str], name: Occurrence) -> Span:
    return SourceText(str(name.file), project.text(name.file, texts) or "").span(name.start, name.end)


class _Proof:
    """Edits, and the expansions of a description with and without them.

    Attributes:
        name: the name that is renamed.
        new: its new name.
        edits: the edits so far.
        unchanged: mentions of changed names that are not certain.
    """

    def __init__(self, project: Workspace, texts: Mapping[Path, str], name: Occurrence, new: str) -> None:
        self.edits: set[Edit] = set()
        self.unchanged: tuple[Mention, ...] = ()
        self._project, self._texts, self.name, self.new = project, texts, name, new
        self._expansions = ExpansionProof(project, texts, name.file)
        self._renamed: dict[str, str] = {}

    def rename_argument(self) -> None:
        """Rename the argument in the calls of the descriptions, too.

        Raises:
            LinkwrightError: LANG104, a caller passes the argument by a name that is not written in the call.
        """
        old, new = self.name.name, self.new
        passed = re.compile(rf"(?<!\w){re.escape(old)}(?=:=)|(?<=['\"]){re.escape(old)}(?=['\"]\s*:)")
        for entry in self._expansions.entries:
            for values, span in self._project.calls(entry):
                if old not in values or span is None:
                    continue
                file = real(span.file)
                text = self._project.text(file, self._texts) or ""
                found = {Edit(file, *match.span(), new) for match in passed.finditer(text, *_call_range(text, span))}
                if not found:
                    why = phrase("a caller passes the argument, but its name is not written in the call")
                    raise _unproved(why, self.name, span)
                self.edits |= found
        self._renamed = {old: new}

    def _pairs(self) -> Iterator[ExpansionPair]:
        """Yield each description before and after the edits."""
        return self._expansions.pairs(self.edits, self._renamed)

    def check_equal(self) -> None:
        """Compare the expansions, which must be equal.

        Raises:
            UnprovedError: they differ.
        """
        self._expansions.check_equal(self.edits, self._renamed)

    def follow(self) -> dict[str, str]:
        """Extend the edits until all references have their new names, and return the names that change.

        Raises:
            LinkwrightError: LANG104, the expansions differ in more than names, or a reference cannot be edited.
        """
        for _ in range(_MOST_ROUNDS):
            names: dict[tuple[NameKind, str], str] = {}
            trees = [(pair.before, pair.after) for pair in self._pairs()]
            for before, after in trees:
                for kind, old, new in _changed_definitions(before, after, self.name):
                    if names.setdefault((kind, old), new) != new:
                        message = phrase(
                            "'{old}' would have two new names, '{first}' and '{second}'",
                            old=old,
                            first=names[kind, old],
                            second=new,
                        )
                        raise _unproved(message, self.name)
            if not names:
                raise _unproved(phrase("no link, joint or material takes its name from this place"), self.name)
            more = {edit for before, after in trees for edit in self._stale(before, after, names)}
            more |= self._elsewhere(names)
            if more <= self.edits:
                self._check_names(trees, names)
                return {old: new for (_, old), new in names.items()}
            self.edits |= more
        raise _unproved(phrase("some references keep the old name"), self.name)

    def _stale(self, before: Element, after: Element, names: Mapping[tuple[NameKind, str], str]) -> Iterator[Edit]:
        """Yield the edits for references in an expansion that still have an old name."""
        for old, new in zip(before.walk(), after.walk(), strict=False):
            for kinds, key in _references_of(new):
                value = new.attributes.get(key, "") if key else new.text().strip()
                for kind in kinds:
                    wanted = names.get((kind, value))
                    if wanted is not None and old.tag == new.tag and new.source is not None:
                        yield self._edit_of(new, key, value, wanted)
                        break

    def _edit_of(self, element: Element, key: str, value: str, wanted: str) -> Edit:
        assert element.source is not None
        # Offsets are those of the edited text: find the place by the text before the edits.
        source = element.source
        place = attribute_value_range(source.text, element.offset, key) if key else _text_range(element)
        written = "" if place is None else source.text[place[0] : place[1]]
        file = real(source.name)
        if place is not None and "$" in written and written == self.name.name:
            return self._moved_edit(file, place, self.new)
        argument = self._passed_value(element, written, value)
        if argument is not None:
            return self._moved_edit(*argument, wanted)
        if place is None or written != value:
            message = phrase("'{value}' is computed from '{written}'", value=value, written=written or element.tag)
            raise _unproved(message, self.name, element.attribute_span(key) if key else element.span())
        return self._moved_edit(file, place, wanted)

    def _passed_value(self, element: Element, written: str, value: str) -> tuple[Path, tuple[int, int]] | None:
        """Return where a call passes a value that is the whole of a text, such as ``${parent}``; None if none does."""
        parameter = _ONE_NAME.fullmatch(written)
        for frame in frames(element.origin if isinstance(element.origin, Frame) else None):
            if parameter is None:
                return None
            source = frame.site.source
            place = None if source is None else attribute_value_range(source.text, frame.site.offset, parameter[1])
            if source is None or place is None:
                continue
            given = source.text[place[0] : place[1]]
            if given == value:
                return real(source.name), place
            parameter = _ONE_NAME.fullmatch(given)
        return None

    def _moved_edit(self, file: Path, place: tuple[int, int], new: str) -> Edit:
        """Return an edit for a range of the edited text, in offsets of the text before the edits."""
        start = place[0] - self._shift(file, place[0])
        return Edit(file, start, start + place[1] - place[0], new)

    def _shift(self, file: Path, offset: int) -> int:
        """Return how far the edits before an offset of the edited text have moved it."""
        shift = 0
        for edit in sorted(edit for edit in self.edits if edit.file == file):
            if edit.start + shift < offset:
                shift += len(edit.text) - (edit.end - edit.start)
        return shift

    def _elsewhere(self, names: Mapping[tuple[NameKind, str], str]) -> set[Edit]:
        """Return the edits of the other files: SRDF, YAML, RViz configurations, launch files."""
        olds = frozenset(old for _, old in names)
        found: set[Edit] = set()
        unchanged: list[Mention] = []
        inside = {*self._project.index.related(self.name.file, self._texts)}
        for use in self._uses_in(inside, names):
            if not use.is_definition:
                found.add(Edit(use.file, use.start, use.end, names[use.kind, use.name]))
        others = {use.name for use in self._uses_in(self._project.neighbours(self.name.file, inside), names)}
        for file in self._project.configuration_files(self.name.file):
            text = self._project.text(file, self._texts) or ""
            if ".srdf" in file.name:
                uses = [use for use in occurrences_in(text, file) if (use.kind, use.name) in names]
                mentions = [Mention(use.name, file, use.start, (use.kind,)) for use in uses]
            else:
                mentions = [*mentions_in(text, file, olds)]
            for mention in mentions:
                new = next((names[kind, mention.name] for kind in mention.kinds if (kind, mention.name) in names), None)
                if new is not None and mention.name not in others and file not in self._expansions.data:
                    found.add(Edit(file, mention.start, mention.end, new))
                elif new is not None or not mention.kinds:
                    unchanged.append(mention)
        self.unchanged = tuple(unchanged)
        return found

    def _uses_in(self, files: Iterable[Path], names: Mapping[tuple[NameKind, str], str]) -> Iterator[Occurrence]:
        """Yield the literal definitions and uses of names in files, also those that no expansion reaches."""
        for file in files:
            for use in occurrences_in(self._project.text(file, self._texts) or "", file):
                if (use.kind, use.name) in names:
                    yield use

    def _check_names(self, trees: Sequence[tuple[Element, Element]], names: Mapping[tuple[NameKind, str], str]) -> None:
        """Check that the expansions differ in the names alone."""
        allowed = {*((old, new) for (_, old), new in names.items())}
        for before, after in trees:
            olds, news = _defined(before), _defined(after)
            for old, new in _differences(before, after, self.name):
                if (old, new) not in allowed or (old in olds and new not in news):
                    raise _unproved(phrase("'{old}' would become '{new}'", old=old, new=new), self.name)
            for kind in _OF_ROBOT[:2]:
                defined = [element.attributes.get("name") for element in after.elements(kind.value)]
                if len(defined) != len(set(defined)):
                    raise _unproved(phrase("two {kind}s would have the same name", kind=term(kind.value)), self.name)


def _call_range(text: str, span: Span) -> tuple[int, int]:
    """Return the offsets of a call in the text of its file; in Python, those of the lines of the whole expression."""
    source = SourceText(span.file, text)
    first, last = source.offset(span.line, 1), source.offset(span.end_line, span.end_column)
    if span.file.endswith(".py"):
        try:
            tree = ast.parse(text)
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            return first, last
        for node in ast.walk(tree):
            if isinstance(node, ast.expr) and (node.lineno, node.col_offset + 1) == (span.line, span.column):
                last = max(last, source.offset((node.end_lineno or 0) + 1, 1))
    return first, last


def _changed_definitions(before: Element, after: Element, name: Occurrence) -> Iterator[tuple[NameKind, str, str]]:
    """Yield the kind, the old and the new name of each link, joint and material whose name differs."""
    for tag, kind in (("link", NameKind.LINK), ("joint", NameKind.JOINT)):
        if len([*before.elements(tag)]) != len([*after.elements(tag)]):
            raise _unproved(phrase("the robot would have another number of {kind}s", kind=term(kind.value)), name)
        for old, new in zip(before.elements(tag), after.elements(tag), strict=True):
            yield from _changed_name(kind, old, new)
    for old, new in zip(before.walk(), after.walk(), strict=False):  # a visual may define its material
        if old.tag == new.tag == "material":
            yield from _changed_name(NameKind.MATERIAL, old, new)


def _changed_name(kind: NameKind, old: Element, new: Element) -> Iterator[tuple[NameKind, str, str]]:
    names = old.attributes.get("name", ""), new.attributes.get("name", "")
    if names[0] != names[1]:
        yield (kind, *names)


def _references_of(element: Element) -> Iterator[tuple[tuple[NameKind, ...], str]]:
    """Yield the attributes of an element (or an empty name for its text) that name something, with the kinds."""
    for key in element.attributes:
        # A joint's name is a use in a transmission; where it defines the joint, it is the new name already.
        kinds = (NameKind.JOINT,) if (element.tag, key) == ("joint", "name") else kinds_of_reference(element.tag, key)
        if kinds:
            yield kinds, key
    kinds = kinds_of_text(element.tag)
    if kinds and element.text().strip():
        yield kinds, ""


def _text_range(element: Element) -> tuple[int, int] | None:
    for child in element.children:
        if isinstance(child, Text) and child.data.strip() and child.source is element.source:
            start = child.offset + len(child.data) - len(child.data.lstrip())
            return start, start + len(child.data.strip())
    return None


def _defined(root: Element) -> set[str]:
    """Return the names of the links and joints of a robot."""
    return {element.attributes.get("name", "") for tag in ("link", "joint") for element in root.elements(tag)}


def _differences(before: Element, after: Element, name: Occurrence) -> Iterator[tuple[str, str]]:
    """Yield the attribute values and texts that differ, each before and after."""
    olds, news = [*before.walk()], [*after.walk()]
    if [old.tag for old in olds] != [new.tag for new in news]:
        raise _unproved(phrase("the robot would have other elements"), name)
    for old, new in zip(olds, news, strict=True):
        if old.attributes.keys() != new.attributes.keys():
            raise _unproved(phrase("<{tag}> would have other attributes", tag=old.tag), name)
        for key, value in old.attributes.items():
            if new.attributes[key] != value:
                yield value, new.attributes[key]
        if old.text() != new.text():
            yield old.text().strip(), new.text().strip()
