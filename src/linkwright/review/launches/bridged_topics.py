"""Find the topics that bridges between Gazebo and ROS publish."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.diagnostics import Phrase
from linkwright.review.breaking import names_reason
from linkwright.review.files.parameters.bridges import TRANSFORM_TOPICS, explain_lost_topic
from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.outlines import CONDITION, REMAPPING, Entry, LaunchOutline, without_condition
from linkwright.review.texts.list_changes import list_items

_BRIDGE = re.compile(r"ros_(gz|ign)_bridge/parameter_bridge")
_BRIDGED_TOPIC = re.compile(r"(?P<topic>[\w/]+)@[\w/.]+[\[@]")
"""A topic that a bridge publishes. One that it only sends to Gazebo has a closing bracket."""
_CONFIGURATION = "config_file"
"""The parameter of a bridge with a file that lists topics."""


def find_bridged_topics(entry: Entry, outline: LaunchOutline, *, is_remapped: bool = True) -> list[str]:
    """Return the topics of ROS that a bridge publishes, without the first slash; none for other actions.

    Args:
        entry: the action.
        outline: the actions of its file, with the defaults of arguments.
        is_remapped: whether the topics have the names that remappings give to them.
    """
    if _BRIDGE.fullmatch(entry.name) is None:
        return []
    new_names = {
        outline.resolve(without_condition(setting).removeprefix(REMAPPING)).strip("/"): outline.resolve(value)
        for setting, value in entry.settings.items()
        if setting.startswith(REMAPPING) and is_remapped
    }
    topics = [match["topic"] for match in _BRIDGED_TOPIC.finditer(outline.resolve(entry.settings.get("arguments", "")))]
    return [new_names.get(topic.strip("/"), topic).strip("/") for topic in topics]


def explain_lost_topics(entry: Entry, old: LaunchOutline, new: LaunchOutline) -> tuple[bool, Phrase | None]:
    """Return whether the topics of a removed bridge are known, and the reason why removing it is breaking.

    Other bridges and nodes of the new file may have the topics, and so may a file that it newly includes.

    Args:
        entry: the removed action.
        old: the actions of the old file.
        new: the actions of the new file.
    """
    topics = find_bridged_topics(entry, old)
    old_includes = {other.name for other in old.entries if other.kind == "include"}
    has_new_include = any(other.kind == "include" and other.name not in old_includes for other in new.entries)
    if not topics or has_new_include or any(map(_has_configuration, new.entries)):
        return False, None
    if evaluate_condition(old.resolve(entry.settings.get(CONDITION, ""))) is not True:
        return False, None
    words = set(_find_words(new))
    lost = [topic for topic in dict.fromkeys(topics) if topic not in words]
    names = [f"/{topic}" for topic in lost if topic not in TRANSFORM_TOPICS]
    if lost and not names:
        return True, explain_lost_topic(f"/{lost[0]}")
    return True, names_reason(names) if names else None


def explain_lost_arguments(entry: Entry, new_entry: Entry, old: LaunchOutline, new: LaunchOutline) -> Phrase | None:
    """Return the reason why other arguments of a bridge are breaking; None if it has all topics or they are unknown.

    Args:
        entry: the old action.
        new_entry: the new action.
        old: the actions of the old file.
        new: the actions of the new file.
    """
    arguments = new.resolve(new_entry.settings.get("arguments", ""))
    is_known = all("@" in argument for argument in list_items(arguments))
    return explain_lost_topics(entry, old, new)[1] if is_known else None


def _has_configuration(entry: Entry) -> bool:
    is_bridge = _BRIDGE.fullmatch(entry.name) is not None
    return is_bridge and any(setting.endswith(_CONFIGURATION) or setting == "parameters" for setting in entry.settings)


def _find_words(outline: LaunchOutline) -> Iterator[str]:
    """Yield the names in the arguments and settings of the nodes of a file, and the topics of its bridges."""
    for entry in outline.entries:
        yield from find_bridged_topics(entry, outline)
        if entry.kind == "node" and _BRIDGE.fullmatch(entry.name) is None:
            for value in entry.settings.values():
                yield from (word.strip("/") for word in re.findall(r"[\w/]+", outline.resolve(value)))
