"""Make the comparison of the elements of two files or macros, with the new names of their values."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from linkwright.review.parts.elements import ItemComparison
from linkwright.review.parts.name_substitution import NameSubstitution, iterate_properties, read_literals
from linkwright.review.parts.outline import MacroOutline
from linkwright.review.parts.part_pair import PartPair
from linkwright.xmltree import Element


def make_comparison(pair: PartPair, old: MacroOutline | None = None, new: MacroOutline | None = None) -> ItemComparison:
    """Return the comparison of the elements of two files, or of two macros in them."""
    renamed = dict(_find_renamed_properties(pair))
    passed: dict[str, str] = {}
    newly_passed: dict[str, str] = {}
    literals = [read_literals(outline.root) for outline in (pair.old, pair.new)]
    if old is not None and new is not None:
        renamed |= dict(_find_renamed_parameters(old, new))
        for values, macro in zip(literals, (old, new), strict=True):
            for name in macro.parameters:
                values.pop(name.lstrip("*"), None)
        passed = dict(_find_passed_values(old, new, pair.find_old_calls(old.name), renamed))
        new_calls = [call for _, call in pair.find_new_calls(new.name)]
        newly_passed = dict(_find_passed_values(new, old, new_calls, renamed.values()))
    old_names = NameSubstitution(literals[0], renamed, pair.renamed_macros, passed)
    return ItemComparison(old_names, NameSubstitution(literals[1], passed=newly_passed))


def _find_renamed_properties(pair: PartPair) -> Iterator[tuple[str, str]]:
    """Yield the old and new names of renamed properties, which keep their values."""
    old, new = (
        {name: element.attributes.get("value") for name, element in iterate_properties(outline.root)}
        for outline in (pair.old, pair.new)
    )
    added = {name: value for name, value in new.items() if name not in old}
    for name, value in old.items():
        match = next((other for other, other_value in added.items() if other_value == value), None)
        if name not in new and match is not None:
            del added[match]
            yield name, match


def _find_renamed_parameters(old: MacroOutline, new: MacroOutline) -> Iterator[tuple[str, str]]:
    """Yield the old and new names of renamed parameters.

    The removed and added parameters must have the same defaults in the same order.
    """
    removed = [parameter for name, parameter in old.parameters.items() if name not in new.parameters]
    added = [parameter for name, parameter in new.parameters.items() if name not in old.parameters]
    if [parameter.default for parameter in removed] == [parameter.default for parameter in added]:
        for before, after in zip(removed, added, strict=True):
            yield before.name.lstrip("*"), after.name.lstrip("*")


def _find_passed_values(
    macro: MacroOutline, other: MacroOutline, calls: Collection[Element], renamed: Collection[str]
) -> Iterator[tuple[str, str]]:
    """Yield the parameters that only one version of a macro has and that all its calls pass as one value, with it."""
    for parameter in macro.parameters.values():
        if parameter.name in other.parameters or parameter.name in renamed:
            continue
        values = {call.attributes.get(parameter.name) for call in calls}
        value = values.pop() if len(values) == 1 else None
        if value is not None:
            yield parameter.name, " ".join(value.split())
