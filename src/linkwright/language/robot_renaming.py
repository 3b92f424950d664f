"""Rename links, joints and materials, with the edits that follow from it.

The edits are extended until all definitions and references have their new names. Then the expansions may differ only in
these names.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import islice, pairwise
from pathlib import Path

from linkwright.diagnostics import Phrase, Span, phrase, quoted_names, term
from linkwright.language.definitions import NameKind
from linkwright.language.mentions import Mention
from linkwright.language.name_sources import NameSources, SourceValue, rename_in_template, source_value
from linkwright.language.occurrences import Occurrence, kinds_of_reference, kinds_of_text
from linkwright.language.other_files import OtherFiles
from linkwright.language.proof import Edit, ExpansionPair, ExpansionProof, UnprovedError
from linkwright.language.workspace import Workspace
from linkwright.xmltree import Element
from linkwright.xmltree.positions import attribute_value_range, find_start_tag_end
from linkwright.xmltree.tokens import Kind, tokens

ROBOT_NAME_KINDS = (NameKind.LINK, NameKind.JOINT, NameKind.MATERIAL)
Names = Mapping[tuple[NameKind, str], str]

_MAX_ROUNDS = 8
"""The maximum number of searches for references with an old name."""
_MAX_PROPOSALS = 6
"""The maximum number of edits that are tried for a computed name."""


class RobotRenaming:
    """The edits for a new name of a link, joint or material.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        name: an occurrence of the name.
        new: its new name.
        proof: the expansions of the descriptions that contain the name.

    Attributes:
        edits: the edits that were found.
        names: the names that change.
        unchanged: uncertain mentions of changed names.
    """

    def __init__(
        self, workspace: Workspace, texts: Mapping[Path, str], name: Occurrence, new: str, proof: ExpansionProof
    ) -> None:
        self.edits: set[Edit] = set()
        self.names: dict[tuple[NameKind, str], str] = {}
        self.unchanged: tuple[Mention, ...] = ()
        self._project, self._texts, self._name, self._new = workspace, texts, name, new
        self._proof = proof
        self._files = workspace.index.related_files(name.file, texts, computed=True)
        self._sources = NameSources(workspace, texts, self._files)
        self._others = OtherFiles(workspace, texts, name.file, proof)

    def run(self, seeds: Iterable[Occurrence]) -> None:
        """Find all edits that follow from the edits of certain occurrences.

        Args:
            seeds: the certain occurrences.

        Raises:
            UnprovedError: the expansions differ in more than names, or a reference cannot be edited.
        """
        self._others.add_srdfs()
        required = self._map_required_names()
        if not any(self._defines(*name) for name in required):
            self._rename_unused(seeds, required)
            return
        literal = {Edit(seed.file, seed.start, seed.end, self._new) for seed in seeds}
        error: UnprovedError | None = None
        for proposal in islice(self._generate_proposals(required, literal), _MAX_PROPOSALS):
            try:
                self._extend(proposal, required)
            except UnprovedError as reason:  # noqa: PERF203 - each proposal may fail for itself
                error = error or reason
            else:
                return
        raise error or UnprovedError(self._no_name_reason())

    def _rename_unused(self, seeds: Iterable[Occurrence], required: Names) -> None:
        """Rename a name that no expansion contains, such as an unused material."""
        name = self._name
        edits = {Edit(seed.file, seed.start, seed.end, self._new) for seed in seeds}
        if "$" in name.name or not any(seed.is_definition for seed in seeds):
            raise UnprovedError(self._no_name_reason())
        self._proof.check_equal(edits)
        other_edits, self.unchanged = self._others.edits(required)
        self.edits = edits | other_edits

    def _no_name_reason(self) -> Phrase:
        reason = self._proof.gap_reason
        message = phrase("no link, joint or material takes its name from this position")
        return (
            message
            if reason is None
            else phrase("{nothing}, as far as it can be expanded: {reason}", nothing=message, reason=reason)
        )

    def _map_required_names(self) -> Names:
        """Return the values of the name in the expansions, each with its new value."""
        name = self._name
        if "$" not in name.name:
            return {(self._find_kind(), name.name): self._new}
        required: dict[tuple[NameKind, str], str] = {}
        for value in self._list_expanded_names():
            new = rename_in_template(name.name, self._new, value)
            if new is not None and new != value and self._defines(name.kind, value):
                required[name.kind, value] = new
        return required

    def _find_kind(self) -> NameKind:
        """Return the kind of a literal name: of its definition, or else of its occurrence."""
        name = self._name
        for kind in (name.kind, *ROBOT_NAME_KINDS[:2]):
            if self._defines(kind, name.name):
                return kind
        return name.kind

    def _defines(self, kind: NameKind, value: str) -> bool:
        return any(
            value == element.attributes.get("name")
            for trial in self._proof.trials
            for element in _find_definitions(trial.expansion.document.root, kind)
        )

    def _list_expanded_names(self) -> Iterator[str]:
        """Yield the values of the name in the expansions."""
        files = self._proof.names_of(self._name.file)
        for trial in self._proof.trials:
            for element in trial.expansion.document.root.walk():
                source = element.source
                if source is None or source.name not in files:
                    continue
                if (
                    element.offset > self._name.start
                    or find_start_tag_end(source.text, element.offset) <= self._name.start
                ):
                    continue
                for key, value in element.attributes.items():
                    value_range = attribute_value_range(source.text, element.offset, key)
                    if value_range is not None and value_range[0] == self._name.start:
                        yield value

    def _generate_proposals(self, required: Names, literal: set[Edit]) -> Iterator[set[Edit]]:
        """Yield the sets of initial edits to try.

        Each consists of the certain occurrences and one way to edit a computed definition.
        """
        computed: list[tuple[SourceValue, str, str]] = []
        for kind, value in required:
            for trial in self._proof.trials:
                for element in _find_definitions(trial.expansion.document.root, kind):
                    if element.attributes.get("name") != value:
                        continue
                    source = source_value(element, "name")
                    if source is not None and not any(
                        (edit.file, edit.start) == (source.file, source.start) for edit in literal
                    ):
                        computed.append((source, value, required[kind, value]))
        if not computed:
            if literal:
                yield literal
            return
        first = [*islice(self._sources.edits(*computed[0]), _MAX_PROPOSALS)]
        if not first:
            raise _computed_name_error(computed[0][0], computed[0][1])
        for edits in first:
            yield literal | {*edits}

    def _extend(self, edits: set[Edit], required: Names) -> None:
        """Extend edits until all names have changed."""
        for _ in range(_MAX_ROUNDS):
            pairs = [*self._proof.pairs(edits)]
            names = dict(_find_changed_names(pairs))
            if not names and not required:
                raise UnprovedError(self._no_name_reason())
            new_names = {**names, **required}
            new_edits: set[Edit] = set()
            for pair in pairs:
                new_edits |= {*self._edits_of_old_names(pair, new_names, edits)}
            other_edits, unchanged = self._others.edits(new_names)
            new_edits |= other_edits
            if new_edits <= edits:
                self._check(pairs, names, required)
                self.edits, self.names = edits, names
                self.unchanged = (*unchanged, *self._find_unused_mentions(edits, names))
                return
            edits = edits | new_edits
            _check_overlap(edits)
        raise UnprovedError(phrase("some references would keep the old name"))

    def _find_unused_mentions(self, edits: Collection[Edit], names: Names) -> Iterator[Mention]:
        """Yield unused values with an old name in the descriptions, such as unused defaults."""
        edited = {(edit.file, edit.start) for edit in edits}
        words = "|".join(re.escape(old) for old in dict.fromkeys(old for _, old in names))
        pattern = re.compile(rf"(?<![^\s\"'=])({words})(?=[\"'\s])" if words else r"(?!)")
        for file in self._files:
            for token in tokens(self._project.text(file, self._texts) or ""):
                if not token.name.startswith("xacro:") or token.kind is not Kind.START:
                    continue
                for attribute in token.attributes():
                    value_text = f'{attribute.value or ""}"' if attribute.name != "name" else ""
                    for match in pattern.finditer(value_text):
                        start = attribute.value_start + match.start(1)
                        if (file, start) not in edited:
                            yield Mention(match[1], file, start)

    def _edits_of_old_names(self, pair: ExpansionPair, names: Names, edits: Collection[Edit]) -> Iterator[Edit]:
        """Yield edits of the definitions and references that still have an old name."""
        for old, new in zip(pair.before.walk(), pair.after.walk(), strict=False):
            if old.tag != new.tag:
                raise UnprovedError(phrase("the elements of the robot would change"))
            for kinds, key in _find_names(old, is_top=_is_definition(pair.before, old)):
                old_value = old.attributes.get(key, "") if key else old.text().strip()
                new_value = new.attributes.get(key, "") if key else new.text().strip()
                new_name = next((names[kind, old_value] for kind in kinds if (kind, old_value) in names), None)
                if new_name is None or new_value != old_value or new_name == old_value:
                    continue
                source = source_value(old, key)
                if source is None:
                    continue
                proposal = next(self._sources.edits(source, old_value, new_name), None)
                if proposal is None:
                    raise _computed_name_error(source, old_value, old.attribute_span(key) if key else old.span())
                if {*proposal} <= {*edits}:  # The edits did not change the value.
                    raise _computed_name_error(source, old_value, old.attribute_span(key) if key else old.span())
                yield from proposal

    def _check(self, pairs: Sequence[ExpansionPair], names: Names, required: Names) -> None:
        """Check that the expansions differ only in the names."""
        missing = next((old for (kind, old), new in required.items() if names.get((kind, old)) != new), None)
        if missing is not None:
            raise UnprovedError(phrase("'{name}' is not defined in the expansion of a description", name=missing))
        if "$" not in self._name.name:
            self._check_sharing(pairs, required)
        allowed = {*((old, new) for (_, old), new in names.items())}
        for pair in pairs:
            old_names, new_names = _list_part_names(pair.before), _list_part_names(pair.after)
            for key, old, new in _find_differences(pair.before, pair.after):
                is_name = (old, new) in allowed and (old not in old_names or new in new_names)
                if not is_name and not (key == "name" and _is_derived(old, new, allowed)):
                    raise UnprovedError(phrase("'{old}' would become '{new}'", old=old, new=new))
            for kind in ROBOT_NAME_KINDS[:2]:
                count = len({*_list_names(pair.after, kind)})
                if count != len([*_list_names(pair.after, kind)]) and count != len({*_list_names(pair.before, kind)}):
                    raise UnprovedError(phrase("two {kind}s would have the same name", kind=term(kind.value)))

    def _check_sharing(self, pairs: Sequence[ExpansionPair], required: Names) -> None:
        """Check that no description without the name changes, as another robot may share macros."""
        owners = {
            pair.entry
            for pair in pairs
            for kind, old in required
            for value in _list_names(pair.before, kind)
            if value == old
        }
        for pair in pairs:
            changed = next(_find_changed_names([pair]), None) if pair.entry not in owners else None
            if changed is not None:
                (_, old), new = changed
                message = phrase(
                    "'{old}' of '{file}', which uses the same macro, would become '{new}'",
                    old=old,
                    new=new,
                    file=pair.entry.name,
                )
                raise UnprovedError(message)


def _computed_name_error(source: SourceValue, value: str, span: Span | None = None) -> UnprovedError:
    return UnprovedError(phrase("'{value}' is computed from '{expression}'", value=value, expression=source.text), span)


def _check_overlap(edits: Iterable[Edit]) -> None:
    """Raise an error for two edits of the same text."""
    ordered = sorted(edits)
    for first, second in pairwise(ordered):
        if first.file == second.file and first.end > second.start:
            raise UnprovedError(
                phrase(
                    "the same text would need several new names: {names}",
                    names=quoted_names((first.text, second.text), " and "),
                )
            )


def _find_definitions(root: Element, kind: NameKind) -> Iterator[Element]:
    """Yield the elements that define names: links and joints of the robot, or all materials."""
    if kind is NameKind.MATERIAL:
        yield from (element for element in root.walk() if element.tag == "material")
    elif root.tag == "robot":
        yield from root.elements(kind.value)


def _is_definition(root: Element, element: Element) -> bool:
    return element.tag in ("link", "joint") and any(child is element for child in root.children)


def _list_names(root: Element, kind: NameKind) -> Iterator[str]:
    return (element.attributes.get("name", "") for element in _find_definitions(root, kind))


def _find_changed_names(pairs: Iterable[ExpansionPair]) -> Iterator[tuple[tuple[NameKind, str], str]]:
    """Yield the changed names, each once with its single new name."""
    names: dict[tuple[NameKind, str], str] = {}
    for pair in pairs:
        for kind in ROBOT_NAME_KINDS:
            old_values, new_values = [*_list_names(pair.before, kind)], [*_list_names(pair.after, kind)]
            if len(old_values) != len(new_values):
                raise UnprovedError(phrase("the number of {kind}s would change", kind=term(kind.value)))
            for old, new in zip(old_values, new_values, strict=True):
                if old == new:
                    continue
                first = names.setdefault((kind, old), new)
                if first != new:
                    message = phrase(
                        "'{old}' would have two new names, '{first}' and '{second}'", old=old, first=first, second=new
                    )
                    raise UnprovedError(message)
    yield from names.items()


def _find_names(element: Element, *, is_top: bool) -> Iterator[tuple[tuple[NameKind, ...], str]]:
    """Yield the kinds of each name in an element, and its attribute, or empty for the text."""
    for key in element.attributes:
        if key == "name" and element.tag in ("link", "joint"):
            yield (NameKind.LINK if element.tag == "link" else NameKind.JOINT,), key
        else:
            kinds = kinds_of_reference(element.tag, key)
            if kinds:
                yield kinds, key
    kinds = kinds_of_text(element.tag)
    if kinds and not is_top and element.text().strip():
        yield kinds, ""


def _list_part_names(root: Element) -> set[str]:
    """Return the names of the links and joints of a robot."""
    return {value for kind in ROBOT_NAME_KINDS[:2] for value in _list_names(root, kind)}


def _is_derived(old: str, new: str, allowed: Collection[tuple[str, str]]) -> bool:
    """Return whether a name changed only because it contains the name of a joint or link.

    An example is the name of a transmission.
    """
    return any(name in old and old.replace(name, changed) == new for name, changed in allowed)


def _find_differences(before: Element, after: Element) -> Iterator[tuple[str, str, str]]:
    """Yield the attribute (empty for a text) and both values of each difference."""
    old_elements, new_elements = [*before.walk()], [*after.walk()]
    if [old.tag for old in old_elements] != [new.tag for new in new_elements]:
        raise UnprovedError(phrase("the elements of the robot would change"))
    for old, new in zip(old_elements, new_elements, strict=True):
        if old.attributes.keys() != new.attributes.keys():
            raise UnprovedError(phrase("the attributes of <{tag}> would change", tag=old.tag))
        for key, value in old.attributes.items():
            if new.attributes[key] != value:
                yield key, value, new.attributes[key]
        if old.text() != new.text():
            yield "", old.text().strip(), new.text().strip()
