"""Report the changed settings of launch actions."""

from __future__ import annotations

import re
from collections.abc import Collection, Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from linkwright.diagnostics import Phrase, joined, joined_first, phrase, quoted_names
from linkwright.review.breaking import name_reason, names_reason, possible_name_reason, possible_names_reason
from linkwright.review.changes import MAX_NAMES, Location
from linkwright.review.file_pair import FilePair
from linkwright.review.files.parameters.names import find_lost_output_reason, offers_frame
from linkwright.review.launches.arguments.fixed import fix_value, free_value
from linkwright.review.launches.bridged_topics import explain_lost_arguments
from linkwright.review.launches.conditional_settings import SettingPair, find_changed_settings, keeps_meaning
from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.effects import (
    explain_argument_removal,
    find_setting_reason,
    is_about_callers,
    is_other_joint_state_publisher_started,
)
from linkwright.review.launches.environment_readers import explain_removed_reading
from linkwright.review.launches.include_trees import IncludeTree, find_same_parameter
from linkwright.review.launches.included import STARTING_KINDS, IncludedActions, Program, find_including_files
from linkwright.review.launches.including_files import IncludingFiles, describe_opposite_change
from linkwright.review.launches.lost_files import LostFiles
from linkwright.review.launches.lost_values import explain_enabled_namespace, explain_lost_frames, make_frames_reason
from linkwright.review.launches.moved_parameters import follow_moved_parameters
from linkwright.review.launches.outlines import (
    CONDITION,
    ENVIRONMENT_KIND,
    NAMESPACE,
    NAMESPACE_OF_INCLUDED,
    PARAMETER,
    READING,
    REMAPPING,
    SERVER_PARAMETER,
    Entry,
    LaunchOutline,
)
from linkwright.review.launches.programs.default_names import find_default_name
from linkwright.review.launches.renames import rename_in_text
from linkwright.review.launches.simulated_hardware import find_clock_reason
from linkwright.review.launches.static_transforms import SAME_TRANSFORM, compare_transforms
from linkwright.review.launches.titles import format_distinct_title, format_title, join_phrases, join_titles
from linkwright.review.launches.transforms import gets_transform, starts_robot_with_link
from linkwright.review.texts.excerpts import LONG_VALUE, differing_excerpts, shorten_middle
from linkwright.review.texts.list_changes import change_text
from linkwright.review.texts.merging import name_edit

_MIN_GROUP_SIZE = 3
"""The minimum number of added or removed parameters or remappings of a node that are reported as one change."""
_MAX_VALUE_CHARACTERS = 60
_TERM_END = re.compile(r" and (?=(?:if|unless|after) )")
"""The text between the terms of a condition."""
_ARGUMENT = re.compile(r"\$\((?:var|arg) ")
_NAMES = (NAMESPACE, "name")
"""The settings that are parts of the full name of a node."""
_PASSED_ARGUMENTS = "passed"
"""The group of arguments that an action passes to an included file."""
_LIFECYCLE = "lifecycle"
"""The setting that only lifecycle nodes have."""
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


@dataclass(frozen=True)
class _Setting:
    """A changed setting.

    Attributes:
        name: the name of the setting.
        old: the old value; None if there was none.
        new: the new value; None if there is none.
        reason: why the change is breaking; None if it is not.
        defaults: both values with the defaults of arguments if only one version uses arguments; None if they are
            unknown.
        keeps_names: whether the names of the nodes of an included file stay the same.
        includer: the path of an including file that changes the setting the other way round; None if there is none.
    """

    name: str
    old: str | None
    new: str | None
    reason: Phrase | None
    defaults: tuple[str, str] | None = None
    keeps_names: bool = False
    includer: str | None = None

    @property
    def edit(self) -> Hashable | None:
        """The replaced part of a remapping's target and the new part.

        None for other settings.
        """
        if not self.name.startswith(REMAPPING) or not self.old or not self.new:
            return None
        has_common_end = self.old[0] == self.new[0] or self.old[-1] == self.new[-1]
        return name_edit(self.old, self.new) if has_common_end else None

    @property
    def text(self) -> Phrase:
        """The change in one line."""
        text = self._change_text
        return phrase("{change}; their full names stay the same", change=text) if self.keeps_names else text

    @property
    def is_changed_number(self) -> bool:
        """Whether a parameter of a node has another number, which breaks nothing."""
        is_parameter = self.name.startswith(PARAMETER) and self.reason is None
        return is_parameter and all(_NUMBER.fullmatch(value or "") for value in (self.old, self.new))

    def describe_opposite_change(self) -> tuple[Phrase, Phrase]:
        """Return the line and the reason for a setting that an including file changes the other way round."""
        assert self.includer is not None
        assert self.reason is not None
        is_removed = self.new is None
        return describe_opposite_change(self._change_text, self.reason, self.includer, is_removed=is_removed)

    @property
    def _change_text(self) -> Phrase:
        old, new = (None if value is None else value or "''" for value in (self.old, self.new))
        if self.name == _LIFECYCLE:
            return phrase("is no longer a lifecycle node") if new is None else phrase("is a lifecycle node now")
        if old is None:
            return phrase("{parameter} {value} added", parameter=self.name, value=new or "")
        if new is None:
            return phrase("{parameter} {value} removed", parameter=self.name, value=old)
        if self.name == CONDITION and max(len(old), len(new)) > LONG_VALUE:
            return _format_condition_change(old, new)
        text = change_text(self.name, old, new)
        if self.defaults is None:
            return text
        if self.defaults[0] == self.defaults[1]:
            return phrase("{change} (the same by default)", change=text)
        if _ARGUMENT.search(new):
            return phrase("{change} ({value} by default)", change=text, value=self.defaults[1] or "''")
        return phrase("{change} (before, {value} by default)", change=text, value=self.defaults[0] or "''")


def _format_condition_change(old: str, new: str) -> Phrase:
    """Return the change to a long condition: its added or removed terms if the others are equal."""
    old_terms, new_terms = _TERM_END.split(old), _TERM_END.split(new)
    added = [term for term in new_terms if term not in old_terms]
    removed = [term for term in old_terms if term not in new_terms]
    if added and removed:
        before, after = differing_excerpts(old, new)
        return phrase("{parameter} {old} -> {new}", parameter=CONDITION, old=before, new=after)
    items = joined(added or removed)
    if added:
        return phrase("{parameter}: {items} added", parameter=CONDITION, items=items)
    return phrase("{parameter}: {items} removed", parameter=CONDITION, items=items)


class SettingChanges:
    """The changed settings of actions.

    The same change to several actions is reported once.

    Args:
        pair: both versions of the file.
        old: the old outline, with the new names of arguments.
        new: the outline of the new file.
        renamed: the new names of arguments, by old name.
        included: the actions of both versions with those of the included files.
    """

    def __init__(
        self,
        pair: FilePair,
        old: LaunchOutline,
        new: LaunchOutline,
        renamed: Mapping[str, str],
        included: tuple[IncludedActions, IncludedActions],
    ) -> None:
        self._pair = pair
        self._old_included, self._included = included
        self._trees = IncludeTree(included[0]), IncludeTree(included[1])
        self._including_files = IncludingFiles(pair)
        self._old = old
        self._new = new
        self._lost_files = LostFiles((old, pair.versions.old), (new, pair.versions.new), pair.versions.changed_files)
        self._renamed = renamed
        self._old_names = {new_name: old_name for old_name, new_name in renamed.items()}
        self._remappings: dict[Hashable, list[tuple[Entry, Location | None, _Setting]]] = {}
        self._groups: dict[tuple[str, str], list[tuple[Entry, Location | None, Phrase, Phrase | None]]] = {}

    def report_renamed(self) -> None:
        """Report the arguments, variables and environment variables with new names."""
        named = {entry.name: entry for entry in reversed(self._new.entries) if entry.has_value or entry.kind == READING}
        pairs = ((old_name, named[new_name]) for old_name, new_name in self._renamed.items())
        for old_name, entry in sorted(pairs, key=lambda pair: (pair[1].span.line, pair[1].span.column)):
            is_argument = entry.kind == "argument" and "value" not in entry.settings
            reason = explain_argument_removal(old_name, is_ros1=self._old.is_ros1) if is_argument else None
            if entry.kind == READING:
                entry = replace(entry, kind=ENVIRONMENT_KIND)
                _, reason = explain_removed_reading(self._pair, old_name)
            text = phrase(
                "{entry} renamed to '{name}'", entry=format_title(replace(entry, name=old_name)), name=entry.name
            )
            self._pair.add(text, self._pair.location(entry.span), reason)

    def compare(self, old: Entry, new: Entry) -> None:
        """Collect the changed settings of an action."""
        is_same_command = keeps_meaning(old.name, new.name, self._old, self._new)
        if old.kind == "process" and old.name != new.name and not is_same_command:
            program = replace(new, name=new.name.lstrip("[").partition(",")[0].partition(" ")[0])
            self._collect(program, change_text("command", rename_in_text(old.name, self._old_names), new.name), None)
        settings = []
        if old.kind == "argument" and "default" in old.settings and "default" not in new.settings:
            old = fix_value(old) if "value" in new.settings else old
        elif old.kind == "argument" and "value" in old.settings and "value" not in new.settings:
            old = free_value(old)
            if "default" in new.settings:
                self._collect(new, phrase("a default now instead of a fixed value, so that callers can set it"), None)
        pairs = list(find_changed_settings(old, new, self._old, self._new))
        for pair in follow_moved_parameters(pairs, self._new, self._pair.versions.new):
            if self._sets_default_name(new, pair.name, pair.old, pair.new):
                continue
            defaults = pair.old_default, pair.new_default
            has_different_default = pair.has_defaults and defaults[0] != defaults[1]
            reason = self._find_reason(new, pair.name, *defaults) if has_different_default else None
            reason = reason or (self._lost_files.find_reason(new, pairs) if pair.name == "parameters" else None)
            if reason is None and pair.name == "arguments":
                reason = explain_lost_arguments(old, new, self._old, self._new)
            if reason is None and pair.new is None and old.settings.get("parameters") == new.settings.get("parameters"):
                reason = find_lost_output_reason(pair.name, self._old.resolve(pair.old_default or ""), new.settings)
            reason = reason or explain_lost_frames(new, pair.name, pair.old, pair.new, self._old)
            reason = reason or explain_enabled_namespace(pair.name, pair.old, pair.new, self._old)
            if new.kind == READING and reason is None:
                continue
            keeps_names = reason is not None and self._keeps_names(old, new, pair.name)
            is_renamed = new.kind == "argument" and new.name in self._old_names
            is_kept = keeps_names or (is_renamed and reason is not None and is_about_callers(reason))
            reason = None if is_kept else reason
            old_text = None if pair.old is None else rename_in_text(pair.old, self._old_names)
            transform = compare_transforms(old.name, new.name, old_text, pair.new) if pair.name == "arguments" else None
            if transform is not None:
                self._collect(new, transform, None if transform == SAME_TRANSFORM else reason)
                continue
            keeps_names = keeps_names and new.kind == "include"
            includer = self._including_files.find_opposite_change(new, pair.name, *defaults) if reason else None
            setting = _Setting(
                pair.name, old_text, pair.new, reason, self._find_defaults(new, pair), keeps_names, includer
            )
            if setting.edit is None:
                settings.append(setting)
            else:
                occurrence = new, self._pair.location(new.span), setting
                self._remappings.setdefault((setting.edit, reason is None), []).append(occurrence)
        for setting in [setting for setting in settings if setting.includer is not None]:
            settings.remove(setting)
            self._collect(new, *setting.describe_opposite_change())
        for text, reason, name in _group_settings(settings, is_include=new.kind == "include"):
            if name == CONDITION and reason is None and self._stops_by_default(old, new):
                text = phrase("{change}; by default, it no longer starts", change=text)
            # A group may give a condition to actions that other programs need and to those of a user interface.
            self._collect(new, text, reason, separates_reasons=name != CONDITION)

    def _stops_by_default(self, old: Entry, new: Entry) -> bool:
        """Return whether an action starts by default in the old version only."""
        conditions = ((self._old, old), (self._new, new))
        results = [
            evaluate_condition(outline.resolve(entry.settings.get(CONDITION, ""))) for outline, entry in conditions
        ]
        return results == [True, False] and new.kind in ("node", "include", "process")

    def _find_defaults(self, entry: Entry, pair: SettingPair) -> tuple[str, str] | None:
        """Return both values of a setting with the defaults of arguments, if only one version uses arguments."""
        if entry.kind in ("argument", "variable", READING) or pair.name == CONDITION:
            return None
        if pair.old is None or pair.new is None or (pair.old, pair.new) != (pair.old_default, pair.new_default):
            return None
        if (_ARGUMENT.search(pair.old) is None) == (_ARGUMENT.search(pair.new) is None):
            return None
        values = self._old.resolve(pair.old), self._new.resolve(pair.new)
        if values[0] == values[1]:
            return values
        is_list = pair.name in ("parameters", "arguments")
        is_known = not is_list and all("$(" not in value and len(value) <= _MAX_VALUE_CHARACTERS for value in values)
        return values if is_known else None

    def _find_reason(self, entry: Entry, setting: str, old: str | None, new: str | None) -> Phrase | None:
        """Return the reason why a changed setting is breaking, or None if it is not.

        It may change shared names or stop nodes.
        """
        reason = find_setting_reason(entry, setting, old, new, self._old, self._new)
        if setting.startswith(REMAPPING) and self._included.offers_bridged_topic(self._old.resolve(old or "")):
            return None
        if reason is not None and setting.startswith(PARAMETER) and offers_frame(setting.removeprefix(PARAMETER)):
            # programs still find the transform of the old frame
            frames = self._old.resolve(old or ""), self._new.resolve(new or "")
            versions = self._pair.versions
            has_frame = starts_robot_with_link(frames[0], self._included, versions.new)
            is_repair = gets_transform(entry.name, *frames, self._old_included, self._included, versions.old)
            return None if has_frame or is_repair else reason
        if entry.kind == "include":
            if setting == CONDITION:
                return reason if self._included.count_started_programs(entry) else None
            return reason or self._find_passed_value_reason(entry, setting, old)
        if entry.kind == "argument" and setting == "default" and reason is None and old is not None:
            reason = find_clock_reason(entry.name, old, new or "", self._list_names())
            if reason is not None:
                return None if any(find_including_files(self._pair.versions.new, self._pair.new_path)) else reason
            started = self._included.count_all_started_programs()
            stopped = self._included.count_all_started_programs({entry.name: old}) - started
            stopped &= self._old_included.count_all_started_programs() - started
            missing = [each for each in stopped if not is_other_joint_state_publisher_started(each[1], self._new)]
            return _explain_stopped_programs(missing) if missing else None
        return reason

    def _list_names(self) -> list[str]:
        """Return the path of the launch file, and the names of its included files and programs."""
        outlines = (self._new, *self._included.included_outlines)
        started = [entry for outline in outlines for entry in outline.entries if entry.kind in STARTING_KINDS]
        return [self._pair.new_path, *(f"{entry.name} {entry.settings.get('arguments', '')}" for entry in started)]

    def _keeps_names(self, old: Entry, new: Entry, setting: str) -> bool:
        """Return whether a changed setting leaves the full names as they were, because included files follow it."""
        old_tree, new_tree = self._trees
        if old.kind == SERVER_PARAMETER:
            return find_same_parameter(old, old_tree, new_tree) is not None
        if setting != NAMESPACE_OF_INCLUDED:
            return False
        old_names = old_tree.find_node_names(old)
        return old_names is not None and old_names == new_tree.find_node_names(new)

    def _find_passed_value_reason(self, include: Entry, setting: str, old: str | None) -> Phrase | None:
        """Return the reason why a different value for an included file is breaking, or None."""
        other_settings = {name: value for name, value in include.settings.items() if name != setting}
        old_include = replace(include, settings=other_settings if old is None else {**other_settings, setting: old})
        stopped = self._included.count_started_programs(old_include) - self._included.count_started_programs(include)
        stopped &= self._old_included.count_started_programs(old_include)
        return _explain_stopped_programs(stopped) if stopped else None

    def _sets_default_name(self, entry: Entry, setting: str, old: str | None, new: str | None) -> bool:
        """Return whether a setting sets the default name of a node or topic."""
        if entry.kind == "node" and setting == "name" and None in (old, new):
            return find_default_name(self._pair.versions.new.root, entry.name) == (old or new)
        return entry.is_identity_remapping(setting, old, new)

    def _collect(self, entry: Entry, text: Phrase, reason: Phrase | None, *, separates_reasons: bool = True) -> None:
        occurrence = entry, self._pair.location(entry.span), text, reason
        self._groups.setdefault((str(text), str(reason) if separates_reasons else ""), []).append(occurrence)

    def _collect_remappings(self) -> None:
        """Collect the changed remappings. Equal edits of several targets are one change."""
        for occurrences in self._remappings.values():
            edits = {(setting.name, setting.old, setting.new) for _, _, setting in occurrences}
            if len(occurrences) < _MIN_GROUP_SIZE or len(edits) == 1:
                for entry, _, setting in occurrences:
                    self._collect(entry, setting.text, setting.reason)
                continue
            entries = [entry for entry, _, _ in occurrences]
            names = list(dict.fromkeys(f"{setting.old} -> {setting.new}" for _, _, setting in occurrences))
            text = phrase("remappings {items}", items=joined_first(names, MAX_NAMES))
            text = phrase("{entry}: {change}", entry=join_titles(entries), change=text)
            self._pair.add(text, occurrences[0][1], _join_reasons([setting for _, _, setting in occurrences]))

    def report_groups(self) -> None:
        """Report the collected changes for the file."""
        self._collect_remappings()
        for occurrences in self._groups.values():
            _, location, change, _ = occurrences[0]
            reason = next((reason for _, _, _, reason in occurrences if reason is not None), None)
            entries = [entry for entry, _, _, _ in occurrences]
            titles = [self._format_title(entry, entries, str(change)) for entry in entries]
            text = phrase("{entry}: {change}", entry=join_phrases(titles), change=change)
            self._pair.add(text, location, reason)
            if len(set(titles)) == 1:  # a report counts equal changes
                for _, other_location, _, _ in occurrences[1:]:
                    self._pair.add(text, other_location, reason)

    def _format_title(self, entry: Entry, changed: Sequence[Entry], change: str) -> Phrase:
        """Return the title of an action, with the node name if the title is ambiguous.

        The name is added if an unchanged action has the same title, and the change does not already show the name.
        """
        nodes_with_title = [
            other for other in self._new.entries if other.kind == "node" and format_title(other) == format_title(entry)
        ]
        if entry.kind != "node" or all(
            any(other is changed_entry for changed_entry in changed) for other in nodes_with_title
        ):
            return format_distinct_title(entry, self._new.entries)
        name = "/".join(filter(None, (entry.settings.get(NAMESPACE), entry.settings.get("name"))))
        is_shown = not name or f" {name}" in change
        return format_title(entry) if is_shown else phrase("{entry} ({items})", entry=format_title(entry), items=name)


def _explain_stopped_programs(programs: Collection[Program]) -> Phrase:
    """Return the reason why it is breaking that programs do not start by default."""
    names = [quoted_names([name]) for name in sorted({name for _, name in programs})]
    if len(names) == 1:
        return phrase("by default, {entry} no longer starts", entry=names[0])
    return phrase("by default, {entries} no longer start", entries=joined_first(names, MAX_NAMES))


def _find_stopped_programs(reason: Phrase) -> str | None:
    """Return the programs that do not start by default, if that is the reason; None for other reasons."""
    names = reason.arguments.get("entry", reason.arguments.get("entries"))
    is_stop = reason.template.endswith(("} no longer starts", "} no longer start"))
    return names if is_stop and isinstance(names, str) else None


def _group_settings(
    settings: Sequence[_Setting], *, is_include: bool = False
) -> Iterator[tuple[Phrase, Phrase | None, str]]:
    """Yield the changes of the settings of an action with their reasons and names.

    Several added or removed parameters, remappings or arguments of an included file are one change, and so are several
    numbers.
    """
    groups: dict[object, list[_Setting]] = {}
    for setting in settings:
        prefix = next((word for word in (PARAMETER, REMAPPING) if setting.name.startswith(word)), "")
        if is_include and setting.name not in (CONDITION, NAMESPACE_OF_INCLUDED):
            prefix = _PASSED_ARGUMENTS
        has_both = setting.old is not None and setting.new is not None
        has_lost_frames = setting.reason is not None and setting.reason.template == make_frames_reason("").template
        is_single = not prefix or (has_both and not has_lost_frames and not setting.is_changed_number)
        is_lost_name = setting.name in _NAMES and setting.new is None and setting.reason is not None
        key: object = _NAMES if is_lost_name else setting.name
        key = key if is_single else (prefix, has_both, setting.new is None, setting.reason is None)
        groups.setdefault(key, []).append(setting)
    for key, group in groups.items():
        if key is _NAMES:
            yield joined([setting.text for setting in group]), _join_reasons(group), group[0].name
        elif len(group) < _MIN_GROUP_SIZE:
            yield from ((setting.text, setting.reason, setting.name) for setting in group)
        else:
            yield _format_group(group, is_include=is_include), _join_reasons(group), group[0].name


def _format_group(group: Sequence[_Setting], *, is_include: bool) -> Phrase:
    """Return several added or removed settings of an action as one change."""
    is_remapping, is_added = group[0].name.startswith(REMAPPING), group[0].new is not None
    if group[0].old is not None and group[0].new is not None:
        changes = [str(setting.text).removeprefix("parameter ") for setting in group]
        limit = len(changes) if group[0].is_changed_number else MAX_NAMES
        return phrase("parameters {items}", items=joined_first(changes, limit))
    items = joined_first([_format_setting(setting) for setting in group], MAX_NAMES)
    if is_include:
        added, removed = (
            phrase("arguments added: {items}", items=items),
            phrase("arguments removed: {items}", items=items),
        )
        return added if is_added else removed
    if is_remapping:
        return (
            phrase("remappings added: {items}", items=items)
            if is_added
            else phrase("remappings removed: {items}", items=items)
        )
    return (
        phrase("parameters added: {items}", items=items)
        if is_added
        else phrase("parameters removed: {items}", items=items)
    )


def _format_setting(setting: _Setting) -> str:
    value = shorten_middle(setting.new or setting.old or "''", _MAX_VALUE_CHARACTERS)
    if setting.name.startswith(REMAPPING):
        return f"{setting.name.removeprefix(REMAPPING)} -> {value}"
    return f"{setting.name.removeprefix(PARAMETER)} {value}"


def _join_reasons(group: Sequence[_Setting]) -> Phrase | None:
    """Return one reason for a group of settings, with all names that it breaks."""
    reasons = [setting.reason for setting in group if setting.reason is not None]
    stopped = dict.fromkeys(filter(None, map(_find_stopped_programs, reasons)))
    if len(stopped) > 1:
        return phrase("by default, {entries} no longer start", entries=joined(stopped))
    if len(set(map(str, reasons))) < 2 or any(reason.arguments.keys() != {"name"} for reason in reasons):
        return reasons[0] if reasons else None
    certain = [reason for reason in reasons if reason.template == name_reason("").template]
    names = list(dict.fromkeys(str(reason.arguments["name"]) for reason in certain or reasons))
    is_possible = all(reason.template == possible_name_reason("").template for reason in reasons)
    return possible_names_reason(names) if is_possible else names_reason(names)
