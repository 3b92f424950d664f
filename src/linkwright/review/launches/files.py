"""The comparison of launch files: which arguments, nodes and files they have, with their settings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from difflib import SequenceMatcher
from pathlib import Path

from linkwright.diagnostics import Phrase, SourceText, foreign, phrase
from linkwright.review.changes import Location
from linkwright.review.file_pair import FilePair, UnreadableFileError
from linkwright.review.launches.effects import removal_reason, setting_reason, value_reason
from linkwright.review.launches.helpers import HelperFunctions
from linkwright.review.launches.markup import read_markup_outline, xml_tags, yaml_tags
from linkwright.review.launches.matching import MIN_SIMILARITY, matched_entries, replacements
from linkwright.review.launches.names import LaunchPythonFile
from linkwright.review.launches.outlines import CONDITION, CodePart, Entry, LaunchOutline
from linkwright.review.launches.python import ACTIONS, read_python_outline
from linkwright.review.launches.renames import renamed_names, with_new_names
from linkwright.review.launches.titles import added_entry, joined_titles, title
from linkwright.review.list_changes import change_text, excerpts
from linkwright.xacro.cache import read_document

_MAX_STATEMENTS = 3
"""The number of changed statements up to which each is shown."""
_Group = tuple[str, "str | None", "str | None", str]
"""A setting, its old and its new value, and why the change is breaking. A group may give a condition to all actions."""


def compare_launch_files(pair: FilePair) -> None:
    """Compare two versions of a launch file, without running them."""
    roots = {pair.old_file: pair.versions.old.root, pair.new_file: pair.versions.new.root}
    outlines = pair.read(lambda path: read_outline(path, roots[path]))
    if outlines is None:
        return
    old, new = outlines
    renamed = renamed_names(old, new)
    old = with_new_names(old, renamed)
    settings = _SettingChanges(pair, old, new)
    settings.add_renamed(renamed)
    gone: list[Entry] = []
    come: list[Entry] = []
    for old_entry, new_entry in matched_entries(old.entries, new.entries):
        if old_entry is not None and new_entry is not None:
            settings.compare(old_entry, new_entry)
        elif old_entry is not None:
            gone.append(old_entry)
        elif new_entry is not None:
            come.append(new_entry)
    gone, come = ([entry for entry in entries if not _keeps_name(entry)] for entries in (gone, come))
    replaced = replacements(gone, come)
    for old_entry, new_entry in replaced:
        text = phrase("{old} replaced by {new}", old=title(old_entry), new=title(new_entry))
        pair.add(text, pair.location(new_entry.span))
        settings.compare(old_entry, new_entry)
    settings.add_groups()
    for entry in come:
        if all(entry is not new_entry for _, new_entry in replaced):
            pair.add(added_entry(entry), pair.location(entry.span))
    for entry in gone:
        if all(entry is not old_entry for old_entry, _ in replaced):
            text = phrase("{entry} removed", entry=title(entry))
            pair.add(text, pair.location(entry.span, is_old=True), removal_reason(entry, old, new))
    _compare_code(pair, old.code, new.code)


def _keeps_name(entry: Entry) -> bool:
    return entry.is_same_name("to", None, entry.settings.get("to"))


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
        and SequenceMatcher(None, old.source, new.source, autojunk=False).ratio() >= MIN_SIMILARITY
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


class _SettingChanges:
    """The changed settings of actions. The same change of several actions is one.

    Args:
        pair: the file.
        old: the old outline, with the new names of arguments.
        new: the new outline.
    """

    def __init__(self, pair: FilePair, old: LaunchOutline, new: LaunchOutline) -> None:
        self._pair = pair
        self._old = old
        self._new = new
        self._groups: dict[_Group, list[tuple[Entry, Location | None, Phrase | None]]] = {}

    def add_renamed(self, renamed: Mapping[str, str]) -> None:
        """Add the arguments and variables with new names, by old name."""
        for old_name, new_name in renamed.items():
            entry = next(entry for entry in self._new.entries if entry.name == new_name and entry.has_value)
            is_argument = entry.kind == "argument" and "value" not in entry.settings
            text = phrase("{entry} renamed to '{name}'", entry=title(replace(entry, name=old_name)), name=new_name)
            self._pair.add(text, self._pair.location(entry.span), value_reason(old_name) if is_argument else None)

    def compare(self, old: Entry, new: Entry) -> None:
        """Add the changed settings of an action."""
        if old.kind == "process" and old.name != new.name:
            program = replace(new, name=new.name.lstrip("[").partition(",")[0].partition(" ")[0])
            self._add(program, "command", old.name, new.name, None)
        for name in dict.fromkeys([*new.settings, *old.settings]):
            old_value, new_value = old.settings.get(name), new.settings.get(name)
            if old_value != new_value and not new.is_same_name(name, old_value, new_value):
                reason = setting_reason(new, name, old_value, new_value, self._old, self._new)
                self._add(new, name, old_value, new_value, reason)

    def _add(self, entry: Entry, name: str, old: str | None, new: str | None, reason: Phrase | None) -> None:
        place = entry, self._pair.location(entry.span), reason
        key = name, old, new, "" if name == CONDITION else str(reason)
        self._groups.setdefault(key, []).append(place)

    def add_groups(self) -> None:
        """Add the changes to the file."""
        for (name, old, new, _), places in self._groups.items():
            location = places[0][1]
            reason = next((reason for _, _, reason in places if reason is not None), None)
            values = ("-" if value is None else value or "''" for value in (old, new))
            titles = joined_titles([entry for entry, _, _ in places])
            text = phrase("{entry}: {change}", entry=titles, change=change_text(name, *values))
            self._pair.add(text, location, reason)
