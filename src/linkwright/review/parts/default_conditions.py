"""Find parts of macros that calls lack by default, because of conditions on parameters with a default."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

from linkwright.descriptions.comparison import ROS2_CONTROL
from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.review.parts.default_values import collect_new_values
from linkwright.review.parts.elements import CONDITION_SEPARATOR, PartDifference
from linkwright.review.parts.known_values import collect_values, evaluate_condition, is_left_out
from linkwright.review.parts.name_substitution import CALL
from linkwright.review.parts.outline import PROPERTY, Item, MacroOutline, iterate_items
from linkwright.review.parts.part_pair import PartPair
from linkwright.xmltree import Element

_WORD = re.compile(r"[A-Za-z_]\w*")
_HARDWARE, _PLUGIN = "hardware", "plugin"


def find_missing_part_reason(pair: PartPair, macro: str | None, difference: PartDifference) -> Phrase | None:
    """Return why further conditions of a part of a macro are breaking: calls lack it by default; None if they do not.

    Args:
        pair: both versions of the file.
        macro: the new name of the macro; None outside of macros.
        difference: the difference between the conditions.
    """
    outline = pair.new.macros.get(macro or "")
    if outline is None:
        return None
    if _is_hardware_plugin(difference.path):
        return find_missing_plugin_reason(pair, macro, difference)
    old = (difference.old or "").split(CONDITION_SEPARATOR)
    added = [text for text in (difference.new or "").split(CONDITION_SEPARATOR) if text not in old]
    values = collect_new_values(pair, macro)
    names = _find_parameters([text for text in added if evaluate_condition(text, values) is False], outline)
    if not names or _has_part(outline.element, difference.path, values):
        return None
    return phrase("calls that do not pass {names} lack the part", names=quoted_names(names))


def find_missing_plugin_reason(pair: PartPair, macro: str | None, difference: PartDifference) -> Phrase | None:
    """Return why hardware in a macro that loses a plugin is breaking: it has none by default; None if it has one.

    Args:
        pair: both versions of the file.
        macro: the new name of the macro; None outside of macros.
        difference: the difference between both versions.
    """
    path, new, old = difference.path, pair.new.macros.get(macro or ""), pair.old.macros.get(macro or "")
    if new is None or old is None or not _is_hardware_plugin(path):
        return None
    if difference.new_element is not None and difference.value != "conditions":
        return None
    (*hardware,) = _find_items(new.element, path[:-1])
    if not hardware or any(_may_call_macro(item.element) for item in hardware):
        return None
    old_values = collect_values(pair.defaults, (pair.old,), old)
    if not _has_part(old.element, path, old_values) or _has_part(new.element, path, collect_new_values(pair, macro)):
        return None
    conditions = [text for item in _find_items(new.element, path) for text in item.conditions]
    names = _find_parameters(conditions, new)
    if not names:
        return phrase("the controller manager refuses hardware without a plugin")
    return phrase(
        "the controller manager refuses the hardware of calls that pass none of {names}", names=quoted_names(names)
    )


def _is_hardware_plugin(path: tuple[str, ...]) -> bool:
    return len(path) == 3 and path[0].startswith(ROS2_CONTROL) and path[1:] == (_HARDWARE, _PLUGIN)


def _has_part(root: Element, path: Sequence[str], values: Mapping[str, str]) -> bool:
    """Return whether an element may have a part at a path."""
    return any(not is_left_out(item, values) for item in _find_items(root, path))


def _find_items(root: Element, path: Sequence[str], conditions: tuple[str, ...] = ()) -> Iterator[Item]:
    """Yield the elements at a path of keys, each with all conditions around it."""
    for item in iterate_items(root, conditions):
        if item.key != path[0]:
            continue
        if len(path) == 1:
            yield item
        else:
            yield from _find_items(item.element, path[1:], item.conditions)


def _may_call_macro(element: Element) -> bool:
    """Return whether a macro or a block of the caller may add elements to an element."""
    return any(item.element.tag.startswith(CALL) and item.element.tag != PROPERTY for item in iterate_items(element))


def _find_parameters(conditions: Iterable[str], macro: MacroOutline) -> list[str]:
    """Return the parameters of a macro that conditions use."""
    words = {word for text in conditions for word in _WORD.findall(text)}
    return [name for name in macro.parameters if name in words]
