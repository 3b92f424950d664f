"""The comparison of launch files: which arguments, nodes and files they have, with their settings."""

from __future__ import annotations

from itertools import zip_longest

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.file_pair import FilePair
from linkwright.review.launch_outlines import Entry, read_outline

_BREAKING_SETTINGS = ("name", "namespace", "remappings", "exec_name")


def compare_launch_files(pair: FilePair) -> None:
    """Compare two versions of a launch file, without running them."""
    outlines = pair.read(read_outline)
    if outlines is None:
        return
    old_entries, new_entries = map(_by_name, outlines)
    for key in dict.fromkeys([*new_entries, *old_entries]):
        for old_entry, new_entry in zip_longest(old_entries.get(key, ()), new_entries.get(key, ())):
            if old_entry is None:
                pair.add(phrase("{entry} added", entry=_title(new_entry)), pair.location(new_entry.span))
            elif new_entry is None:
                text = phrase("{entry} removed", entry=_title(old_entry))
                pair.add(text, pair.location(old_entry.span, is_old=True), _removal_reason(old_entry))
            else:
                _compare_settings(pair, old_entry, new_entry)


def _by_name(entries: list[Entry]) -> dict[tuple[str, str, str], list[Entry]]:
    """Return the entries by kind and name; nodes that share an executable also by their names."""
    counts: dict[tuple[str, str], int] = {}
    for entry in entries:
        counts[entry.kind, entry.name] = counts.get((entry.kind, entry.name), 0) + 1
    by_name: dict[tuple[str, str, str], list[Entry]] = {}
    for entry in entries:
        node_name = entry.settings.get("name", "") if counts[entry.kind, entry.name] > 1 else ""
        by_name.setdefault((entry.kind, entry.name, node_name), []).append(entry)
    return by_name


def _compare_settings(pair: FilePair, old: Entry, new: Entry) -> None:
    for name in dict.fromkeys([*new.settings, *old.settings]):
        old_value, new_value = old.settings.get(name), new.settings.get(name)
        if old_value == new_value:
            continue
        text = phrase(
            "{entry}: {setting} {old} -> {new}",
            entry=_title(new),
            setting=name,
            old="-" if old_value is None else old_value or "''",
            new="-" if new_value is None else new_value or "''",
        )
        pair.add(text, pair.location(new.span), _setting_reason(new, name, new_value))


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
    if entry.kind == "node":
        return phrase("the topics and services of the node are missing")
    return None


def _setting_reason(entry: Entry, setting: str, new: str | None) -> Phrase | None:
    if entry.kind == "argument" and setting == "default" and new is None:
        return phrase("callers must pass '{name}'", name=entry.name)
    if entry.kind == "node" and (setting in _BREAKING_SETTINGS or setting.startswith("remapping ")):
        return phrase("programs that use the names of the node, its topics or its services do not find them")
    return None
