"""The comparison of launch files: which arguments, nodes and files they have, with their settings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from difflib import SequenceMatcher
from functools import partial
from pathlib import Path

from linkwright.diagnostics import Phrase, SourceText, foreign, phrase
from linkwright.review.changes import Location
from linkwright.review.file_pair import FilePair, UnreadableFileError
from linkwright.review.launches.effects import removal_reason, setting_reason
from linkwright.review.launches.helpers import HelperFunctions
from linkwright.review.launches.markup import read_markup_outline, xml_tags, yaml_tags
from linkwright.review.launches.names import LaunchPythonFile
from linkwright.review.launches.outlines import (
    CONDITION,
    NAMESPACE,
    NAMESPACE_OF_INCLUDED,
    CodePart,
    Entry,
    LaunchOutline,
)
from linkwright.review.launches.python import ACTIONS, read_python_outline
from linkwright.review.launches.titles import added_entry, joined_titles, title
from linkwright.review.list_changes import change_text, excerpts
from linkwright.xacro.cache import read_document

_SETTINGS_OF_GROUPS = (CONDITION, NAMESPACE, NAMESPACE_OF_INCLUDED)
"""The settings that a group gives to all its actions."""
_MAX_STATEMENTS = 3
"""The number of changed statements up to which each is shown."""
_MIN_SIMILARITY = 0.5
_Group = tuple[str, "str | None", "str | None", bool]
"""A setting, its old and its new value, and whether the change is breaking."""


def compare_launch_files(pair: FilePair) -> None:
    """Compare two versions of a launch file, without running them."""
    roots = {pair.old_file: pair.versions.old.root, pair.new_file: pair.versions.new.root}
    outlines = pair.read(lambda path: read_outline(path, roots[path]))
    if outlines is None:
        return
    old, new = outlines
    old_groups, new_groups = _by_name(old.entries), _by_name(new.entries)
    settings = _SettingChanges(pair, old, new)
    gone: list[Entry] = []
    come: list[Entry] = []
    for key in dict.fromkeys([*new_groups, *old_groups]):
        for old_entry, new_entry in _matched(old_groups.get(key, []), new_groups.get(key, [])):
            if old_entry is not None and new_entry is not None:
                settings.compare(old_entry, new_entry)
            elif old_entry is not None:
                gone.append(old_entry)
            elif new_entry is not None:
                come.append(new_entry)
    settings.add_those_of_groups()
    _add_lone_entries(pair, gone, come, old)
    _compare_code(pair, old.code, new.code)


def _add_lone_entries(pair: FilePair, gone: Sequence[Entry], come: Sequence[Entry], old: LaunchOutline) -> None:
    """Add the actions that only one version has. An action with another name and the same settings is replaced."""
    gone, come = ([each for each in entries if not _keeps_name(each)] for entries in (gone, come))
    replaced: set[int] = set()
    for entry in come:
        former = next((each for each in gone if id(each) not in replaced and _is_replaced(each, entry)), None)
        if former is None:
            pair.add(added_entry(entry), pair.location(entry.span))
        else:
            replaced.add(id(former))
            text = phrase("{old} replaced by {new}", old=title(former), new=title(entry))
            pair.add(text, pair.location(entry.span))
    for entry in gone:
        if id(entry) not in replaced:
            text = phrase("{entry} removed", entry=title(entry))
            pair.add(text, pair.location(entry.span, is_old=True), removal_reason(entry, old))


def _keeps_name(entry: Entry) -> bool:
    return entry.is_same_name("to", None, entry.settings.get("to"))


def _is_replaced(old: Entry, new: Entry) -> bool:
    """Return whether an action is another one under a new name: a variable, or a program or file of a new package."""
    if old.kind != new.kind or old.settings != new.settings or not (old.settings or old.kind == "include"):
        return False
    has_same_end = old.name.rpartition("/")[2] == new.name.rpartition("/")[2]
    return old.kind == "environment" or (old.kind in ("node", "include") and has_same_end)


def read_outline(path: Path, root: Path) -> LaunchOutline:
    """Return the outline of a launch file in Python, XML or YAML.

    Args:
        path: the file.
        root: the folder of the repository, which may contain functions that make actions.

    Raises:
        LinkwrightError: the file is not XML.
        UnreadableFileError: the file is not Python or YAML.
        OSError: the file cannot be read.
        ValueError: the file is not text in UTF-8.
    """
    if path.suffix in (".yaml", ".yml"):
        return read_markup_outline(yaml_tags(path))
    if path.suffix != ".py":
        return read_markup_outline(xml_tags(read_document(str(path)).root))
    try:
        python = LaunchPythonFile(SourceText(str(path), path.read_text("utf-8")))
    except SyntaxError as error:
        line, reason = error.lineno or 1, foreign(error.msg)
        message = phrase("line {line} is not valid Python: {reason}", line=line, reason=reason)
        raise UnreadableFileError(message) from None
    return read_python_outline(python, HelperFunctions(root, ACTIONS))


def _compare_code(pair: FilePair, old: Sequence[CodePart], new: Sequence[CodePart]) -> None:
    """Compare what is not an action: one changed statement as it is written, others in one sentence."""
    if [part.text for part in old] == [part.text for part in new]:
        return
    gone, come = _without_common(old, new), _without_common(new, old)
    location = pair.location(come[0].span) if come else None
    if gone and not come:
        location = pair.location(gone[0].span, is_old=True)
    if 1 <= len(gone) == len(come) <= _MAX_STATEMENTS and all(map(_are_versions, gone, come)):
        for old_part, new_part in zip(gone, come, strict=True):
            before, after = excerpts(old_part.source, new_part.source)
            pair.add(phrase("other code: {old} -> {new}", old=before, new=after), pair.location(new_part.span))
    else:
        pair.add(phrase("other code changed"), location)


def _are_versions(old: CodePart, new: CodePart) -> bool:
    """Return whether two statements are probably versions of the same one, and differ as they are written."""
    return (
        old.source != new.source
        and SequenceMatcher(None, old.source, new.source, autojunk=False).ratio() >= _MIN_SIMILARITY
    )


def _without_common(parts: Sequence[CodePart], others: Sequence[CodePart]) -> list[CodePart]:
    remaining = Counter(part.text for part in others)
    lone = []
    for part in parts:
        if remaining[part.text]:
            remaining[part.text] -= 1
        else:
            lone.append(part)
    return lone


def _by_name(entries: list[Entry]) -> dict[tuple[str, str], list[Entry]]:
    groups: dict[tuple[str, str], list[Entry]] = {}
    for entry in entries:
        groups.setdefault((entry.kind, "" if entry.kind == "process" else entry.name), []).append(entry)
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
    for similarity, i, k in candidates:
        if new_rest[k].kind == "process" and similarity < _MIN_SIMILARITY:
            continue
        if i in old_left and k in new_left:
            old_left.remove(i)
            new_left.remove(k)
            pairs.append((old_rest[i], new_rest[k]))
    yield from sorted(pairs, key=lambda item: new.index(item[1]))
    yield from ((None, new_rest[k]) for k in sorted(new_left))
    yield from ((old_rest[i], None) for i in sorted(old_left))


def _are_equal(old: Entry, new: Entry) -> bool:
    return old.settings == new.settings and _command(old) == _command(new)


def _command(entry: Entry) -> list[str]:
    return [entry.name] if entry.kind == "process" else []


def _have_same_node_name(old: Entry, new: Entry) -> bool:
    return "name" in new.settings and old.settings.get("name") == new.settings["name"]


def _similarity(old: Entry, new: Entry) -> float:
    """Return how much of the settings, and of the commands of processes, is equal, from 0 to 1."""
    old_words, new_words = (
        " ".join([*(f"{name}={value}" for name, value in entry.settings.items()), *_command(entry)]).split()
        for entry in (old, new)
    )
    return SequenceMatcher(None, old_words, new_words, autojunk=False).ratio()


class _SettingChanges:
    """The changed settings of entries. Those that a group gives to its actions are one change."""

    def __init__(self, pair: FilePair, old: LaunchOutline, new: LaunchOutline) -> None:
        self._pair = pair
        self._reason = partial(setting_reason, old_outline=old, new_outline=new)
        self._of_groups: dict[_Group, list[tuple[Entry, Location | None, Phrase | None]]] = {}

    def compare(self, old: Entry, new: Entry) -> None:
        """Add the changed settings of an entry."""
        location = self._pair.location(new.span)
        if old.name != new.name:
            program = replace(new, name=new.name.lstrip("[").partition(",")[0].partition(" ")[0])
            self._add([program], "command", old.name, new.name, location, None)
        for name in dict.fromkeys([*new.settings, *old.settings]):
            old_value, new_value = old.settings.get(name), new.settings.get(name)
            if old_value == new_value or new.is_same_name(name, old_value, new_value):
                continue
            reason = self._reason(new, name, old_value, new_value)
            if name in _SETTINGS_OF_GROUPS:
                group = (name, old_value, new_value, reason is None)
                self._of_groups.setdefault(group, []).append((new, location, reason))
            else:
                self._add([new], name, old_value, new_value, location, reason)

    def add_those_of_groups(self) -> None:
        """Add the changed settings that groups give to their actions."""
        for (name, old, new, _), places in self._of_groups.items():
            _, location, reason = places[0]
            self._add([entry for entry, _, _ in places], name, old, new, location, reason)

    def _add(
        self,
        entries: list[Entry],
        name: str,
        old: str | None,
        new: str | None,
        location: Location | None,
        reason: Phrase | None,
    ) -> None:
        values = ("-" if value is None else value or "''" for value in (old, new))
        text = phrase("{entry}: {change}", entry=joined_titles(entries), change=change_text(name, *values))
        self._pair.add(text, location, reason)
