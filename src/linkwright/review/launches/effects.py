"""Decide which changes to launch files are breaking.

Other programs use the nodes, topics and arguments.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import PurePosixPath
from typing import NamedTuple

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.breaking import name_reason, transform_reason
from linkwright.review.changes import MAX_NAMES
from linkwright.review.files.parameters.names import (
    find_switch_reason,
    find_type_reason,
    offers_frame,
    switches_transform,
)
from linkwright.review.files.parameters.yaml_values import YamlType, YamlValue, parse_yaml_value
from linkwright.review.launches.argument_uses import had_action
from linkwright.review.launches.chosen_texts import is_choice
from linkwright.review.launches.conditions import evaluate_condition, find_added_terms, find_reversed_argument
from linkwright.review.launches.filter_topics import find_filter_topic_reason
from linkwright.review.launches.matching import compute_name_similarity
from linkwright.review.launches.name_effects import (
    find_included_renaming_reason,
    find_lost_target_reason,
    find_node_remapping_reason,
    find_remapping_reason,
    find_renaming_reason,
    names_looked_up_frame,
    resolve_name,
)
from linkwright.review.launches.outlines import (
    BUILDER,
    CONDITION,
    FAILURES,
    MISSING_ARGUMENT,
    NAMESPACE,
    NAMESPACE_OF_INCLUDED,
    PARAMETER,
    READING,
    REMAPPING,
    SERVER_PARAMETER,
    Entry,
    LaunchOutline,
    without_condition,
)
from linkwright.review.launches.parameter_types import accepts_type
from linkwright.review.launches.programs.sides import only_looks_up
from linkwright.review.launches.programs.silent import offers_no_names
from linkwright.review.launches.simulated_hardware import find_hardware_reason
from linkwright.review.launches.spawned_names import is_other_group, is_unconfigured
from linkwright.review.launches.titles import TRANSFORM_PUBLISHERS, find_served_names, format_title
from linkwright.review.launches.topic_tools import find_forwarding_reason
from linkwright.review.texts.list_changes import list_items

_USER_INTERFACE_PROGRAM = re.compile(r"rviz2?/|rqt|plotjuggler/|gazebo(_ros)?/(gui|gzclient)$|(gazebo_ros/)?gzclient$")
"""Programs that offer nothing to other programs."""
_JOINT_STATE_PREFIX = "joint_state_publisher"
"""The common prefix of the names of two packages that publish the same topics."""
_SPAWN_PROGRAM = re.compile(
    r"(ros_gz_sim|ros_ign_gazebo)/(create|remove)|(gazebo_ros|gazebo)/(spawn_entity\.py|spawn_model)|webots_ros2\w*/.*spawn.*|[^/]+/spawn_\w+(\.py)?"
)
"""Programs that request a robot from another program and exit. They offer nothing themselves."""
_SPAWN_FILE_NAME = re.compile(r"spawn|create")
"""The names of included files and commands that create robots."""
_SPAWN_COMMAND = re.compile(r"(?:^|[\s,\[])(?:spawn|create)(?=[\s,\]]|$)")
"""A word in the arguments of a program with which it creates a robot."""
_SHELL_SCRIPT = re.compile(r".*\.(sh|bash|zsh)")
_NAME_SETTINGS = ("name", "exec_name", NAMESPACE, NAMESPACE_OF_INCLUDED, "remappings")
_NAME_ARGUMENT = re.compile(
    r"(^|_)(namespace|ns|robot_name|tf_prefix|frame_prefix|prefix|frame|frame_id|topic|controller|controller_name)$"
)
"""The arguments whose values, judging by the argument name, are names that other programs use."""
_MIN_SIMILARITY_OF_NAMES = 0.75
_DEFAULT_NODE_NAMES = {
    "robot_localization/ekf_node": "ekf_filter_node",
    "robot_localization/ukf_node": "ukf_filter_node",
}
"""The default names of nodes that differ from the name of the program."""
_BOOLEANS = ("true", "false")
_CALL_IN_NAME = re.compile(r"\w\(")
"""A call in a name, whose result is unknown."""
_EXPRESSION = "$(eval "
"""The beginning of an expression, whose value is unknown."""
_UNKNOWN_NAME = re.compile(r"\w\(|\w[.\[][a-z_\"']")
"""A call, attribute or item of Python in a name, whose value is unknown."""
_PUBLISHED_TOPIC = re.compile(
    r"[ ._](\w+_)?(pub|publish|published|publisher|out|output)_(\w+_)?topic(_name)?$|"
    r"[ ._](\w+_)?topic(_name)?_(pub|publish|publisher|out|output)$"
)
"""The parameters that, judging by their name, contain the name of a published topic."""
_TOPIC = re.compile(r"[~/\w]+")
_GAZEBO_ARGUMENTS = ("gz_args", "ign_args")
"""The arguments of the launch files of Gazebo with the options of its command."""
_RUN_OPTION = re.compile(r"(?:^|\s)-\w*r\w*(?=\s|$)")
_SERVER_OPTION = re.compile(r"(?:^|\s)(?:-[a-z]*s[a-z]*|--headless-rendering)(?=\s|$)")
"""The option of Gazebo without which its window opens."""
_UNKNOWN_CHOICE = re.compile(r"\sif\s.+\selse\s", re.DOTALL)
"""A choice of Python between two values, which depends on something unknown."""
_CLASSIC_PACKAGE, _WINDOW_ARGUMENT = "gazebo_ros)", "gui"
"""A part of the names of the launch files of Gazebo Classic, and their argument for the window."""
_FRAME_PREFIXES = (f"{PARAMETER}frame_prefix", f"{PARAMETER}tf_prefix")
_VARIABLE = re.compile(r"\$\((?:var|arg) [^()]*\)")
_FILE_REASONS = (
    phrase("callers that pass the name of a file instead of its path fail"),
    phrase("callers that pass the path of a file instead of its name fail"),
)
_STANDARD_VARIABLES = frozenset({"HOME", "PATH", "PWD", "SHELL", "USER"})
"""The environment variables that every shell sets."""


class _BreakingUse(NamedTuple):
    """A use of an argument for which the new default of the argument is breaking.

    Attributes:
        entry: the action that uses the argument.
        setting: the setting of the action that uses it.
        reason: the reason why the new default is breaking.
    """

    entry: Entry
    setting: str
    reason: Phrase


def find_removal_reason(
    entry: Entry, old: LaunchOutline, new: LaunchOutline, *, stops_nodes: bool = False
) -> Phrase | None:
    """Return the reason why removing a launch action is breaking, or None if it is not.

    Args:
        entry: the action.
        old: the outline of the old file, which contains the action.
        new: the outline of the new file.
        stops_nodes: whether the action includes a file with nodes that nothing else starts in the new version.
    """
    if entry.kind == "argument" and "value" not in entry.settings:
        return explain_argument_removal(entry.name, is_ros1=old.is_ros1)
    if evaluate_condition(_resolve_condition(entry, old)) is False:
        return None
    if entry.kind == "remapping":
        return find_remapping_reason(entry.name, entry.settings.get("to"), None, old, old)
    if _is_spawner(entry):
        return None if _spawns_as_many(old, new) else phrase("the robot or model is no longer spawned")
    if entry.kind not in ("node", "include") or offers_nothing(entry):
        return None
    if entry.kind == "include":
        return phrase("its nodes no longer start") if stops_nodes else None
    if any(_starts_same_node(entry, other, old, new) for other in new.entries):
        return find_lost_target_reason(entry, old, new)
    if any(other.is_unknown_node or (other.name == entry.name and _has_computed_names(other)) for other in new.entries):
        return None  # for example, an action of a loop, which may start this node, too
    if entry.name.startswith(_JOINT_STATE_PREFIX) and any(
        other.name.startswith(_JOINT_STATE_PREFIX) for other in new.entries
    ):
        return None
    if offers_no_names(old.root, entry.name):
        return None
    names = _find_resolved_served_names(entry, old)
    if (
        entry.name.startswith(TRANSFORM_PUBLISHERS)
        and _publishes_joint_states(new)
        and not _publishes_joint_states(old)
    ):
        return None  # robot_state_publisher may publish the frame, which now belongs to a joint
    if not names:
        if entry.name.startswith(TRANSFORM_PUBLISHERS):
            return phrase("programs that look up the frame of the node do not find it")
        return phrase("the topics and services of the node are missing")
    is_transform = entry.name.startswith(TRANSFORM_PUBLISHERS)
    if old.is_ros1 and not is_transform and all(is_other_group(name, old.root) for name in names):
        return None  # the spawner cannot start them
    return _find_served_name_reason(entry, names, old, new)


def _is_spawner(entry: Entry) -> bool:
    """Return whether a node requests a robot or model from a simulator and exits."""
    return entry.kind == "node" and _SPAWN_PROGRAM.fullmatch(entry.name) is not None and "remove" not in entry.name


def _spawns_as_many(old: LaunchOutline, new: LaunchOutline) -> bool:
    """Return whether a file creates at least as many robots as before.

    A new include or program that may create them is also enough.
    """
    counts = [sum(map(_is_spawner, outline.entries)) for outline in (old, new)]
    if any(_is_spawner(entry) and _has_computed_names(entry) for entry in new.entries):
        return True  # a loop may create any number
    known = {entry.name for entry in old.entries}
    may_create = any(
        _SPAWN_FILE_NAME.search(entry.name) or _SPAWN_COMMAND.search(entry.settings.get("arguments", ""))
        for entry in new.entries
        if entry.name not in known
    )
    return counts[1] >= counts[0] or may_create


def _has_computed_names(entry: Entry) -> bool:
    """Return whether the names of a node are computed, such as from the variable of a loop."""
    names = (entry.settings.get(setting, "") for setting in ("name", NAMESPACE, "arguments"))
    return entry.kind == "node" and any(_EXPRESSION in name and not is_choice(name) for name in names)


def _publishes_joint_states(outline: LaunchOutline) -> bool:
    """Return whether a file starts a program that publishes the positions of joints."""
    return any(entry.kind == "node" and entry.name.startswith(_JOINT_STATE_PREFIX) for entry in outline.entries)


def _starts_same_node(entry: Entry, other: Entry, old: LaunchOutline, new: LaunchOutline) -> bool:
    """Return whether a new action may start the node of a removed one.

    For example, it may have a different condition.
    """
    if (entry.kind, entry.name) != (other.kind, other.name) or evaluate_condition(
        _resolve_condition(other, new)
    ) is False:
        return False
    if _find_resolved_served_names(entry, old) != _find_resolved_served_names(other, new):
        return False
    return all(
        resolve_name(entry.settings.get(setting), old) == resolve_name(other.settings.get(setting), new)
        for setting in ("name", NAMESPACE)
    )


def find_addition_reason(entry: Entry, outline: LaunchOutline) -> Phrase | None:
    """Return the reason why adding a launch action is breaking, or None if it is not.

    Args:
        entry: the action.
        outline: the outline of the new file, which contains the action.
    """
    if entry.kind == "argument" and not {"default", "value"} & entry.settings.keys():
        return _explain_required_argument(entry)
    if MISSING_ARGUMENT in entry.settings and is_made_by_default(entry, outline):
        return phrase("the launch file fails without '{name}'", name=entry.settings[MISSING_ARGUMENT])
    is_required = entry.kind == READING and not entry.settings and entry.name not in _STANDARD_VARIABLES
    if is_required and not _is_read_by_stopped_actions(entry.name, outline):
        return phrase("the launch file fails where '{name}' is not set", name=entry.name)
    return None


def is_made_by_default(entry: Entry, outline: LaunchOutline) -> bool:
    """Return whether a Python file makes an action, unlike one below an ``if`` statement that may not hold.

    The condition of an action is evaluated after the action is made.
    """
    condition = entry.settings.get(CONDITION, "")
    return "`" not in condition or evaluate_condition(outline.resolve(condition)) is True


def _is_read_by_stopped_actions(variable: str, outline: LaunchOutline) -> bool:
    """Return whether only actions that do not start by default read an environment variable.

    A condition that reads the variable is evaluated in any case.
    """
    reading = re.compile(rf"\$\(env {re.escape(variable)}\)")
    readers = [other for other in outline.entries if any(map(reading.search, (other.name, *other.settings.values())))]
    return bool(readers) and not any(
        reading.search(condition) or evaluate_condition(outline.resolve(condition)) is not False
        for condition in (reader.settings.get(CONDITION, "") for reader in readers)
    )


def _explain_required_argument(argument: Entry) -> Phrase:
    """Return the reason why an argument without a default is breaking."""
    return phrase("callers must pass '{name}'", name=argument.name)


def explain_argument_removal(name: str, *, is_ros1: bool = False) -> Phrase:
    """Return the reason why removing an argument is breaking.

    ROS 1 refuses arguments that a file does not declare.
    """
    if is_ros1:
        return phrase("launch files that pass '{name}' to the file fail", name=name)
    return phrase("a value that a caller passes for '{name}' has no effect", name=name)


def offers_nothing(entry: Entry) -> bool:
    """Return whether other programs cannot use anything of the node."""
    patterns = (_USER_INTERFACE_PROGRAM.match, _SPAWN_PROGRAM.fullmatch, _SHELL_SCRIPT.fullmatch)
    return any(matches(entry.name) is not None for matches in patterns)


def find_setting_reason(
    entry: Entry, setting: str, old: str | None, new: str | None, old_outline: LaunchOutline, new_outline: LaunchOutline
) -> Phrase | None:
    """Return the reason why a changed setting of an action is breaking, or None if it is not.

    Args:
        entry: the new action.
        setting: the name of the setting.
        old: its old value; None if there was none.
        new: its new value; None if there is none.
        old_outline: the outline of the old file.
        new_outline: the outline of the new file.
    """
    if setting in FAILURES:
        return phrase("the launch file fails") if new is not None and old is None else None
    if entry.kind == READING:
        return find_addition_reason(entry, new_outline)
    if entry.kind == "argument":
        return _find_argument_reason(entry, setting, old, new, old_outline, new_outline)
    sides = ((old_outline, old), (new_outline, new))
    values = (outline.resolve(text or "") for outline, text in sides)
    hardware_reason = find_hardware_reason(setting.rpartition(" ")[2], *values)
    if entry.kind in (BUILDER, "include") and hardware_reason is not None:
        return hardware_reason
    if entry.kind == "remapping" and setting == "to":
        return find_remapping_reason(entry.name, old, new, old_outline, new_outline)
    if entry.kind == "include" and setting == NAMESPACE_OF_INCLUDED:
        return find_renaming_reason(old, new, old_outline, new_outline)
    renaming_reason = find_included_renaming_reason(entry, setting, old, new, old_outline, new_outline)
    if renaming_reason is not None:
        return renaming_reason
    if entry.kind == "include" and setting in _GAZEBO_ARGUMENTS:
        return _find_option_reason(old, new, old_outline, new_outline)
    if entry.kind == "include" and setting == _WINDOW_ARGUMENT and _CLASSIC_PACKAGE in entry.name:
        opens = [outline.resolve(text or "true").lower() not in ("false", "0") for outline, text in sides]
        return _make_window_reason() if opens == [True, False] else None
    if entry.kind == SERVER_PARAMETER and setting == "value":
        name = PARAMETER + entry.name.replace("/", ".")
        return _find_parameter_reason(entry, name, old, new, old_outline, new_outline)
    if entry.kind in ("node", "include") and setting == CONDITION and (_is_spawner(entry) or not offers_nothing(entry)):
        old_holds = evaluate_condition(old_outline.resolve(old or ""))
        is_stopped = evaluate_condition(new_outline.resolve(new or "")) is False
        others = [other for other in new_outline.entries if other is not entry]
        if any(_starts_same_node(entry, other, new_outline, new_outline) for other in others):
            return None  # another action starts the node under the opposite condition
        reversed_argument = find_reversed_argument(old or "", new or "")
        if reversed_argument is not None and all(other.name != entry.name for other in others):
            return phrase("the argument '{name}' has the opposite meaning now", name=reversed_argument)
        if old_holds and is_stopped:
            return phrase("by default, it no longer starts")
        added = find_added_terms(old or "", new or "") if all(other.name != entry.name for other in others) else ""
        if added and evaluate_condition(new_outline.resolve(added)) is False:
            return phrase("with the arguments that started it before, it no longer starts by default")
        return None
    if entry.kind != "node" or offers_nothing(entry):
        return None
    if setting.startswith(REMAPPING):
        source = without_condition(setting).removeprefix(REMAPPING)
        return find_node_remapping_reason(entry, source, old, new, old_outline, new_outline)
    if setting == "name" and None in (old, new) and _is_default_node_name(entry, old or new or ""):
        return None
    if setting in _NAME_SETTINGS and offers_no_names(new_outline.root, entry.name):
        return None
    if setting in _NAME_SETTINGS:
        return find_renaming_reason(old, new, old_outline, new_outline)
    forwarding = find_forwarding_reason(entry, setting, old, new, (old_outline, new_outline))
    if forwarding is not None:
        return forwarding
    if setting == "arguments":
        old_names = _find_names_in_arguments(entry, old, old_outline)
        new_names = _find_names_in_arguments(entry, new, new_outline)
        kept = {name.strip("/") for name in new_names}
        removed = [name for name in old_names if name.strip("/") not in kept]
        is_unknown = any(_EXPRESSION in name for name in new_names)
        return (
            _find_served_name_reason(entry, removed, old_outline, new_outline) if removed and not is_unknown else None
        )
    return _find_parameter_reason(entry, setting, old, new, old_outline, new_outline)


def _make_window_reason() -> Phrase:
    return phrase("the window of Gazebo no longer opens")


def _find_option_reason(
    old: str | None, new: str | None, old_outline: LaunchOutline, new_outline: LaunchOutline
) -> Phrase | None:
    """Return the reason why other options of Gazebo are breaking, or None if they are not."""
    before, after = old_outline.resolve(old or ""), new_outline.resolve(new or "")
    if _VARIABLE.search(after) or _UNKNOWN_CHOICE.search(after):
        return None
    if _RUN_OPTION.search(before) and not _RUN_OPTION.search(after):
        return phrase("the simulation starts paused")
    is_hidden = _SERVER_OPTION.search(after) and not _SERVER_OPTION.search(before)
    return _make_window_reason() if is_hidden and not _VARIABLE.search(before) and old is not None else None


def _find_parameter_reason(
    entry: Entry,
    setting: str,
    old: str | None,
    new: str | None,
    old_outline: LaunchOutline,
    new_outline: LaunchOutline,
) -> Phrase | None:
    """Return the reason why a changed parameter is breaking, or None if it is not.

    It may name a shared frame or topic, or have a different type.
    """
    if setting in _FRAME_PREFIXES:
        old_prefix, new_prefix = old_outline.resolve(old or ""), new_outline.resolve(new or "")
        is_unknown = any(
            _CALL_IN_NAME.search(prefix) or setting.endswith(f" {prefix}") for prefix in (old_prefix, new_prefix)
        )
        if old_prefix == new_prefix or is_unknown:
            return None
        return phrase("programs that look up the frames by their old names do not find them")
    if old is None or new is None or not setting.startswith(PARAMETER):
        return None
    old_name, new_name = old_outline.resolve(old), new_outline.resolve(new)
    parameter = without_condition(setting).removeprefix(PARAMETER).replace("/", ".")
    is_frame = offers_frame(setting.removeprefix(PARAMETER)) and "$(" not in old_name
    is_frame = is_frame and not only_looks_up(entry.name, parameter, old_outline.root)
    is_topic = _PUBLISHED_TOPIC.search(setting) is not None and _TOPIC.fullmatch(old_name) is not None
    if (is_frame or is_topic) and old_name.strip("/") != new_name.strip("/") and not _UNKNOWN_NAME.search(new_name):
        return name_reason(old_name)
    topic_reason = find_filter_topic_reason(entry.name, parameter, old_name, new_name)
    hardware_reason = find_hardware_reason(parameter.rpartition(".")[2], old_name, new_name)
    switch_reason = find_switch_reason(parameter, old_name, new_name) or hardware_reason or topic_reason
    if switch_reason is not None and switches_transform(parameter) and _starts_other_programs(old_outline, new_outline):
        return None  # an added node may publish the transform
    if switch_reason is not None or new_outline.is_ros1:
        return switch_reason  # ROS 1 converts numbers
    old_value, new_value = _parse_literal(old_name), _parse_literal(new_name)
    if not old_value or not new_value or accepts_type(entry, parameter, old_value, new_value, new_outline.root):
        return None
    return find_type_reason(old_value, new_value)


def _starts_other_programs(old: LaunchOutline, new: LaunchOutline) -> bool:
    """Return whether a file starts a program or includes a file that the old version did not."""
    before, after = (
        {entry.name for entry in outline.entries if entry.kind in ("node", "include")} for outline in (old, new)
    )
    return not after <= before


def _parse_literal(text: str) -> YamlValue | None:
    """Return the value of a parameter, or None if its type is unknown.

    A word without quotes may be the name of a variable.
    """
    value = None if "$(" in text else parse_yaml_value(text)
    is_word = value is not None and value.type in (YamlType.TEXT, YamlType.MIXED) and not text.startswith(("'", '"'))
    return None if is_word else value


def _find_argument_reason(
    entry: Entry,
    setting: str,
    old: str | None,
    new: str | None,
    old_outline: LaunchOutline,
    new_outline: LaunchOutline,
) -> Phrase | None:
    """Return the reason why a changed argument is breaking, or None if it is not."""
    if setting == "default" and new is None and "value" not in entry.settings:
        return _explain_required_argument(entry)
    if setting == "default" and old is not None and new is not None:
        return _find_default_reason(entry, old, new, old_outline, new_outline)
    if setting == "choices" and old is not None and new is not None and old[:1] == new[:1] == "[":
        removed = [item for item in list_items(old) if item not in list_items(new)]
        if removed:
            return _make_caller_reason(", ".join(removed))
    if setting == "choices" and old is None and any(item.lower() not in _BOOLEANS for item in list_items(new or "")):
        return phrase("callers that pass another value fail")
    return None


def is_about_callers(reason: Phrase) -> bool:
    """Return whether a value that callers pass is the reason, which they cannot pass under a new name."""
    return reason.template in (_make_caller_reason("").template, *(reason.template for reason in _FILE_REASONS))


def _make_caller_reason(value: str) -> Phrase:
    return phrase("callers that pass '{value}' fail", value=value)


def _find_default_reason(
    argument: Entry, old: str, new: str, old_outline: LaunchOutline, new_outline: LaunchOutline
) -> Phrase | None:
    """Return the reason why a different default is breaking, or None if it is not.

    A node may not start, or a shared name may change.
    """
    old_value, new_value = old_outline.resolve(old), new_outline.resolve(new)
    if old_value == new_value:
        return None
    for file_name, path in ((old, new), (new, old)):
        if "/" not in file_name and "." in file_name and "/" in path and PurePosixPath(path).name == file_name:
            return _FILE_REASONS[file_name is not old]
    if (
        old_value.lower() in _BOOLEANS
        and re.fullmatch(r"[a-z]\w*", new_value.lower())
        and new_value.lower() not in _BOOLEANS
    ):
        return _make_caller_reason(old_value)
    uses = list(_find_breaking_uses(argument.name, old_outline, new_outline))
    stopped = list(
        dict.fromkeys(
            format_title(use.entry)
            for use in _sort_by_importance(uses)
            if use.setting == CONDITION and not _starts_elsewhere(use.entry, new_outline)
        )
    )
    if len(stopped) > 1:
        return phrase("by default, {entries} no longer start", entries=joined_first(stopped, MAX_NAMES))
    if stopped:
        return phrase("by default, {entry} no longer starts", entry=stopped[0])
    reason = next((use.reason for use in uses if use.setting != CONDITION), None)
    old_name, new_name = (value.strip("\"'") for value in (old_value, new_value))  # '""' is an empty name for xacro
    is_name = bool(old_name) and old_name != new_name and "/" not in f"{old_name}{new_name}"
    is_name = is_name and _VARIABLE.search(old_name) is None and _NAME_ARGUMENT.search(argument.name) is not None
    if reason is None and is_name and not names_looked_up_frame(argument.name, old_outline):
        return name_reason(old_name)
    return reason or find_hardware_reason(argument.name, old_value, new_value)


def _starts_elsewhere(entry: Entry, outline: LaunchOutline) -> bool:
    """Return whether another action starts the same program or includes the same file by default."""
    return is_other_joint_state_publisher_started(entry.name, outline) or any(
        (other.kind, other.name, other.settings.get("name")) == (entry.kind, entry.name, entry.settings.get("name"))
        and evaluate_condition(_resolve_condition(other, outline)) is not False
        for other in outline.entries
    )


def is_other_joint_state_publisher_started(program: str, outline: LaunchOutline) -> bool:
    """Return whether a program publishes the positions of joints, and another such program starts by default.

    One of them has a window.
    """
    return program.startswith(_JOINT_STATE_PREFIX) and any(
        other.name.startswith(_JOINT_STATE_PREFIX)
        and other.name != program
        and evaluate_condition(_resolve_condition(other, outline)) is not False
        for other in outline.entries
    )


def _sort_by_importance(uses: list[_BreakingUse]) -> list[_BreakingUse]:
    """Sort the uses of an argument so that static transforms come last."""
    return sorted(uses, key=lambda use: use.entry.name.startswith(TRANSFORM_PUBLISHERS))


def _find_breaking_uses(name: str, old_outline: LaunchOutline, new_outline: LaunchOutline) -> Iterator[_BreakingUse]:
    """Yield the uses of an argument in settings for which its new default is breaking."""
    variable = re.compile(rf"\$\((?:var|arg) {re.escape(name)}[ )]")
    for entry in new_outline.entries:
        if entry.kind == "argument" or not had_action(entry, name, old_outline.entries):
            continue
        for setting, value in entry.settings.items():
            if variable.search(value):
                reason = find_setting_reason(entry, setting, value, value, old_outline, new_outline)
                if reason is not None:
                    yield _BreakingUse(entry, setting, reason)


def _resolve_condition(entry: Entry, outline: LaunchOutline) -> str:
    return outline.resolve(entry.settings.get(CONDITION, ""))


def _find_resolved_served_names(entry: Entry, outline: LaunchOutline) -> list[str]:
    return _find_names_in_arguments(entry, entry.settings.get("arguments"), outline)


def _find_names_in_arguments(entry: Entry, arguments: str | None, outline: LaunchOutline) -> list[str]:
    """Return the controllers or the frame in the arguments of a node.

    Variables have the defaults of the launch arguments.
    """
    return find_served_names(Entry(entry.kind, entry.name, {"arguments": outline.resolve(arguments or "")}, entry.span))


def _find_served_name_reason(entry: Entry, names: list[str], old: LaunchOutline, new: LaunchOutline) -> Phrase | None:
    """Return the reason why a node that no longer serves names is breaking.

    The result is None if another node serves the names, or if the old version could not start them.
    """
    is_transform = entry.name.startswith(TRANSFORM_PUBLISHERS)
    others = [other for other in new.entries if other.name.startswith(TRANSFORM_PUBLISHERS) == is_transform]
    served = {name.strip("/") for other in others for name in _find_resolved_served_names(other, new)}
    names = [name for name in names if name.strip("/") not in served and not is_unconfigured(name, entry, old)]
    same = [other for other in others if other.name == entry.name]
    if not names or any(_EXPRESSION in name for other in same for name in _find_resolved_served_names(other, new)):
        return None
    if is_transform:
        return transform_reason(names[0])
    return phrase("the topics and services of {controllers} are missing", controllers=", ".join(names))


def _is_default_node_name(entry: Entry, name: str) -> bool:
    """Return whether a name may be the default name of a node, judging by its program.

    The program is an executable or the class of a component, such as ``map_server`` and ``nav2::MapServer``.
    """
    if _DEFAULT_NODE_NAMES.get(entry.name) == name:
        return True
    program = entry.name.rpartition("/")[2].rpartition("::")[2].removesuffix(".py")
    return compute_name_similarity(name, program) >= _MIN_SIMILARITY_OF_NAMES
