"""Decide which lost values of a launch file are breaking only for callers that pass an argument."""

from __future__ import annotations

import re

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.outlines import (
    CONDITION,
    NAMESPACE,
    NAMESPACE_OF_INCLUDED,
    SERVER_PARAMETER,
    Entry,
    LaunchOutline,
)
from linkwright.review.launches.static_transforms import find_child_frame

_USED_ARGUMENT = re.compile(r"\$\((?:var|arg) ([\w./-]+)")
_SWITCHED_NAMESPACE = re.compile(r"(?P<name>.+) \((?P<condition>(?:if|unless) .+)\)")
_FRAME_PREFIX = re.compile(r"(?:parameter )?(?:.*/)?(?:tf|frame)_prefix")
_FRAME_PARAMETER = re.compile(r"parameter \w+_frame(_id)?")
_PREFIXED = re.compile(r"\$\((?:var|arg) [\w.-]+\)/?\w[\w/]*")
"""A frame with a prefix that an argument gives."""
_MIN_FRAMES = 3
"""The minimum number of parameters with frames of a node that probably publishes them."""


def make_frames_reason(name: str) -> Phrase:
    """Return the reason why frames that no longer depend on an argument are breaking."""
    return phrase("for callers that pass '{name}', programs do not find the frames by their old names", name=name)


def explain_lost_frames(
    entry: Entry, setting: str, old: str | None, new: str | None, outline: LaunchOutline
) -> Phrase | None:
    """Return the reason why another value is breaking that is the same by default, or None if it is not.

    Args:
        entry: the action.
        setting: the name of the setting.
        old: the old value as it is written; None if there was none.
        new: the new value as it is written; None if there is none.
        outline: the actions of the old version.
    """
    old_frames, new_frames = (_find_frames(entry, setting, text or "") for text in (old, new))
    kept = _USED_ARGUMENT.findall(new_frames)
    arguments = {other.name for other in outline.entries if other.kind == "argument" and "value" not in other.settings}
    lost = [name for name in _USED_ARGUMENT.findall(old_frames) if name in arguments and name not in kept]
    if not lost:
        return None
    return make_frames_reason(lost[0])


def explain_enabled_namespace(setting: str, old: str | None, new: str | None, outline: LaunchOutline) -> Phrase | None:
    """Return the reason why a namespace is breaking that an argument switched off by default before, or None.

    Args:
        setting: the name of the setting.
        old: the old value as it is written; None if there was none.
        new: the new value as it is written; None if there is none.
        outline: the actions of the old version.
    """
    switched = _SWITCHED_NAMESPACE.fullmatch(old or "") if setting in (NAMESPACE, NAMESPACE_OF_INCLUDED) else None
    if switched is None or switched["name"] != new or evaluate_condition(outline.resolve(switched["condition"])):
        return None
    names = _USED_ARGUMENT.findall(switched["name"])
    if not names:
        return None
    return phrase("callers that pass '{name}' find the node, its topics and its services in a namespace", name=names[0])


def explain_lost_value(entry: Entry, old: LaunchOutline, new: LaunchOutline) -> Phrase | None:
    """Return the reason why removing a value is breaking, or None if it is not.

    Args:
        entry: the removed action, such as an argument with a value under a condition, or a prefix of frames.
        old: the actions of the old version.
        new: the actions of the new version.
    """
    if entry.kind == SERVER_PARAMETER and _FRAME_PREFIX.fullmatch(entry.name):
        value = entry.settings.get("value", "")
        if old.resolve(value):
            return phrase("programs that look up the frames by their old names do not find them")
        return explain_lost_frames(entry, entry.name, value, None, old)
    condition = entry.settings.get(CONDITION)
    left = [other for other in new.entries if (other.kind, other.name) == (entry.kind, entry.name)]
    conditions = {other.settings.get(CONDITION) for other in left}
    if entry.kind != "argument" or not condition or not left or None in conditions or condition in conditions:
        return None
    if len(left) > 1 or not _is_used(entry.name, conditions, new):
        return None
    return phrase("the launch file uses '{name}' and fails {condition}", name=entry.name, condition=condition)


def _is_used(name: str, conditions: set[str | None], outline: LaunchOutline) -> bool:
    """Return whether an action uses an argument under other conditions than those under which it has a value."""
    return any(
        name in _USED_ARGUMENT.findall(text) and entry.settings.get(CONDITION) not in conditions
        for entry in outline.entries
        for text in (entry.name, *entry.settings.values())
    )


def _find_frames(entry: Entry, setting: str, text: str) -> str:
    """Return the frame, or the prefix of frames, in a value; empty for other settings."""
    if _FRAME_PREFIX.fullmatch(setting):
        return text
    if _FRAME_PARAMETER.fullmatch(setting) and _PREFIXED.fullmatch(text):
        frames = [name for name in entry.settings if _FRAME_PARAMETER.fullmatch(name)]
        return text if len(frames) >= _MIN_FRAMES else ""
    return find_child_frame(entry.name, text) if setting == "arguments" else ""
