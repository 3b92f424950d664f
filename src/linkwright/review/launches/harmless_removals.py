"""Explain removed actions of launch files whose effect something else in the new version has."""

from __future__ import annotations

import re
from collections.abc import Sequence

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.argument_uses import uses_argument
from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.included import IncludedActions, find_equal_action
from linkwright.review.launches.outlines import CONDITION, NAMESPACE, REMAPPING, Entry, LaunchOutline
from linkwright.review.launches.simulated_controllers import is_simulated_controller_manager
from linkwright.review.launches.starting_nodes import find_starting_node
from linkwright.review.launches.titles import format_title
from linkwright.review.launches.transforms import find_other_publisher, has_robot_with_frame
from linkwright.review.sources.names import PYTHON_SUFFIX

_JOINT_STATE_PUBLISHER = re.compile(r"(joint_state_publisher(_gui)?)/\1")
_SPAWNER = re.compile(r"controller_manager/spawner(\.py)?")
_BROADCASTER = re.compile(r"(?:^|[\s,\[])joint_state_(?:broadcaster|controller)(?=[\s,\]]|$)")
"""The name of the broadcaster in the arguments of a spawner."""


def explain_harmless_removal(
    pair: FilePair,
    entry: Entry,
    texts: tuple[Phrase, Phrase],
    included: tuple[IncludedActions, IncludedActions],
    added: Sequence[Entry],
) -> Phrase | None:
    """Return the line about a removed action that breaks nothing, or None if it may break something.

    Args:
        pair: both versions of the launch file.
        entry: the removed action.
        texts: the line about the removal, and the title of the action with its old names.
        included: the actions of both versions with those of the included files.
        added: the added actions.
    """
    (text, title), (old_included, new_included) = texts, included
    old, new = old_included.outline, new_included.outline
    if find_equal_action(entry, new) is not None:
        return phrase("{change}; the file still has an equal one", change=text)
    publisher = find_other_publisher(entry, old, new, pair.versions)
    if publisher is not None:
        return phrase("{change}; {entry} may publish its transform", change=text, entry=format_title(publisher))
    if has_robot_with_frame(entry, old, new_included, pair.versions.new):
        return phrase("{change}; the robot has the frame as a link", change=text)
    if is_simulated_controller_manager(entry, new_included, pair.versions.new):
        return phrase("{change}; the simulated robot has a controller manager", change=text)
    broadcaster = _find_joint_state_broadcaster(entry, new)
    if broadcaster is not None:
        return phrase("{change}; {entry} publishes the joint states", change=text, entry=format_title(broadcaster))
    if _is_unused_argument(pair, entry, old):
        return phrase("{change}; the file did not use it", change=text)
    declaration = new_included.find_declaration(entry.name) if entry.kind == "argument" else None
    if declaration is not None:
        path, default = declaration
        text = phrase("{change}; {file} declares it", change=text, file=path)
        is_other = default is not None and default != entry.settings.get("default")
        return phrase("{change} with the default '{value}'", change=text, value=default) if is_other else text
    if _is_still_read(pair, entry, new):
        return phrase("argument '{name}' is no longer declared, but the file still uses it", name=entry.name)
    starting_node = find_starting_node(entry, added, pair.versions.new.root)
    if starting_node is not None:
        new_title = format_title(starting_node)
        return phrase("{old} replaced by {new}, whose script names the file", old=title, new=new_title)
    return None


def _find_joint_state_broadcaster(entry: Entry, new: LaunchOutline) -> Entry | None:
    """Return the spawner of a broadcaster that publishes what a removed ``joint_state_publisher`` did, or None.

    It starts by default, in the same namespace. A remapped publisher has no replacement.
    """
    is_remapped = any(setting.startswith(REMAPPING) for setting in entry.settings)
    if not _JOINT_STATE_PUBLISHER.fullmatch(entry.name) or is_remapped:
        return None
    for other in new.entries:
        is_started = _SPAWNER.fullmatch(other.name) and _BROADCASTER.search(other.settings.get("arguments", ""))
        is_in_place = is_started and other.settings.get(NAMESPACE) == entry.settings.get(NAMESPACE)
        if is_in_place and evaluate_condition(new.resolve(other.settings.get(CONDITION, ""))) is not False:
            return other
    return None


def _is_unused_argument(pair: FilePair, entry: Entry, old: LaunchOutline) -> bool:
    """Return whether a removed action declares an argument of ROS 2 that the old file did not use.

    Included files get a value that a caller passes with or without a declaration. ROS 1 refuses undeclared arguments.
    """
    is_argument = entry.kind == "argument" and "value" not in entry.settings
    return is_argument and not old.is_ros1 and not uses_argument(pair.old_file, entry.name, old.entries)


def _is_still_read(pair: FilePair, entry: Entry, new: LaunchOutline) -> bool:
    """Return whether a removed action declares an argument that a Python file still reads, which callers can pass."""
    is_argument = entry.kind == "argument" and "value" not in entry.settings
    is_python = pair.new_file.suffix == PYTHON_SUFFIX
    return is_argument and is_python and uses_argument(pair.new_file, entry.name, new.entries, is_declared=False)
