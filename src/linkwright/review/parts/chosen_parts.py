"""Find the parts of a description that conditions on an argument choose."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass

from linkwright.diagnostics import Phrase, joined, phrase
from linkwright.review.parts.name_substitution import iterate_properties
from linkwright.review.parts.outline import Outline, iterate_items

_CONDITION = re.compile(
    r"(?P<word>if|unless) (?:\$\{\s*(?P<negation>not\s+)?(?P<variable>\w+)\s*"
    r"(?:(?P<operator>==|!=)\s*(?P<quote>['\"])(?P<literal>[^'\"]*)(?P=quote)\s*)?\}"
    r"|\$\(arg\s+(?P<argument>\w+)\s*\))"
)
"""A condition on one property or argument: its truth, or a comparison with a text."""
_REVERSED = re.compile(r"\$\{\s*(?P<literal>'[^']*'|\"[^\"]*\")\s*(?P<operator>==|!=)\s*(?P<variable>\w+)\s*\}")
"""A comparison of a text with a property."""
_TRUTHS = {"true": True, "1": True, "false": False, "0": False}


@dataclass(frozen=True)
class ChosenParts:
    """The parts that the default of an argument chooses in two versions of a file.

    Attributes:
        removed: the keys of the parts that only the old default chooses.
        added: the keys of the parts that only the new default chooses.
    """

    removed: Sequence[str]
    added: Sequence[str]

    def describe(self, change: Phrase) -> Phrase:
        """Return the sentence about the default with its effect."""
        removed, added = joined(self.removed), joined(self.added)
        if self.removed and self.added:
            return phrase("{change}; {added} instead of {removed}", change=change, added=added, removed=removed)
        if self.removed:
            return phrase("{change}; without {removed}", change=change, removed=removed)
        return phrase("{change}; with {added}", change=change, added=added) if self.added else change


def compare_chosen_parts(old: Outline, new: Outline, argument: str, defaults: tuple[str, str]) -> ChosenParts:
    """Return the parts that an old and a new default of an argument choose.

    Args:
        old: the old outline of the file.
        new: the new outline.
        argument: the name of the argument.
        defaults: the old and the new default.
    """
    old_parts, new_parts = (
        dict.fromkeys(_list_chosen(outline, argument, value))
        for outline, value in zip((old, new), defaults, strict=True)
    )
    return ChosenParts(
        [part for part in old_parts if part not in new_parts], [part for part in new_parts if part not in old_parts]
    )


def _list_chosen(outline: Outline, argument: str, value: str) -> Iterator[str]:
    """Yield the keys of the parts under conditions on an argument that hold with a value."""
    names = _find_properties(outline, argument)
    for element in (outline.root, *(macro.element for macro in outline.macros.values())):
        for item in iterate_items(element):
            truths = [_evaluate(condition, argument, names, value) for condition in item.conditions]
            if True in truths and False not in truths:
                yield item.key


def _find_properties(outline: Outline, argument: str) -> set[str]:
    """Return the names of the properties whose value is an argument."""
    written = re.compile(rf"\$\(arg\s+{re.escape(argument)}\s*\)")
    return {
        name
        for name, element in iterate_properties(outline.root)
        if written.fullmatch(element.attributes.get("value", "").strip())
    }


def find_left_out_reason(outline: Outline, conditions: Iterable[str]) -> Phrase | None:
    """Return why further conditions of a part are breaking: the default of an argument leaves the part out.

    Args:
        outline: the outline of the new version of the file.
        conditions: the conditions that only the new version has.
    """
    conditions = list(conditions)
    for name, element in outline.arguments.items():
        default, properties = element.attributes.get("default"), _find_properties(outline, name)
        if default is not None and any(_evaluate(each, name, properties, default) is False for each in conditions):
            return phrase("robots of callers that do not pass '{name}' lack the part", name=name)
    return None


def _evaluate(condition: str, argument: str, properties: Collection[str], value: str) -> bool | None:
    """Return whether a condition holds with the value of an argument; None if it depends on something else."""
    match = _CONDITION.fullmatch(_REVERSED.sub(r"${\g<variable> \g<operator> \g<literal>}", condition))
    if match is None or not (match["argument"] == argument or match["variable"] in properties):
        return None
    if match["operator"]:
        is_true: bool | None = (value == match["literal"]) == (match["operator"] == "==")
    else:
        is_true = _TRUTHS.get(value.strip().lower())
    if is_true is None:
        return None
    return is_true ^ bool(match["negation"]) ^ (match["word"] == "unless")


def find_lost_choice_reason(old: str, new: str) -> Phrase | None:
    """Return why changed conditions of a part are breaking: a value that chose the part no longer does.

    Args:
        old: the old condition, such as ``if ${wheel == 'track'}``.
        new: the new condition.
    """
    old_match, new_match = _CONDITION.fullmatch(old), _CONDITION.fullmatch(new)
    if old_match is None or new_match is None or old_match["operator"] is None:
        return None
    same = ("word", "negation", "variable", "operator")
    is_equality = old_match["operator"] == "==" and old_match["word"] == "if" and not old_match["negation"]
    if not is_equality or any(old_match[group] != new_match[group] for group in same):
        return None
    return phrase(
        "callers for which {name} is '{value}' do not get the part",
        name=old_match["variable"],
        value=old_match["literal"],
    )
