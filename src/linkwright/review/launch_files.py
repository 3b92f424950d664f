"""The comparison of launch files: which arguments, nodes and files they have, with their settings."""

from __future__ import annotations

import re
from collections.abc import Iterator
from difflib import SequenceMatcher

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.file_pair import FilePair
from linkwright.review.launch_outlines import Entry, LaunchOutline, read_outline
from linkwright.review.list_changes import change_text

_USER_INTERFACE = re.compile(r"rviz2/|rqt|joint_state_publisher_gui/|plotjuggler/")
"""Programs that offer nothing to other programs."""
_NAME = re.compile(r"[~/\w]+")
_BREAKING_SETTINGS = ("name", "namespace", "remappings", "exec_name")


def compare_launch_files(pair: FilePair) -> None:
    """Compare two versions of a launch file, without running them."""
    outlines = pair.read(read_outline)
    if outlines is None:
        return
    old, new = outlines
    old_groups, new_groups = _by_name(old.entries), _by_name(new.entries)
    for key in dict.fromkeys([*new_groups, *old_groups]):
        for old_entry, new_entry in _matched(old_groups.get(key, []), new_groups.get(key, [])):
            if old_entry is None and new_entry is not None:
                pair.add(phrase("{entry} added", entry=_title(new_entry)), pair.location(new_entry.span))
            elif new_entry is None and old_entry is not None:
                text = phrase("{entry} removed", entry=_title(old_entry))
                pair.add(text, pair.location(old_entry.span, is_old=True), _removal_reason(old_entry))
            elif old_entry is not None and new_entry is not None:
                _compare_settings(pair, old_entry, new_entry, new)
    if not pair.changes and old.code != new.code:
        pair.add(phrase("code changed outside of arguments, nodes and includes"), None)


def _by_name(entries: list[Entry]) -> dict[tuple[str, str], list[Entry]]:
    groups: dict[tuple[str, str], list[Entry]] = {}
    for entry in entries:
        groups.setdefault((entry.kind, entry.name), []).append(entry)
    return groups


def _matched(old: list[Entry], new: list[Entry]) -> Iterator[tuple[Entry | None, Entry | None]]:
    """Yield the pairs of entries with one name: equal ones, those with one node name, and the most similar ones."""
    old_rest, new_rest = list(old), list(new)
    pairs: list[tuple[Entry, Entry]] = []
    for is_match in (_are_equal, _have_same_node_name):
        for entry in tuple(new_rest):
            match = next((other for other in old_rest if is_match(other, entry)), None)
            if match is not None:
                old_rest.remove(match)
                new_rest.remove(entry)
                pairs.append((match, entry))
    candidates = sorted(
        ((_similarity(other, entry), i, k) for i, other in enumerate(old_rest) for k, entry in enumerate(new_rest)),
        key=lambda item: (-item[0], item[1], item[2]),
    )
    old_left, new_left = set(range(len(old_rest))), set(range(len(new_rest)))
    for _, i, k in candidates:
        if i in old_left and k in new_left:
            old_left.remove(i)
            new_left.remove(k)
            pairs.append((old_rest[i], new_rest[k]))
    yield from sorted(pairs, key=lambda item: new.index(item[1]))
    yield from ((None, new_rest[k]) for k in sorted(new_left))
    yield from ((old_rest[i], None) for i in sorted(old_left))


def _are_equal(old: Entry, new: Entry) -> bool:
    return old.settings == new.settings


def _have_same_node_name(old: Entry, new: Entry) -> bool:
    return "name" in new.settings and old.settings.get("name") == new.settings["name"]


def _similarity(old: Entry, new: Entry) -> float:
    """Return how much of the settings is equal, from 0 to 1."""
    old_words, new_words = (
        " ".join(f"{name}={value}" for name, value in entry.settings.items()).split() for entry in (old, new)
    )
    return SequenceMatcher(None, old_words, new_words, autojunk=False).ratio()


def _compare_settings(pair: FilePair, old: Entry, new: Entry, outline: LaunchOutline) -> None:
    for name in dict.fromkeys([*new.settings, *old.settings]):
        old_value, new_value = old.settings.get(name), new.settings.get(name)
        if old_value == new_value:
            continue
        text = phrase(
            "{entry}: {change}",
            entry=_title(new),
            change=change_text(
                name,
                "-" if old_value is None else old_value or "''",
                "-" if new_value is None else new_value or "''",
            ),
        )
        pair.add(text, pair.location(new.span), _setting_reason(new, name, old_value, new_value, outline))


def _title(entry: Entry) -> Phrase:
    if entry.kind == "argument":
        return phrase("argument '{name}'", name=entry.name)
    if entry.kind == "node":
        return phrase("node '{name}'", name=entry.name)
    if entry.kind == "process":
        return phrase("process '{command}'", command=entry.name)
    return phrase("include of '{file}'", file=entry.name)


def _removal_reason(entry: Entry) -> Phrase | None:
    if entry.kind == "argument":
        return phrase("a value that a caller passes for '{name}' has no effect", name=entry.name)
    if entry.kind == "node" and not _USER_INTERFACE.match(entry.name):
        return phrase("the topics and services of the node are missing")
    return None


def _setting_reason(
    entry: Entry, setting: str, old: str | None, new: str | None, outline: LaunchOutline
) -> Phrase | None:
    if entry.kind == "argument" and setting == "default" and new is None:
        return phrase("callers must pass '{name}'", name=entry.name)
    is_name = setting in _BREAKING_SETTINGS or setting.startswith("remapping ")
    if entry.kind != "node" or not is_name or _USER_INTERFACE.match(entry.name):
        return None
    if setting == "remappings" and _are_remapped_elsewhere(old or "", outline):
        return None
    return phrase("programs that use the names of the node, its topics or its services do not find them")


def _are_remapped_elsewhere(remappings: str, outline: LaunchOutline) -> bool:
    """Return whether the arguments of nodes contain the names, as a spawner's ``--controller-ros-args`` can."""
    names = set(_NAME.findall(remappings))
    arguments = " ".join(entry.settings.get("arguments", "") for entry in outline.entries)
    return bool(names) and names <= set(_NAME.findall(arguments))
