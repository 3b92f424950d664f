"""Find renamed arguments, variables and environment variables of launch files."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from difflib import SequenceMatcher

from linkwright.review.launches.matching import Match
from linkwright.review.launches.outlines import CONDITION, READING, Entry, LaunchOutline
from linkwright.review.launches.titles import shorten_command

_NAMED_KINDS = ("argument", "variable", READING)
_SUBSTITUTION = re.compile(r"(\$\((?:var|arg|env|optenv) )([^() ]+)")
_MIN_SHARE_OF_USES = 0.5
"""The minimum share of the uses of a name that must be uses of the new name."""
_MIN_SIMILARITY_OF_NAMES = 0.6
_MIN_SIMILARITY_OF_USES = 0.8
_COMMON_DEFAULTS = frozenset({"", "''", "true", "false"})
"""The defaults that arguments of different meanings have."""
_Use = tuple[str, str, str]
"""The kind of an action, the setting, and its value, which contains a variable."""


def find_renamed_names(old: LaunchOutline, new: LaunchOutline) -> dict[str, str]:
    """Return the new names of renamed arguments, variables and environment variables, by old name.

    A name is a new name if the actions that used the old name use it. If neither the names nor the settings are alike,
    the same settings of actions must use it. If no action does, it must be similar and have the same settings, and no
    action may use the new name unless the old file used it, too, without a declaration.
    """
    renamed: dict[str, str] = {}
    for kind in _NAMED_KINDS:
        old_entries, new_entries = (_index_entries(outline, kind) for outline in (old, new))
        removed = [entry for name, entry in old_entries.items() if name not in new_entries]
        added = [entry for name, entry in new_entries.items() if name not in old_entries]
        scores = [
            (_compute_rename_score(a, b, old, new), i, k) for i, a in enumerate(removed) for k, b in enumerate(added)
        ]
        for score, i, k in sorted(scores, key=lambda item: (-item[0], item[1], item[2])):
            if score and removed[i].name not in renamed and added[k].name not in renamed.values():
                renamed[removed[i].name] = added[k].name
    return renamed


def rename_in_outline(outline: LaunchOutline, renamed: Mapping[str, str]) -> LaunchOutline:
    """Return an outline with the new names of arguments and of both kinds of variables."""
    if not renamed:
        return outline
    return replace(outline, entries=[rename_in_entry(entry, renamed) for entry in outline.entries])


def rename_in_entry(entry: Entry, renamed: Mapping[str, str]) -> Entry:
    """Return an action with the new names of arguments and of both kinds of variables."""
    return replace(
        entry,
        name=renamed.get(entry.name, entry.name)
        if entry.has_value or entry.kind == READING
        else rename_in_text(entry.name, renamed),
        settings={
            rename_in_text(name, renamed): rename_in_text(value, renamed) for name, value in entry.settings.items()
        },
    )


def _index_entries(outline: LaunchOutline, kind: str) -> dict[str, Entry]:
    return {entry.name: entry for entry in reversed(outline.entries) if entry.kind == kind}


def _compute_rename_score(old_entry: Entry, new_entry: Entry, old: LaunchOutline, new: LaunchOutline) -> float:
    """Return a score for how likely an argument was renamed; 0 if it was not."""
    names = {old_entry.name: new_entry.name}
    similarity = SequenceMatcher(None, old_entry.name, new_entry.name, autojunk=False).ratio()
    has_equal_settings = old_entry.settings == new_entry.settings
    value = old_entry.settings.get("default", old_entry.settings.get("value", ""))
    has_same_value = has_equal_settings and value.lower() not in _COMMON_DEFAULTS and old_entry.kind != READING
    is_alike = similarity >= _MIN_SIMILARITY_OF_NAMES or has_same_value
    old_uses, new_uses = (
        Counter(
            (kind, "" if is_alike else setting, rename_in_text(text, names))
            for kind, setting, text in _find_uses(outline, entry.name)
        )
        for outline, entry in ((old, old_entry), (new, new_entry))
    )
    if not old_uses:
        is_free = not new_uses or any(_find_uses(old, new_entry.name))  # the old name may be a misspelled declaration
        return similarity if has_equal_settings and similarity >= _MIN_SIMILARITY_OF_NAMES and is_free else 0.0
    common_uses = old_uses & new_uses
    unmatched_new = list((new_uses - common_uses).elements())
    similar_count = sum(
        any(_are_similar(use, other) for other in unmatched_new) for use in (old_uses - common_uses).elements()
    )
    share = (common_uses.total() + similar_count) / old_uses.total()
    return share + similarity + has_equal_settings if share >= _MIN_SHARE_OF_USES else 0.0


def _are_similar(old: _Use, new: _Use) -> bool:
    """Return whether two values with a variable are mostly equal.

    Examples are command lines that differ in one option.
    """
    return (
        old[:2] == new[:2] and SequenceMatcher(None, old[2], new[2], autojunk=False).ratio() >= _MIN_SIMILARITY_OF_USES
    )


def _find_uses(outline: LaunchOutline, name: str) -> Iterator[_Use]:
    """Yield the settings with a variable. Conditions are alike anywhere, so theirs name the action, too."""
    pattern = re.compile(rf"\$\((?:var|arg|env|optenv) {re.escape(name)}[ )]")
    for entry in outline.entries:
        for setting, text in (("", entry.name), *entry.settings.items()):
            if pattern.search(text):
                yield entry.kind, f"{CONDITION} of {entry.name}" if setting == CONDITION else setting, text


def rename_in_text(text: str, renamed: Mapping[str, str]) -> str:
    """Return a text with the new names of arguments and of both kinds of variables."""
    return _SUBSTITUTION.sub(lambda match: f"{match[1]}{renamed.get(match[2], match[2])}", text)


def rename_commands(matches: Sequence[Match]) -> list[Match]:
    """Return the pairs of actions, with the new commands of processes in the old handlers of events.

    Args:
        matches: the pairs of an old and a new action; None for an action that only one version has.
    """
    commands = {
        shorten_command(old.name): shorten_command(new.name)
        for old, new in matches
        if old is not None and new is not None and old.kind == "process"
    }
    return [(_rename_commands(old, commands), new) for old, new in matches]


def _rename_commands(entry: Entry | None, commands: Mapping[str, str]) -> Entry | None:
    if entry is None or entry.kind != "handler":
        return entry
    settings = dict(entry.settings)
    for old, new in commands.items():
        settings = {name: value.replace(old, new) for name, value in settings.items()}
    return replace(entry, settings=settings)
