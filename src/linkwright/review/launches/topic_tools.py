"""Compare the topics that the programs of topic_tools forward, from their arguments."""

from __future__ import annotations

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.breaking import name_reason
from linkwright.review.launches.outlines import PARAMETER, Entry, LaunchOutline
from linkwright.review.texts.list_changes import split_command

_PACKAGE = "topic_tools/"
_THROTTLE_NUMBER_COUNTS = {"messages": 1, "bytes": 2}
"""The numbers that follow the input of ``throttle``."""
_NUMBER_COUNTS = {"relay": 0, "delay": 1, "drop": 2, "relay_field": None, "transform": None}
"""The numbers between the input and the output of other programs; None if there is always an output after the input."""
_INPUT_PARAMETER = f"{PARAMETER}input_topic"
_Topics = tuple[list[str], list[str]]
"""The inputs and the outputs."""


def find_forwarding_reason(
    entry: Entry, setting: str, old: str | None, new: str | None, outlines: tuple[LaunchOutline, LaunchOutline]
) -> Phrase | None:
    """Return the reason why a changed topic_tools setting is breaking, or None.

    Args:
        entry: the new action.
        setting: the name of the setting.
        old: its old value; None if there was none.
        new: its new value; None if there is none.
        outlines: the old and the new file.
    """
    if not entry.name.startswith(_PACKAGE) or old is None or new is None:
        return None
    old_text, new_text = outlines[0].resolve(old), outlines[1].resolve(new)
    if setting == _INPUT_PARAMETER:
        return None if _may_be_among(old_text, [new_text]) else _explain_lost_input(old_text)
    if setting != "arguments":
        return None
    (old_inputs, old_outputs), (new_inputs, new_outputs) = (_read_topics(entry, text) for text in (old_text, new_text))
    if not old_inputs or not new_inputs:
        return None
    remaining_outputs = [
        *new_outputs,
        *(name for other in outlines[1].entries for name in _find_output_topics(other, outlines[1])),
    ]
    for name in old_outputs:
        if not _may_be_among(name, remaining_outputs):
            return name_reason(name)
    return next((_explain_lost_input(name) for name in old_inputs if not _may_be_among(name, new_inputs)), None)


def _explain_lost_input(name: str) -> Phrase:
    return phrase("the messages of '{name}' are no longer forwarded", name=name)


def _may_be_among(name: str, names: list[str]) -> bool:
    """Return whether a name is, or may be, among names with unknown parts."""
    return any("$(" in other or other.strip("/") == name.strip("/") for other in names)


def _find_output_topics(entry: Entry, outline: LaunchOutline) -> list[str]:
    return _read_topics(entry, outline.resolve(entry.settings.get("arguments", "")))[1]


def _read_topics(entry: Entry, arguments: str) -> _Topics:
    """Return the topics that the arguments of a program name; none if they are unknown."""
    words = split_command(arguments)
    words = words[: words.index("--ros-args")] if "--ros-args" in words else words
    program = entry.name.removeprefix(_PACKAGE)
    if not entry.name.startswith(_PACKAGE) or not words or "$(" in words[0] or words[0].startswith("["):
        return [], []
    if program == "mux":
        return words[1:], words[:1]
    if program == "demux":
        return words[:1], words[1:]
    number_count: int | None = 0
    if program == "throttle":
        kind, *words = words
        if kind not in _THROTTLE_NUMBER_COUNTS or not words:
            return [], []
        number_count = _THROTTLE_NUMBER_COUNTS[kind]
    elif program in _NUMBER_COUNTS:
        number_count = _NUMBER_COUNTS[program]
    else:
        return [], []
    if number_count is None:
        return words[:1], words[1:2]
    output = words[number_count + 1 : number_count + 2]
    return words[:1], output or [f"{words[0].rstrip('/')}_{program}"]
