"""Compare the elements that no compared robot shows."""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from linkwright.descriptions.comparison import ROS2_CONTROL, Difference
from linkwright.diagnostics import Phrase, counted, joined, phrase, quoted_names
from linkwright.diagnostics.phrase import count_shown
from linkwright.review.breaking import (
    MOVING_TYPES,
    call_reason,
    find_extension_reason,
    find_plugin_name_reason,
    frame_reason,
    joint_name_reason,
    world_reason,
)
from linkwright.review.changes import Change, Effect
from linkwright.review.controller_files import find_controller_file_reason
from linkwright.review.files.arms.semantics import find_removal_reason
from linkwright.review.joint_limits import find_written_reason
from linkwright.review.parts.argument_scopes import takes_argument, takes_parameter
from linkwright.review.parts.chosen_parts import find_left_out_reason, find_lost_choice_reason
from linkwright.review.parts.default_conditions import find_missing_part_reason, find_missing_plugin_reason
from linkwright.review.parts.default_values import is_same_by_default, names_same_topic_by_default
from linkwright.review.parts.elements import BLOCK, CONDITION_SEPARATOR, ItemComparison, PartDifference
from linkwright.review.parts.include_arguments import find_lost_choices
from linkwright.review.parts.item_comparisons import make_comparison
from linkwright.review.parts.made_names import makes_same_names
from linkwright.review.parts.missing_includes import has_missing_include, names_absent_package
from linkwright.review.parts.outline import PROPERTY, STATEMENTS, MacroOutline, uses_name
from linkwright.review.parts.part_pair import PartPair
from linkwright.review.parts.properties import find_distinguishing_conditions
from linkwright.review.parts.repeated_calls import find_repeated_call
from linkwright.review.plugins import find_sensor_reason
from linkwright.review.simulators import find_simulator_reason
from linkwright.review.texts.element_values import format_values
from linkwright.review.texts.excerpts import differing_excerpts
from linkwright.review.texts.merged_reasons import merge_reasons
from linkwright.review.texts.merging import name_edit
from linkwright.xmltree import Element

_MAX_CHARACTERS = 80
"""The maximum number of characters of a value in a line."""
_MAX_VALUES = 8
"""The maximum number of values of an added or removed element in a line."""
_MAX_WITH_CONTENTS = 8
"""The maximum number of added or removed elements whose values are all shown in one line."""
_MIN_PREFIXED = 3
"""The minimum number of values with the same new prefix that are one line."""
_MAX_LINES = 15
"""The maximum number of changes without a reason that are listed for a file."""
_NAMESPACE = "namespace"
"""A word in plugin tags that do not name a topic or frame by themselves."""
_CONDITION = re.compile(r" ?\[(?:if|unless) .*\]$")
"""The conditions at the end of the summary of an element."""
_XACRO = "xacro:"
_MATERIAL = "material"
_INCLUDE, _INSERT = "xacro:include", "xacro:insert_block"


def compare_contents(pair: PartPair, renamed: Mapping[str, str]) -> None:
    """Report the changes to elements that no compared robot shows.

    Args:
        pair: both versions of the file.
        renamed: the new names of macros, by old name.
    """
    changes = [
        _ReportedDifference(pair, None, difference)
        for difference in _find_hidden_differences(pair, make_comparison(pair), pair.old.root, pair.new.root)
    ]
    for name, macro in pair.new.macros.items():
        old_name = next((old for old, new in renamed.items() if new == name), name)
        old = pair.old.macros.get(old_name)
        if old is not None:
            comparison = make_comparison(pair, old, macro)
            differences = _find_hidden_differences(pair, comparison, old.element, macro.element)
            changes += (_ReportedDifference(pair, name, difference) for difference in differences)
    pair.changes += _merge_differences(changes)


def _find_hidden_differences(
    pair: PartPair, comparison: ItemComparison, old: Element, new: Element
) -> Iterator[PartDifference]:
    """Yield the differences between two elements that no compared robot shows.

    A robot that reads the file in one version only shows the whole file as added or removed.
    """
    is_in_one_version = pair.is_read(is_old=True) != pair.is_read(is_old=False)
    for difference in _drop_followed_links(list(comparison.differences(old, new))):
        if is_in_one_version or not _is_shown(pair, difference, old, new):
            yield difference


def _drop_followed_links(differences: Sequence[PartDifference]) -> Iterator[PartDifference]:
    """Yield the differences except in joints whose parents and children only follow renamed links."""
    renamed = {
        (difference.old, difference.new)
        for difference in differences
        if difference.value == "name" and difference.new_element is not None and difference.new_element.tag == "link"
    }
    for difference in differences:
        is_link = difference.path[-1] in ("parent", "child") and difference.value == "link"
        if not is_link or (difference.old, difference.new) not in renamed:
            yield difference


def _is_shown(pair: PartPair, difference: PartDifference, old: Element, new: Element) -> bool:
    """Return whether the compared robots show a difference that has an effect."""
    elements = difference.old_element, difference.new_element
    element = elements[1] or elements[0]
    assert element is not None
    sides = [is_old for is_old, element in zip((True, False), elements, strict=True) if element is not None]
    if difference.value == "conditions":
        return _is_condition_shown(pair, difference)
    if difference.value == BLOCK:
        return False  # it concerns all callers of the macro
    if difference.new is None and elements[1] is not None and pair.loses_parameter(elements[1], difference.value):
        return True  # the lost parameter is reported
    if None in (difference.old, difference.new) and f"${{{difference.value}}}" in (difference.old, difference.new):
        return True  # a call that passes a parameter on; the parameter itself is reported
    if element.tag == _MATERIAL and difference.is_whole and len(difference.path) == 1:
        return False  # robots only show the materials of their links
    if element.tag == PROPERTY:
        return difference.is_whole or _is_property_shown(pair, element.attributes.get("name", ""), old, new)
    if element.tag == _INCLUDE and _is_repeated_include(difference, old, new):
        return True
    if element.tag == _INCLUDE and any(_is_of_absent_package(pair, elements)):
        return False  # the robots are compared without it
    if element.tag in (_INCLUDE, _INSERT):
        return not find_lost_choices(pair, difference) and any(pair.is_read(is_old=is_old) for is_old in sides)
    macro = _find_macro(pair, new)
    if takes_parameter(macro, difference) or takes_argument(macro, difference):
        return False  # robots that pass the argument as the parameter have the same value as before
    return any(pair.is_expanded(elements[0 if is_old else 1], is_old=is_old) for is_old in sides)


def _find_macro(pair: PartPair, element: Element) -> MacroOutline | None:
    """Return the new macro with an element; None for another element, such as the root of the file."""
    return next((macro for macro in pair.new.macros.values() if macro.element is element), None)


def _is_repeated_include(difference: PartDifference, old: Element, new: Element) -> bool:
    """Return whether only one version has an include twice, without a condition."""
    root, element = (new, difference.old_element) if difference.new_element is None else (old, difference.new_element)
    name = None if element is None else element.attributes.get("filename")
    return difference.is_whole and any(other.attributes.get("filename") == name for other in root.elements(_INCLUDE))


def _is_of_absent_package(pair: PartPair, elements: tuple[Element | None, Element | None]) -> Iterator[bool]:
    """Yield for each version whether an include names a file of a package that is not found."""
    sides = (pair.versions.old, pair.old_path), (pair.versions.new, pair.new_path)
    for element, (version, path) in zip(elements, sides, strict=True):
        if element is not None:
            yield names_absent_package(version, path, element.attributes.get("filename", "").strip())


def _is_condition_shown(pair: PartPair, difference: PartDifference) -> bool:
    """Return whether the compared robots show a change to the conditions of an element.

    An added or removed condition can have an effect with different arguments, even if all compared robots have the
    element.
    """
    has_old = pair.is_expanded(difference.old_element, is_old=True)
    has_new = pair.is_expanded(difference.new_element, is_old=False)
    old, new = ((text or "").split(CONDITION_SEPARATOR) for text in (difference.old, difference.new))
    is_added_or_removed = set(filter(None, old)) < set(new) or set(filter(None, new)) < set(old)
    return has_old != has_new or (has_old and has_new and not is_added_or_removed)


def _is_property_shown(pair: PartPair, name: str, old: Element, new: Element) -> bool:
    """Return whether a compared robot has an element that uses a property.

    The use can be direct or through other properties.
    """
    is_used = False
    for root, is_old in ((old, True), (new, False)):
        names, pending = {name}, [name]
        while pending:
            property_name = pending.pop()
            for element in root.walk():
                if not uses_name(element, property_name):
                    continue
                is_used = True
                other = element.attributes.get("name", "")
                if element.tag == PROPERTY and other not in names:
                    names.add(other)
                    pending.append(other)
                if pair.is_expanded(element, is_old=is_old):
                    return True
    return not is_used and any(pair.is_read(is_old=is_old) for is_old in (True, False))


# --- sentences -------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _ReportedDifference:
    """A difference in a file or macro, with its sentence.

    Attributes:
        pair: both versions of the file.
        macro: the macro that contains it, or None outside of macros.
        difference: the difference between both versions.
        shows_contents: whether the line about an added or removed element contains its values.
    """

    pair: PartPair
    macro: str | None
    difference: PartDifference
    shows_contents: bool = True

    @property
    def element(self) -> str:
        """The path of the changed element with the attribute."""
        words = [*self.difference.path]
        if len(words) > 1 and words[0] == f"gazebo {words[1]}":
            words[0] = "gazebo"
        if self.difference.value not in ("", "text", "conditions", BLOCK):
            words.append(self.difference.value)
            scope = self.pair.new.root if self.macro is None else self.pair.new.macros[self.macro].element
            conditions = find_distinguishing_conditions(scope, self.difference.new_element)
            words += [f"[{CONDITION_SEPARATOR.join(conditions)}]"] if conditions else []
        element = self.difference.new_element
        if self.difference.value == "conditions" and element is not None and element.tag == _INCLUDE:
            words.append(element.attributes.get("filename", ""))
        return " ".join(words)

    @property
    def change(self) -> Change:
        """The change in one line."""
        collector = replace(self.pair, changes=[])
        text = self.add_macro(self._describe())
        collector.add(text, self.difference.old_element, self.difference.new_element, self.reason)
        return collector.changes[0]

    @property
    def present_value(self) -> str:
        """The value of the version that has one."""
        return (self.difference.new if self.difference.old is None else self.difference.old) or ""

    def add_macro(self, text: Phrase) -> Phrase:
        """Return a sentence about the difference with the macro that contains it."""
        return text if self.macro is None else phrase("macro '{macro}': {text}", macro=self.macro, text=text)

    @property
    def call_key(self) -> Hashable | None:
        """A key that is equal for values that one call of a macro newly passes, or no longer passes.

        None for other and for breaking changes.
        """
        difference = self.difference
        element, tag = difference.new_element or difference.old_element, difference.path[-1].partition(" ")[0]
        is_call = element is not None and element.tag.startswith(_XACRO) and element.tag not in STATEMENTS
        is_value = is_call and not difference.is_whole and difference.value not in ("", "text", "conditions")
        if not is_value or None not in (difference.old, difference.new) or self.reason is not None:
            return None
        return id(element), difference.old is None, tag

    @property
    def added_prefix(self) -> str:
        """The expression that a name newly has at its start; empty for other differences."""
        old, new = self.difference.old, self.difference.new
        if self.difference.value == "conditions" or not old or not new or old == new or not new.endswith(old):
            return ""
        prefix = new.removesuffix(old)
        return prefix if prefix.startswith("${") and prefix.endswith("}") else ""

    @property
    def key(self) -> Hashable:
        """A key that is equal for changes that can be merged into one line."""
        difference = self.difference
        is_breaking = self.reason is not None
        if difference.is_whole:
            element = difference.new_element or difference.old_element
            return is_breaking, self.macro, difference.new is None, difference.path[:-1], element and element.tag
        if is_breaking:
            edit = name_edit(difference.old or "", difference.new or "") if difference.new else difference.path[-1]
            return self.macro, difference.value, len(difference.path), edit
        return self.macro, difference.value == "conditions", difference.old, difference.new

    @property
    def name(self) -> str:
        """The name of the element in a merged line: its path, or both names of a renamed element."""
        if self.difference.value == "name" and self.difference.new is not None:
            return f"{self.difference.old} -> {self.difference.new}"
        return self.element

    def find_name_beside(self, first: _ReportedDifference) -> str | None:
        """Return the name to list after the first element; None if it adds nothing.

        Elements with different values are listed with the values, and elements without a name with their attributes.
        """
        if self.element != first.element:
            has_other_contents = self.shows_contents and str(self.contents) != str(first.contents)
            return f"{self.name}: {self.contents}" if has_other_contents and self.contents is not None else self.name
        difference = self.difference
        if difference.path[-1] == _INCLUDE.removeprefix(_XACRO) and difference.value == "filename":
            return difference.new
        value, first_value = (changed.new or changed.old or "" for changed in (difference, first.difference))
        return f"{self.element} {_truncate(value)}" if difference.is_whole and value != first_value else None

    def _describe(self) -> Phrase:
        difference = self.difference
        if difference.value == "conditions":
            old, new = (
                text or phrase("always") for text in _shorten_values(difference.old or "", difference.new or "")
            )
            return phrase("{element}: condition {old} -> {new}", element=self.element, old=old, new=new)
        if difference.value == BLOCK:
            return self._describe_block()
        if difference.new is None or difference.old is None:
            return self._describe_presence()
        old, new = _shorten_values(difference.old, difference.new)
        text = phrase("{element}: {old} -> {new}", element=self.element, old=old or "-", new=new or "-")
        return phrase("{change} (the same by default)", change=text) if self._is_same_by_default else text

    def _describe_block(self) -> Phrase:
        """Return the sentence about an element that a block of the caller replaces, or the reverse."""
        difference, old = self.difference, self.difference.old_element
        if old is not None and old.tag == _INSERT:
            name, value = old.attributes.get("name", ""), _truncate(difference.new or "")
            return phrase(
                "{element}: block '{name}' of the caller -> {new}", element=self.element, name=name, new=value
            )
        name, value = difference.path[-1].partition(" ")[0], _truncate(difference.old or "")
        return phrase("{element}: {old} -> block '{name}' of the caller", element=self.element, name=name, old=value)

    def _describe_presence(self) -> Phrase:
        """Return the sentence about an added or removed value or element."""
        difference = self.difference
        value = _truncate(self.present_value)
        name = f"{self.element} {value}".strip()
        text = phrase("{element} added", element=name)
        if difference.new is None:
            text = phrase("{element} removed", element=name)
        contents = self.contents if self.shows_contents else None
        return text if contents is None else phrase("{change}: {contents}", change=text, contents=contents)

    @property
    def contents(self) -> Phrase | None:
        """The values in an added or removed element, or None if there are none."""
        element = self.difference.new_element or self.difference.old_element
        return format_values(element, _MAX_VALUES) if self.difference.is_whole and element is not None else None

    @cached_property
    def _is_same_by_default(self) -> bool:
        return is_same_by_default(self.pair, self.macro, self.difference)

    @property
    def reason(self) -> Phrase | None:
        """The reason why the change is breaking, or None if it is not."""
        difference, old = self.difference, self.difference.old_element
        macro = None if self.macro is None else self.pair.new.macros.get(self.macro)
        if self._is_same_by_default or takes_parameter(macro, difference):
            return None
        if old is None:
            return self._find_default_topic_reason() or self._find_repeated_call_reason()
        if difference.value == "conditions":
            return self._find_condition_reason(difference.old or "", difference.new or "")
        lost_choices = find_lost_choices(self.pair, difference)
        if lost_choices:
            return phrase("callers that pass {names} get another file", names=quoted_names(lost_choices))
        is_removed = difference.is_whole or difference.value == "name"
        if len(difference.path) == 1 and old.tag in ("link", "joint"):
            name = old.attributes.get("name", "")
            if not is_removed:
                return self._find_joint_reason(old)
            if self.pair.has_robot_with(old.tag, name) or self._is_passed_to_macro(name):
                return None
            if old.tag == "link":
                return frame_reason(name)
            return joint_name_reason(name) if old.attributes.get("type") in MOVING_TYPES else None
        if old.tag == "limit":
            return self._find_joint_reason(old)
        if len(difference.path) == 1 and difference.value == "name" and old.tag == "world":
            return world_reason(old.attributes.get("name", ""))
        is_call_changed = difference.new_element is None or (len(difference.path) == 1 and difference.value == "name")
        if is_call_changed and old.tag.startswith(_XACRO):
            return self._find_lost_call_reason(old)
        if len(difference.path) == 1 and is_removed and old.tag in ("group", "group_state", "end_effector"):
            return find_removal_reason(old.tag, old.attributes.get("name", ""))
        kind, name = difference.value, " ".join(difference.path[1:])
        if kind not in ("", "text"):
            name = f"{name} @{kind}".strip()
        root = difference.path[0]
        if not root.startswith(("gazebo", "ros2_control")):
            return None
        if difference.new_element is None and root.startswith("gazebo"):
            return self._find_lost_name_reason(old)
        if names_same_topic_by_default(self.pair, self.macro, difference):
            return None
        if difference.is_whole and not name:
            return find_extension_reason(Difference("extension", root, "removed"))
        changed = Difference("extension", root, "changed", name, difference.old or "-", difference.new)
        return (
            find_missing_plugin_reason(self.pair, self.macro, difference)
            or find_extension_reason(changed)
            or find_controller_file_reason(changed, self.pair.versions)
            or find_simulator_reason(changed, self.pair.versions, self.pair.new_path)
        )

    def _is_passed_to_macro(self, name: str) -> bool:
        """Return whether a call of a macro newly has a name, so that the macro may make the link or joint."""
        calls = [
            [element for element in outline.root.walk() if element.tag.startswith(_XACRO)]
            for outline in (self.pair.old, self.pair.new)
        ]
        old, new = (
            sum(element.tag not in STATEMENTS and name in element.attributes.values() for element in elements)
            for elements in calls
        )
        return new > old

    def _find_joint_reason(self, old: Element) -> Phrase | None:
        """Return the reason why a changed type or limit of a joint is breaking; None if it is not."""
        difference = self.difference
        tag, _, name = difference.path[0].partition(" ")
        if tag != "joint" or old.tag not in ("joint", "limit") or not difference.old or not difference.new:
            return None
        return find_written_reason(name, difference.value, difference.old, difference.new)

    def _find_condition_reason(self, old: str, new: str) -> Phrase | None:
        """Return the reason why other conditions of an element are breaking, or None if they are not."""
        old_conditions = old.split(CONDITION_SEPARATOR)
        element = self.difference.new_element
        if element is None or element.tag == PROPERTY:
            return find_lost_choice_reason(old, new)
        added = [condition for condition in new.split(CONDITION_SEPARATOR) if condition not in old_conditions]
        is_further = len(added) == len(new.split(CONDITION_SEPARATOR)) - len(list(filter(None, old_conditions)))
        reason = find_left_out_reason(self.pair.new, added) if is_further else None
        if reason is None and is_further:
            reason = find_missing_part_reason(self.pair, self.macro, self.difference)
        return reason or find_lost_choice_reason(old, new)

    def _find_default_topic_reason(self) -> Phrase | None:
        """Return the reason why an added topic of a sensor is breaking; None for other additions."""
        element, path = self.difference.new_element, self.difference.path
        if element is None or element.tag != "topic" or not self.difference.is_whole or len(path) < 2:
            return None
        sensors = [sensor for sensor in self.pair.new.root.walk() if sensor.tag == "sensor"]
        owner = next((sensor for sensor in sensors if any(child is element for child in sensor.elements())), None)
        return None if owner is None else find_sensor_reason(owner)

    def _find_repeated_call_reason(self) -> Phrase | None:
        """Return the reason why an added call of a macro is breaking: the file already makes the part; or None."""
        element = self.difference.new_element
        if self.macro is not None or element is None or not self.difference.is_whole or len(self.difference.path) > 1:
            return None
        name = find_repeated_call(self.pair.old.root, self.pair.new.root, element)
        return None if name is None else phrase("the robot has the links and joints of '{name}' twice", name=name)

    def _find_lost_call_reason(self, old: Element) -> Phrase | None:
        """Return the reason why a removed call of a macro, or its other name, is breaking.

        The result is None if the name is still used, and for another name of hardware, which nothing looks up.
        """
        name = old.attributes.get("name", "")
        is_call = old.tag not in STATEMENTS and bool(name)
        if is_call and self.pair.names_hardware(old):
            removed = Difference("extension", f"{ROS2_CONTROL} {name}", "removed")
            return find_extension_reason(removed) if self.difference.new_element is None else None
        is_lost = is_call and name not in _collect_words(self.pair.new.root) and not self._calls_missing_macro(old)
        return call_reason(name) if is_lost and not makes_same_names(self.pair, self.macro, old) else None

    def _calls_missing_macro(self, call: Element) -> bool:
        """Return whether the old version could not expand a call, because a file of the repository does not exist."""
        macro = call.tag.removeprefix(_XACRO)
        version = self.pair.versions.old
        return macro not in version.macros and has_missing_include(version, self.pair.old_path, self.pair.old.root)

    def _find_lost_name_reason(self, old: Element) -> Phrase | None:
        """Return the reason why removing a Gazebo element is breaking; None if it is not.

        It is not breaking if a different element has its names.
        """
        new_words = _collect_words(self.pair.new.root)
        for element in old.walk():
            text = " ".join(element.text().split())
            if text == "/" or _NAMESPACE in element.tag.lower():
                continue
            reason = find_plugin_name_reason(Difference("extension", "gazebo", "changed", element.tag, text or None))
            if reason is not None and not {text, *text.split(":=")[1:]} & new_words:
                return reason
        return None


def _merge_differences(differences: list[_ReportedDifference]) -> Iterator[Change]:
    """Yield the changes, equal ones in one line, and the number of changes beyond the limit."""
    calls: dict[Hashable, list[_ReportedDifference]] = {}
    groups: dict[Hashable, list[_ReportedDifference]] = {}
    for difference in differences:
        calls.setdefault(difference.call_key, []).append(difference)
    changes = list(_join_call_values([group for key, group in calls.items() if key is not None and len(group) > 1]))
    prefixed = _group_by_prefix(differences)
    changes += map(_join_prefixed, prefixed)
    joined_items = {id(difference) for group in prefixed for difference in group}
    for difference in differences:
        if id(difference) in joined_items:
            continue
        if difference.call_key is None or len(calls[difference.call_key]) == 1:
            groups.setdefault(difference.key, []).append(difference)
    for first, *others in groups.values():
        if len({str(difference.contents) for difference in (first, *others)}) > 1:
            shows_contents = len(others) < _MAX_WITH_CONTENTS
            first, *others = (replace(difference, shows_contents=shows_contents) for difference in (first, *others))
        names = dict.fromkeys(name for other in others if (name := other.find_name_beside(first)) is not None)
        reason = merge_reasons(described.reason for described in (first, *others))
        changes.append(replace(first.change, reason=reason, other_names=tuple(names)))
    breaking = [change for change in changes if change.effect is Effect.BREAKING]
    not_breaking = [change for change in changes if change.effect is not Effect.BREAKING]
    yield from breaking
    shown = count_shown(len(not_breaking), _MAX_LINES)
    yield from not_breaking[:shown]
    if len(not_breaking) > shown:
        text = counted("{count} more change", "{count} more changes", len(not_breaking) - shown)
        yield replace(not_breaking[shown], sentence=text, other_names=())


def _group_by_prefix(differences: Sequence[_ReportedDifference]) -> list[list[_ReportedDifference]]:
    """Return groups of values of a macro or file that get the same text at their start, such as ``${prefix}``."""
    groups: dict[Hashable, list[_ReportedDifference]] = {}
    for difference in differences:
        prefix = difference.added_prefix
        if prefix and difference.reason is None:
            groups.setdefault((difference.macro, prefix), []).append(difference)
    return [
        group
        for group in groups.values()
        if len(group) >= _MIN_PREFIXED and len({difference.difference.old for difference in group}) > 1
    ]


def _join_prefixed(group: Sequence[_ReportedDifference]) -> Change:
    """Return the line about values that get the same text at their start."""
    first, *others = group
    text = phrase("{element}: '{prefix}' added before the value", element=first.element, prefix=first.added_prefix)
    return replace(first.change, sentence=first.add_macro(text), other_names=tuple(other.element for other in others))


def _join_call_values(calls: Sequence[Sequence[_ReportedDifference]]) -> Iterator[Change]:
    """Yield a line about the values that calls of a macro newly pass, or no longer pass; equal ones in one line."""
    groups: dict[Hashable, list[Sequence[_ReportedDifference]]] = {}
    for call in calls:
        tag = call[0].difference.path[-1].partition(" ")[0]
        values = tuple((item.difference.value, item.difference.old, item.difference.new) for item in call)
        groups.setdefault((call[0].macro, tag, values), []).append(call)
    for first, *others in groups.values():
        is_added = first[0].difference.old is None
        values_text = joined([f"{item.difference.value} {_truncate(item.present_value)}" for item in first])
        text = phrase("{element}: {items} removed", element=_title_call(first), items=values_text)
        if is_added:
            text = phrase("{element}: {items} added", element=_title_call(first), items=values_text)
        names = tuple(map(_title_call, others))
        yield replace(first[0].change, sentence=first[0].add_macro(text), other_names=names)


def _title_call(call: Sequence[_ReportedDifference]) -> str:
    """Return the name of a call, or else its macro with the first value that it passes in both versions."""
    difference = call[0].difference
    element = difference.new_element or difference.old_element
    assert element is not None
    own = {item.difference.value for item in call}
    kept = next((f"{name}={_truncate(value)}" for name, value in element.attributes.items() if name not in own), "")
    has_name = " " in difference.path[-1]
    return " ".join(filter(None, (*difference.path, "" if has_name else kept)))


def _collect_words(root: Element) -> set[str]:
    """Return the words in texts and attributes, and the targets of remappings."""
    words: set[str] = set()
    for element in root.walk():
        for text in (element.text(), *element.attributes.values()):
            word = " ".join(text.split())
            words |= {word, *word.split(":=")[1:]}
    return words


def _truncate(text: str) -> str:
    """Return a text in one line, cut if it is long, but with all its conditions at the end."""
    text = " ".join(text.split())
    condition = _CONDITION.search(text)
    end = "" if condition is None else condition[0]
    start = text.removesuffix(end)
    return text if len(start) <= _MAX_CHARACTERS else f"{start[:_MAX_CHARACTERS]}...{end}"


def _shorten_values(old: str, new: str) -> tuple[str, str]:
    """Return two values in one line each, or their differing parts if one is long."""
    return differing_excerpts(" ".join(old.split()), " ".join(new.split()), _MAX_CHARACTERS)
