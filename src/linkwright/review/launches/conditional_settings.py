"""Compare the settings of an action, also conditional ones: ``<remap if="...">``."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.expressions import are_equal_expressions
from linkwright.review.launches.outlines import PARAMETER, Entry, LaunchOutline, extract_condition, without_condition

_INLINE_DEFAULT = re.compile(r"(\$\((?:var|arg) [^() ]+) [^()]*\)")
"""An argument of a launch file with its default."""
_INLINE_NAME = re.compile(r"\$\((?:var|arg) ([^() ]+) [^()]*\)")
"""The name of such an argument."""
_ROS1_SUBSTITUTION = re.compile(r"\$\((?P<kind>find|arg) ")
_ROS2_SUBSTITUTIONS = {"find": "$(find-pkg-share ", "arg": "$(var "}
_BOOLEAN_VALUE = re.compile(r"[Tt]rue|[Ff]alse")
_BOOLEAN = re.compile(r"\b(True|False)\b")


@dataclass(frozen=True)
class SettingPair:
    """A setting whose value or condition differs.

    Attributes:
        name: the name of the setting.
        old: the old value; None if there was none.
        new: the new value; None if there is none.
        old_default: the old value with the defaults of the arguments; None if there was none.
        new_default: the new value with the defaults of the arguments; None if there is none.
        has_defaults: whether both of these values are known.
    """

    name: str
    old: str | None
    new: str | None
    old_default: str | None
    new_default: str | None
    has_defaults: bool = True


def find_changed_settings(
    old: Entry, new: Entry, old_outline: LaunchOutline, new_outline: LaunchOutline
) -> Iterator[SettingPair]:
    """Yield the settings of an action that differ.

    A setting whose conditions change is yielded once, with all its values.
    """
    old_groups, new_groups = _group_by_name(old.settings), _group_by_name(new.settings)
    for name in dict.fromkeys([*new_groups, *old_groups]):
        old_values, new_values = old_groups.get(name, {}), new_groups.get(name, {})
        has_conditions = any(map(extract_condition, (*old_values, *new_values)))
        if old_values.keys() == new_values.keys() or not has_conditions:
            for key in dict.fromkeys([*new_values, *old_values]):
                before, after = old_values.get(key), new_values.get(key)
                is_same = are_equal_expressions(before, after) or keeps_meaning(before, after, old_outline, new_outline)
                is_same = is_same or (key.startswith(PARAMETER) and _are_equal_booleans(before, after))
                if before != after and not is_same:
                    yield SettingPair(key, before, after, before, after)
            continue
        old_default, is_old_known = _find_default_value(old_values, old_outline)
        new_default, is_new_known = _find_default_value(new_values, new_outline)
        texts = _format_values(old_values), _format_values(new_values)
        yield SettingPair(name, *texts, old_default, new_default, has_defaults=is_old_known and is_new_known)


def keeps_meaning(old: str | None, new: str | None, old_outline: LaunchOutline, new_outline: LaunchOutline) -> bool:
    """Return whether two values only differ in notation.

    The defaults of their arguments may be written elsewhere. In a file of ROS 1 and one of ROS 2, the folder of a
    package and booleans are written otherwise.
    """
    if old is None or new is None:
        return False
    if old_outline.is_ros1 != new_outline.is_ros1:
        old, new = (_write_for_ros2(text) for text in (old, new))
    if _INLINE_DEFAULT.sub(r"\1)", old) != _INLINE_DEFAULT.sub(r"\1)", new):
        return False
    declared = [{entry.name for entry in outline.entries if entry.has_value} for outline in (old_outline, new_outline)]
    if old != new and all(declared[0] & declared[1] >= set(_INLINE_NAME.findall(text)) for text in (old, new)):
        return True  # another default of an argument is a change to the argument
    texts = (outline.resolve(text) for outline, text in ((old_outline, old), (new_outline, new)))
    before, after = (_BOOLEAN.sub(lambda match: match[0].lower(), text) for text in texts)
    return before == after


def _are_equal_booleans(old: str | None, new: str | None) -> bool:
    return all(text is not None and _BOOLEAN_VALUE.fullmatch(text) for text in (old, new)) and (
        (old or "").lower() == (new or "").lower()
    )


def _write_for_ros2(text: str) -> str:
    text = _ROS1_SUBSTITUTION.sub(lambda match: _ROS2_SUBSTITUTIONS[match["kind"]], text)
    return _BOOLEAN.sub(lambda match: match[0].lower(), text)


def _group_by_name(settings: Mapping[str, str]) -> dict[str, dict[str, str]]:
    groups: dict[str, dict[str, str]] = {}
    for name, value in settings.items():
        groups.setdefault(without_condition(name), {})[name] = value
    return groups


def _format_values(values: Mapping[str, str]) -> str | None:
    """Return the values of a setting with their conditions as text, or None if there are none."""
    texts = [
        f"{value} ({condition})" if (condition := extract_condition(name)) else value for name, value in values.items()
    ]
    return ", ".join(texts) if texts else None


def _find_default_value(values: Mapping[str, str], outline: LaunchOutline) -> tuple[str | None, bool]:
    """Return the value with the defaults of the arguments, and whether it is known."""
    result = None
    for name, value in values.items():
        holds = evaluate_condition(outline.resolve(extract_condition(name)))
        if holds is None:
            return None, False
        result = value if holds else result
    return result, True
