"""Compare the YAML files from which generate_parameter_library generates the parameters of nodes and controllers."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from difflib import SequenceMatcher
from pathlib import PurePosixPath

import yaml

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.breaking import quote_first
from linkwright.review.changes import MAX_NAMES, Change, Effect, Location
from linkwright.review.file_pair import FilePair, UnreadableFileError
from linkwright.review.files.parameters.names import find_node_name
from linkwright.review.files.parameters.yaml_values import YamlValue, collect_values, compose_yaml, read_yaml_values
from linkwright.review.texts.excerpts import differing_excerpts, shorten_middle
from linkwright.review.versions import Version

_TYPES = re.compile(r"(?:bool|int|double|string|none)(?:_array)?(?:_fixed_\d+)?")
_TEXT_PROPERTIES: tuple[str, ...] = ("description", "additional_constraints")
_PROPERTIES = frozenset({"type", "default_value", "read_only", "validation", *_TEXT_PROPERTIES})
_SETTINGS_SUFFIXES = (".yaml", ".yml")
_PARAMETERS = "ros__parameters"
_LOWER = {"lower_bounds": False, "gt_eq": False, "gt": True}
_UPPER = {"upper_bounds": False, "lt_eq": False, "lt": True}
"""The rules with a limit, and whether the limit itself is not allowed."""
_MAP = re.compile(r"\A__map_(\w+)\Z")
"""A key that represents each name in the values of another parameter."""
_MAX_TEXT_CHARACTERS = 160
_MIN_SIMILARITY = 0.8
"""The minimum ratio of equal characters of the names of a renamed parameter."""


@dataclass(frozen=True)
class _Parameter:
    """A parameter in a description.

    Attributes:
        type: the type of its values.
        default: the default; empty if there is none.
        is_read_only: whether it cannot be set while the node runs.
        rules: the arguments of each rule for its values, by the name of the rule.
        texts: the description and the additional constraints, by key.
        line: the line of its name.
        column: the column of its name.
    """

    type: str
    default: str
    is_read_only: bool
    rules: Mapping[str, tuple[str, ...]]
    texts: Mapping[str, str]
    line: int
    column: int

    @property
    def is_required(self) -> bool:
        """Whether the node does not start without a value."""
        return not self.default and self.type != "none"


@dataclass
class _Range:
    """The numbers that the rules of a parameter allow, as limits with 1 if the limit itself is not allowed."""

    lower: tuple[float, int] = (-math.inf, 0)
    upper: tuple[float, int] = (math.inf, 0)
    names: set[str] = field(default_factory=set)

    def is_narrower_than(self, other: _Range) -> bool:
        """Return whether it excludes numbers that the other one allows."""
        upper, other_upper = ((-value, is_open) for value, is_open in (self.upper, other.upper))
        return self.lower > other.lower or upper > other_upper


def is_parameter_description(root: yaml.Node | None) -> bool:
    """Return whether a document describes the parameters of a generated library."""
    return isinstance(root, yaml.MappingNode) and len(root.value) > 0 and _read_parameters(root) is not None


def generates_code(version: Version, path: str) -> bool:
    """Return whether code is generated from a file, which no program reads while it runs."""
    if not path.endswith(_SETTINGS_SUFFIXES):
        return False
    try:
        return is_parameter_description(compose_yaml(version.text(path)))
    except UnreadableFileError:
        return False


def compare_generated_parameters(pair: FilePair, old_root: yaml.Node, new_root: yaml.Node) -> None:
    """Compare two versions of a description of parameters, parameter by parameter."""
    old, new = _read_parameters(old_root) or {}, _read_parameters(new_root) or {}
    for name, parameter in new.items():
        if name in old:
            location = Location(pair.new_path, parameter.line, parameter.column)
            for text, reason in _compare_parameter(name, old[name], parameter):
                pair.changes.append(_make_change(text, reason, location))
    added = {name: parameter for name, parameter in new.items() if name not in old}
    lost = {name: parameter for name, parameter in old.items() if name not in new}
    for old_name, new_name in list(_pair_similar(lost, added)):
        parameter = added.pop(new_name)
        names = [f"'{name}' ({item.default or item.type})" for name, item in (
            (old_name, lost[old_name]), (new_name, parameter)
        )]  # fmt: skip
        text = phrase("{kind} {old} renamed to {new}", kind=phrase("parameter"), old=names[0], new=names[1])
        reason = _make_removal_reason(pair, new_root, {old_name: lost.pop(old_name)})
        pair.changes.append(_make_change(text, reason, Location(pair.new_path, parameter.line, parameter.column)))
    if added:
        first = next(iter(added.values()))
        required = [name for name, parameter in added.items() if parameter.is_required]
        reason = _make_required_reason(required) if required else None
        text = phrase("{kind} added: {names}", kind=phrase("parameters"), names=_format_names(added))
        pair.changes.append(_make_change(text, reason, Location(pair.new_path, first.line, first.column)))
    if lost:
        first = next(iter(lost.values()))
        text = phrase("{kind} removed: {names}", kind=phrase("parameters"), names=_format_names(lost))
        reason = _make_removal_reason(pair, new_root, lost)
        pair.changes.append(_make_change(text, reason, Location(pair.old_path, first.line, first.column, is_old=True)))


def _make_removal_reason(pair: FilePair, root: yaml.Node, lost: Mapping[str, _Parameter]) -> Phrase:
    """Return the reason why lost parameters are breaking: a file that sets one of them, or else any file."""
    user = _find_user(pair.versions.new, pair.new_path, root, lost)
    if user is not None:
        return phrase("'{file}' still sets '{name}', which has no effect", file=user[0], name=user[1])
    return phrase(
        "values that launch files and parameter files give to {names} have no effect",
        names=quote_first(lost),
    )


def _pair_similar(lost: Mapping[str, _Parameter], added: Mapping[str, _Parameter]) -> Iterator[tuple[str, str]]:
    """Yield the lost and added parameters whose names are spelled alike, if no other name is."""
    similar = [
        (old, new)
        for old in lost
        for new in added
        if old.rpartition(".")[0] == new.rpartition(".")[0]
        and SequenceMatcher(None, old, new, autojunk=False).ratio() >= _MIN_SIMILARITY
    ]
    for old, new in similar:
        if sum(old == pair[0] or new == pair[1] for pair in similar) == 1:
            yield old, new


def _make_required_reason(names: Sequence[str]) -> Phrase:
    return phrase("the program fails where {names} is not set", names=quote_first(names))


def _make_change(text: Phrase, reason: Phrase | None, location: Location) -> Change:
    return Change(text, Effect.CHANGED if reason is None else Effect.BREAKING, reason, location)


def _format_names(parameters: Mapping[str, _Parameter]) -> Phrase:
    return joined_first([f"'{name}' ({item.default or item.type})" for name, item in parameters.items()], MAX_NAMES)


def _compare_parameter(name: str, old: _Parameter, new: _Parameter) -> Iterator[tuple[Phrase, Phrase | None]]:
    """Yield the changes to a parameter, each with the reason why it is breaking or None."""

    def make_text(title: Phrase | str, before: str, after: str) -> Phrase:
        return phrase(
            "{kind} '{name}': {property} {old} -> {new}",
            kind=phrase("parameter"),
            name=name,
            property=title,
            old=before or "-",
            new=after or "-",
        )

    if old.type != new.type:
        yield make_text(phrase("type"), old.type, new.type), phrase("values of the old type are rejected")
    if old.default != new.default:
        text = phrase(
            "{kind} '{name}': default {old} -> {new}",
            kind=phrase("parameter"),
            name=name,
            old=old.default or "-",
            new=new.default or "-",
        )
        is_lost = new.is_required and not old.is_required
        yield text, _make_required_reason([name]) if is_lost else None
    for rule in dict.fromkeys((*old.rules, *new.rules)):
        before, after = old.rules.get(rule), new.rules.get(rule)
        if before != after:
            reason = phrase("values that were allowed are rejected") if _is_stricter(rule, old, new) else None
            yield make_text(rule, _format_rule(before), _format_rule(after)), reason
    if old.is_read_only != new.is_read_only:
        states = ["yes" if item.is_read_only else "no" for item in (old, new)]
        reason = phrase("programs that set the parameter while the node runs get an error")
        yield make_text(phrase("read-only"), *states), reason if new.is_read_only else None
    for key, title in zip(_TEXT_PROPERTIES, (phrase("description"), phrase("constraints")), strict=True):
        before_text, after_text = old.texts.get(key, ""), new.texts.get(key, "")
        if before_text != after_text:
            shown = (before_text, after_text)
            if before_text and after_text and len(before_text) + len(after_text) > _MAX_TEXT_CHARACTERS:
                first, second = differing_excerpts(before_text, after_text)
                shown = (shorten_middle(first, _MAX_TEXT_CHARACTERS), shorten_middle(second, _MAX_TEXT_CHARACTERS))
            yield make_text(title, *shown), None


def _format_rule(arguments: tuple[str, ...] | None) -> str:
    return "" if arguments is None else f"[{', '.join(arguments)}]"


def _is_stricter(rule: str, old: _Parameter, new: _Parameter) -> bool:
    """Return whether a rule that the versions have in other forms rejects values that the old version allows."""
    old_range, new_range = _read_range(old.rules), _read_range(new.rules)
    if rule in old_range.names | new_range.names:
        return new_range.is_narrower_than(old_range)
    before, after = old.rules.get(rule), new.rules.get(rule)
    if after is None:
        return False
    if before is None:
        return True
    if rule in ("one_of", "subset_of"):
        return not set(before) <= set(after)
    numbers = [[_parse_number(item) for item in items] for items in (before, after)]
    if len(numbers[0]) != len(numbers[1]) or any(number is None for number in (*numbers[0], *numbers[1])):
        return False
    values = [[number for number in items if number is not None] for items in numbers]
    if rule == "element_bounds" and len(values[0]) > 1:
        return values[1][0] > values[0][0] or values[1][1] < values[0][1]
    if rule in ("size_gt", "lower_element_bounds"):
        return values[1] > values[0]
    return rule == "fixed_size" or (rule in ("size_lt", "upper_element_bounds") and values[1] < values[0])


def _read_range(rules: Mapping[str, tuple[str, ...]]) -> _Range:
    """Return the numbers that the rules of a parameter allow."""
    found = _Range()
    for rule, arguments in rules.items():
        numbers = [number for item in arguments if (number := _parse_number(item)) is not None]
        if not numbers or len(numbers) != len(arguments):
            continue
        if rule == "bounds" and len(numbers) > 1:
            found.lower, found.upper = max(found.lower, (numbers[0], 0)), min(found.upper, (numbers[1], 0))
        elif rule in _LOWER:
            found.lower = max(found.lower, (numbers[0], int(_LOWER[rule])))
        elif rule in _UPPER:
            limit = (numbers[0], int(_UPPER[rule]))
            found.upper = min(found.upper, limit, key=lambda item: (item[0], -item[1]))
        else:
            continue
        found.names.add(rule)
    return found


def _parse_number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


# --- reading --------------------------------------------------------------------------------------------------------


def _read_parameters(root: yaml.Node) -> dict[str, _Parameter] | None:
    """Return the parameters of a description by their names, or None for another document."""
    if not isinstance(root, yaml.MappingNode):
        return None
    parameters: dict[str, _Parameter] = {}
    for _, node in root.value:
        if not isinstance(node, yaml.MappingNode) or not _add_parameters(node, "", parameters):
            return None
    return parameters or None


def _add_parameters(node: yaml.MappingNode, path: str, parameters: dict[str, _Parameter]) -> bool:
    """Add the parameters below a key, and return whether all values belong to parameters."""
    for key, value in node.value:
        part = _MAP.sub(r"<\1>", str(key.value))
        name = f"{path}.{part}".lstrip(".")
        if not isinstance(value, yaml.MappingNode):
            return False
        properties = {item.value: inner for item, inner in value.value}
        type_node = properties.get("type")
        if not isinstance(type_node, yaml.ScalarNode):
            if not _add_parameters(value, name, parameters):
                return False
        elif _TYPES.fullmatch(type_node.value) is None or not properties.keys() <= _PROPERTIES:
            return False
        else:
            parameters[name] = _make_parameter(key, value, type_node.value)
    return True


def _make_parameter(key: yaml.Node, node: yaml.MappingNode, type_name: str) -> _Parameter:
    properties = {item.value: inner for item, inner in node.value}
    values = collect_values(node, {})
    validation = properties.get("validation")
    rules = {}
    for item, arguments in validation.value if isinstance(validation, yaml.MappingNode) else ():
        rules[item.value.removesuffix("<>").strip()] = tuple(_list_arguments(arguments))
    texts: dict[str, str] = {
        name: " ".join(values[name].text.split())
        for name in ("description", "additional_constraints")
        if name in values
    }
    default = values["default_value"].shown if "default_value" in values else ""
    is_read_only = "read_only" in values and values["read_only"].text.lower() == "true"
    return _Parameter(
        type_name, default, is_read_only, rules, texts, key.start_mark.line + 1, key.start_mark.column + 1
    )


def _list_arguments(node: yaml.Node) -> Iterator[str]:
    """Yield the arguments of a rule, with those of a list in their places."""
    if isinstance(node, yaml.SequenceNode):
        for item in node.value:
            yield from _list_arguments(item)
    elif isinstance(node, yaml.ScalarNode) and node.value not in ("", "null", "~"):
        yield node.value


# --- users ----------------------------------------------------------------------------------------------------------


def _find_user(version: Version, path: str, root: yaml.Node, lost: Mapping[str, _Parameter]) -> tuple[str, str] | None:
    """Return a parameter file that still sets a lost parameter, with the name of the parameter; None if there is none.

    The node must have the name in the description.
    """
    package = version.package_of(path)
    own = {str(key.value) for key, _ in root.value} if isinstance(root, yaml.MappingNode) else set()
    patterns = {name: _make_pattern(name) for name in lost}
    words = {name.rpartition(".")[2] for name in lost}
    for other in version.paths(_SETTINGS_SUFFIXES, package or ""):
        text = version.text(other)
        if other == path or _PARAMETERS not in text or not any(word in text for word in words):
            continue
        for key in _try_read_values(text):
            node = find_node_name(key) or ""
            if PurePosixPath(f"/{node}").name not in own:
                continue
            parameter = key.partition(f".{_PARAMETERS}.")[2]
            found = next((name for name, pattern in patterns.items() if pattern.fullmatch(parameter)), None)
            if found is not None:
                return other, found
    return None


def _make_pattern(name: str) -> re.Pattern[str]:
    """Return the pattern of the names that a parameter has in parameter files, where a map has keys of its user."""
    parts = [r"[^.]+" if part.startswith("<") else re.escape(part) for part in name.split(".")]
    return re.compile(r"\.".join(parts))


def _try_read_values(text: str) -> Mapping[str, YamlValue]:
    try:
        return read_yaml_values(text)
    except UnreadableFileError:
        return {}
