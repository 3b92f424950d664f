"""Format the titles and settings of launch actions."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Phrase, joined_first, phrase, quoted_names
from linkwright.diagnostics.phrase import as_phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.outlines import (
    BUILDER,
    CONDITION,
    DELETION,
    ENVIRONMENT,
    IGNORED_TAG,
    LOG_MESSAGE,
    NAMESPACE,
    PROGRAM_KINDS,
    READING,
    REMAPPING,
    SERVER_PARAMETER,
    TEST,
    Entry,
    extract_condition,
    without_condition,
)
from linkwright.review.texts.excerpts import shorten_middle
from linkwright.review.texts.list_changes import EMPTY, list_items, nested_list_items, split_command

_MAX_SETTINGS = 16
"""The maximum number of settings in the line about an added or removed action."""
_WHOLE_SETTINGS = (CONDITION, "name", NAMESPACE, "default", "value", "arguments", REMAPPING)
"""The beginnings of the names of settings that are always shown, because other programs depend on them."""
_SETTING_ORDER = (*_WHOLE_SETTINGS, ENVIRONMENT, "parameter")
"""The beginnings of the names of settings in the order in which they are shown."""
_VALUE_SETTINGS = ("to", "value", "appended value", "text")
"""The settings that are the only value of an action."""
_MAX_SETTING_CHARACTERS = 160
_PARAMETER_FILES = "parameters"
"""The setting with the parameter files of a node."""
_MAX_FILES_CHARACTERS = 480
"""The maximum length of a list of parameter files: each file counts."""
_MAX_NAME_CHARACTERS = 160
_MAX_COMMAND_WORDS = 4
TRANSFORM_PUBLISHERS = ("tf2_ros/static_transform_publisher", "tf/static_transform_publisher")
_CHILD_FRAME = "--child-frame-id"
_TRANSFORM_WORD_COUNTS = (8, 9)
"""The numbers of words of a transform: six or seven numbers and two frames."""
_NUMBER = re.compile(r"\d+(?:\.\d*)?")
_SPAWNER_FLAGS = frozenset(
    {"--load-only", "--stopped", "--inactive", "--unload-on-kill", "-u", "--activate-as-group", "--switch-asap", "-h"}
)
"""The options of a spawner without a value."""
_END_OF_OPTIONS = ("--ros-args",)
_SPAWNER_PROGRAM = r"(?:un)?spawner(?:\.py)?"
_SPAWNER = re.compile(
    rf"controller_manager/(?:{_SPAWNER_PROGRAM}|'{_SPAWNER_PROGRAM}' if .+ else '{_SPAWNER_PROGRAM}')", re.DOTALL
)
"""The programs that start and stop controllers, also one of two, such as those of different versions of ROS."""
_MANAGER, _SPAWN_COMMAND = "controller_manager/controller_manager", "spawn "
"""The program of ROS 1 that starts controllers with this command."""
_CHOSEN_OPTION = "'-"
"""The start of an expression that chooses one of two options."""


def format_title(entry: Entry) -> Phrase:
    """Return the kind and name of an action."""
    name = shorten_middle(entry.name, _MAX_NAME_CHARACTERS)
    if entry.kind == "argument":
        return phrase("argument '{name}'", name=name)
    if entry.kind == "variable":
        return phrase("variable '{name}'", name=name)
    if entry.kind == "node":
        return _format_node_title(entry, name)
    if entry.kind == TEST:
        return phrase("test '{name}'", name=name)
    if entry.kind == "process":
        return phrase("process '{command}'", command=name)
    if entry.kind == "include":
        return phrase("include of '{file}'", file=name)
    if entry.kind == "remapping":
        return phrase("remapping of '{name}' for the nodes that follow", name=name)
    if entry.kind == SERVER_PARAMETER:
        return phrase("parameter '{name}'", name=name)
    if entry.kind == "parameter":
        return phrase("parameter '{name}' of the nodes that follow", name=name)
    if entry.kind == "parameters":
        return phrase("parameters of '{file}'", file=name)
    if entry.kind == BUILDER:
        return phrase("'{name}()'", name=name)
    if entry.kind == DELETION:
        return _format_deletion_title(name)
    if entry.kind == "handler":
        return phrase("event handler {name}", name=name)
    if entry.kind == IGNORED_TAG:
        return phrase("tag without effect {tag}", tag=name)
    if entry.kind == LOG_MESSAGE:
        return phrase("log message")
    if entry.kind == READING:
        return phrase("use of environment variable '{name}'", name=name)
    if entry.kind == "environment":
        return phrase("environment variable '{name}'", name=name)
    return phrase("action '{name}'", name=name)


def shorten_command(text: str) -> str:
    """Return the first words and the last word of a command, which is the text of a list or of a line."""
    words = list_items(text) if text.startswith("[") else text.split()
    words = [word.strip("'") for word in words if not word.startswith("-")]
    if len(words) > _MAX_COMMAND_WORDS:
        words = [*words[: _MAX_COMMAND_WORDS - 1], "...", words[-1]]
    return f"'{shorten_middle(' '.join(words), _MAX_NAME_CHARACTERS)}'"


def _format_deletion_title(name: str) -> Phrase:
    if not name:
        return phrase("deletion of all parameters in the namespace")
    return phrase("deletion of the parameters '{name}'", name=name)


def _format_node_title(entry: Entry, name: str) -> Phrase:
    """Return the title of a node with the controllers or the frame that it serves."""
    names = find_served_names(entry)
    if not names:
        return phrase("node '{name}'", name=name)
    return phrase("node '{name}' of {controllers}", name=name, controllers=quoted_names(names))


def find_served_names(entry: Entry) -> list[str]:
    """Return the controllers of a spawner or the child frame of a static transform.

    The list is empty if they are unknown.
    """
    text = entry.settings.get("arguments", "")
    is_manager = entry.name == _MANAGER and text.startswith(_SPAWN_COMMAND)
    text = text.removeprefix(_SPAWN_COMMAND) if is_manager else text
    is_spawner = is_manager or _SPAWNER.fullmatch(entry.name) is not None
    words = nested_list_items(text) if is_spawner and text.startswith("[") else split_command(text)
    if is_spawner and text.startswith("[") and any(word.startswith(("[", "{")) for word in words):
        return []
    if words == [text] and text.startswith("["):
        return []  # an expression that is not known
    words = words[: next((index for index, word in enumerate(words) if word in _END_OF_OPTIONS), len(words))]
    if is_spawner:
        return list(_find_spawned_controllers(words))
    if not entry.name.startswith(TRANSFORM_PUBLISHERS):
        return []
    if _CHILD_FRAME in words[:-1]:
        return [words[words.index(_CHILD_FRAME) + 1]]
    if entry.name.startswith("tf/") or (words and _NUMBER.fullmatch(words[-1])):
        words = words[:-1]  # the period of the publisher of ROS 1, which an action had that now has the one of tf2_ros
    return [words[-1]] if len(words) in _TRANSFORM_WORD_COUNTS else []


def _find_spawned_controllers(words: Sequence[str]) -> Iterator[str]:
    """Yield the words of a spawner's command line that are neither options nor their values.

    A word under a condition that does not hold is left out.
    """
    is_value = False
    for word in words:
        is_name = not word.startswith(("-", _CHOSEN_OPTION)) and not is_value
        if is_name and evaluate_condition(extract_condition(word)) is not False:
            yield without_condition(word)
        is_value = word.startswith("-") and word not in _SPAWNER_FLAGS


def format_distinct_title(entry: Entry, others: Sequence[Entry]) -> Phrase:
    """Return the title of an action, with its condition if another action sets the same name."""
    condition = entry.settings.get(CONDITION)
    count = sum((other.kind, other.name) == (entry.kind, entry.name) for other in others)
    if entry.kind in (*PROGRAM_KINDS, "include", "process") or condition is None or count < 2:
        return format_title(entry)
    return phrase("{entry} ({items})", entry=format_title(entry), items=condition)


def join_titles(entries: Sequence[Entry]) -> Phrase:
    """Return the first titles of actions, and the number of the remaining ones."""
    return join_phrases(list(map(format_title, entries)))


def join_phrases(titles: Sequence[Phrase]) -> Phrase:
    """Return the first distinct titles, and the number of the remaining ones."""
    return joined_first(list(dict.fromkeys(titles)), MAX_NAMES)


def format_added_entry(entry: Entry) -> Phrase:
    """Return the message that an action was added, with its only value or its settings.

    An argument without a default is required.
    """
    items, title = _format_value_or_settings(entry), format_title(entry)
    text = (
        phrase("{entry} added", entry=title)
        if items is None
        else phrase("{entry} added: {items}", entry=title, items=items)
    )
    return phrase("{entry} (required)", entry=text) if is_required(entry) else text


def is_required(entry: Entry) -> bool:
    """Return whether an action declares an argument without a value or default."""
    return entry.kind == "argument" and {"default", "value"}.isdisjoint(entry.settings)


def format_removed_entry(entry: Entry) -> Phrase:
    """Return the message that an action was removed, with its only value or its settings."""
    items = _format_value_or_settings(entry)
    if items is None:
        return phrase("{entry} removed", entry=format_title(entry))
    return phrase("{entry} removed: {items}", entry=format_title(entry), items=items)


def _format_value_or_settings(entry: Entry) -> Phrase | None:
    """Return the value of an action if it has only one, or its settings; None if it has none."""
    if entry.kind == READING:
        return None
    names = [name for name in entry.settings if name != "description"]
    if len(names) == 1 and names[0] in _VALUE_SETTINGS:
        return as_phrase(shorten_middle(entry.settings[names[0]], _MAX_NAME_CHARACTERS) or EMPTY)
    return format_settings(entry)


def format_settings(entry: Entry, limit: int = _MAX_SETTINGS) -> Phrase | None:
    """Return the settings of an action, its condition first, or None if it has none."""
    names = sorted((name for name in entry.settings if name != "description"), key=_find_setting_rank)
    if not names:
        return None
    count = max(limit, sum(name.startswith(_WHOLE_SETTINGS) for name in names))
    return joined_first([_format_setting(name, entry.settings[name]) for name in names], count)


def _find_setting_rank(setting: str) -> int:
    """Return the rank of a setting in a list.

    Shared names, and settings that differ in each node, come first.
    """
    return next(
        (number for number, start in enumerate(_SETTING_ORDER) if setting.startswith(start)), len(_SETTING_ORDER)
    )


def _format_setting(name: str, value: str) -> str:
    if name == CONDITION:
        return shorten_middle(value, _MAX_SETTING_CHARACTERS)
    separator = " -> " if name.startswith(REMAPPING) else " "
    limit = _MAX_FILES_CHARACTERS if name == _PARAMETER_FILES else _MAX_SETTING_CHARACTERS
    return shorten_middle(f"{name}{separator}{value or EMPTY}", limit)
