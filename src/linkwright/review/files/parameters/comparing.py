"""Compare YAML files: parameters of nodes and controllers, and settings of launch files."""

from __future__ import annotations

import itertools
import math
import re
from collections import Counter
from collections.abc import Callable, Collection, Hashable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
import yaml

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.diagnostics.phrase import count_shown
from linkwright.review.changes import MAX_NAMES, Change, Effect, Location
from linkwright.review.file_pair import FilePair
from linkwright.review.files.parameters.between_nodes import find_parameter_moves
from linkwright.review.files.parameters.bridges import compare_bridges, read_bridges
from linkwright.review.files.parameters.costmap_topics import FindRemappings
from linkwright.review.files.parameters.embedded_texts import read_embedded_texts
from linkwright.review.files.parameters.generated import compare_generated_parameters, is_parameter_description
from linkwright.review.files.parameters.key_readers import KeyReaders
from linkwright.review.files.parameters.lists_of_mappings import (
    drop_reasons_of_lists,
    find_replaced_lists,
    report_replaced_lists,
)
from linkwright.review.files.parameters.lost_groups import find_group_reason, find_lost_items
from linkwright.review.files.parameters.migrated import describe_migration, find_migrated_nodes, rename_migrated
from linkwright.review.files.parameters.moved_nodes import find_group_move, find_node_move
from linkwright.review.files.parameters.moveit_names import MoveItRules
from linkwright.review.files.parameters.names import (
    NameRules,
    RenamingRules,
    find_node_name,
    has_different_type,
    index_parts,
    is_parameter,
    list_part_paths,
)
from linkwright.review.files.parameters.nested_lists import merge_nested_lists
from linkwright.review.files.parameters.placeholders import find_renamed_placeholder, rename_placeholder
from linkwright.review.files.parameters.plugin_packages import PluginPackages
from linkwright.review.files.parameters.rearranged_nodes import arrange_like
from linkwright.review.files.parameters.renamed_parts import find_edit, find_renamed_parts, get_parent, rename_parts
from linkwright.review.files.parameters.renamed_values import join_renamed_values
from linkwright.review.files.parameters.renumbered_parts import report_renumbered_parts
from linkwright.review.files.parameters.repeated_keys import report_repeated_keys
from linkwright.review.files.parameters.replaced_classes import join_replaced_classes
from linkwright.review.files.parameters.unpublished_topics import find_unpublished_reason
from linkwright.review.files.parameters.value_changes import ValueChange, merge_values
from linkwright.review.files.parameters.value_vectors import shorten_covariance
from linkwright.review.files.parameters.yaml_includes import resolve_includes
from linkwright.review.files.parameters.yaml_lists import find_item_labels
from linkwright.review.files.parameters.yaml_values import (
    YamlType,
    YamlValue,
    collect_values,
    compose_yaml,
    list_merged_items,
    read_yaml_text,
)
from linkwright.review.texts.excerpts import shorten_middle
from linkwright.review.texts.merged_reasons import merge_reasons
from linkwright.review.versions import Version

_MAX_VALUES = 32
"""The maximum number of values in the line about an added file, divided among the nodes or keys."""
_NEUTRAL_VALUE = re.compile(r" (?:[-+]?0*\.?0*(?:e[-+]?\d+)?|''|\[\]|\{\}|null|~)$")
"""A value of zero, or none. Recorded messages have many of them, which say less than the others."""
_TELLING_NAME = re.compile(r"(?:\w+_)?(?:plugins?|plugin_names|topic|frame|frame_id|observation_sources)(?= )")
"""A name of a plugin, topic or frame before its value."""
_MIN_VALUES_OF_PART = 3
_ITEM = re.compile(r"\[[^\[\]]+\](?=\.)")
"""The beginning of the path of a value in an item of a list at the root."""
_ROUNDING = 1e-9
"""The relative difference up to which two numbers differ only by rounding."""
_MAX_VALUE_CHARACTERS = 60
_ITEM_NAME_KEYS = ("name", "id")
NameRule = Callable[[str, YamlValue, YamlValue], "Phrase | None"]
"""A function that returns the reason why another value of a parameter is breaking, or None if it is not."""


def compare_parameter_files(
    pair: FilePair, read_names: Callable[[Mapping[str, YamlValue]], NameRule], find_remappings: FindRemappings
) -> None:
    """Compare two versions of a YAML file, value by value.

    Args:
        pair: both versions of the file.
        read_names: a function that takes the new values and returns the rule for values that name topics and frames.
        find_remappings: a function that returns the remappings of the nodes that load either version of the file.
    """
    texts = pair.read(read_yaml_text)
    if texts is None:
        return
    renamed = find_renamed_placeholder(*texts, pair.versions)
    if renamed is not None:
        texts = rename_placeholder(texts[0], *renamed), texts[1]
        pair.add(phrase("placeholder '{old}' renamed to '{name}'", old=renamed[0], name=renamed[1]), None)
    bridges = pair.read(lambda file: read_bridges(texts[file == pair.new_file]) or [])
    if bridges is None:
        return
    if all(bridges):
        compare_bridges(pair, *bridges)
        return
    roots = pair.read(lambda file: _compose_root(texts[file == pair.new_file]))
    if roots is None:
        return
    old, new = roots
    report_repeated_keys(pair, old, new)
    if old is not None and new is not None:
        if is_parameter_description(old) and is_parameter_description(new):
            compare_generated_parameters(pair, old, new)
            return
        old, new = resolve_includes(pair, old, new)
        old, rearrangements = arrange_like(old, new)
        for text, node in rearrangements:
            location = Location(pair.new_path, node.start_mark.line + 1, node.start_mark.column + 1)
            pair.changes.append(Change(text, location=location))
    changes, renamed_values = join_renamed_values(
        join_replaced_classes(_find_changes(pair, old, new, read_names, find_remappings))
    )
    pair.changes += [*renamed_values, *merge_values(changes)]


def parameter_contents(version: Version, path: str) -> Phrase | None:
    """Return the node parameters in a file, or else its top-level keys, with values.

    Returns None if there are none.
    """
    text = read_yaml_text(version.file(path))
    bridges = read_bridges(text)
    if bridges:
        return phrase("bridged topics {names}", names=joined_first([bridge.topic for bridge in bridges], MAX_NAMES))
    root = _compose_root(text)
    if isinstance(root, yaml.SequenceNode):
        return _format_list(root)
    if not isinstance(root, yaml.MappingNode):
        return None
    values = collect_values(root, {})
    nodes: dict[str, dict[str, YamlValue]] = {}
    for name, value in values.items():
        node = find_node_name(name)
        if node is not None:
            nodes.setdefault(node, {})[name] = value
    names = [str(key.value) for key, _ in list_merged_items(root)]
    keys = {key: {name: value for name, value in values.items() if _is_below(name, key)} for key in names}
    if nodes:
        text = phrase("parameters of {names}", names=_format_values(nodes))
        others = {key: found for key, found in keys.items() if found and not any(map(find_node_name, found))}
        return (
            text
            if not others
            else phrase(
                "{contents}; without ros__parameters, so that nodes cannot load the file: {names}",
                contents=text,
                names=_format_values(others),
            )
        )
    return _format_values(keys) if keys else None


def _format_list(root: yaml.SequenceNode) -> Phrase | None:
    """Return the items of a list of mappings with their first values, or None for another list."""
    items: dict[str, dict[str, YamlValue]] = {}
    for name, value in collect_values(root, {}).items():
        match = _ITEM.match(name)
        if match is None:
            return None
        items.setdefault(match[0], {})[name] = value
    return _format_values(items) if items else None


def _format_values(parts: Mapping[str, Mapping[str, YamlValue]]) -> Phrase:
    """Return the names of nodes or keys with their first values."""
    limit = _find_limit([len(values) for values in parts.values()])
    listed = {part: _list_values(part, values) for part, values in parts.items()}
    ranks = {part: _rank_values(items) for part, items in listed.items()}
    telling = {part: sum(rank <= 0 for rank in part_ranks) for part, part_ranks in ranks.items()}
    texts: list[Phrase] = []
    first_parts: dict[tuple[str, ...], str] = {}
    for part, values in parts.items():
        first = first_parts.setdefault(tuple(listed[part]), part)
        if first != part and len(listed[part]) >= _MIN_VALUES_OF_PART:
            texts.append(phrase("{entry} (as {first})", entry=part, first=first))
            continue
        items = [shorten_middle(item, _MAX_VALUE_CHARACTERS) for item in listed[part]]
        if len(items) > count_shown(len(items), limit):
            items = [item for _, item in sorted(zip(ranks[part], items, strict=True), key=lambda pair: pair[0])]
        own_limit = max(limit, telling[part]) if sum(telling.values()) <= _MAX_VALUES else limit
        if part in values:
            texts.append(phrase("{parameter} {value}", parameter=part, value=items[0]))
        else:
            texts.append(phrase("{entry} ({items})", entry=part, items=joined_first(items, own_limit)))
    return joined_first(texts, MAX_NAMES)


def _find_limit(counts: Sequence[int]) -> int:
    """Return the number of values of each part that are shown: more if other parts have only a few."""
    limit = max(_MIN_VALUES_OF_PART, _MAX_VALUES // len(counts))
    while limit < max(counts) and sum(min(count, limit + 1) for count in counts) <= _MAX_VALUES:
        limit += 1
    return limit


def _rank_values(items: Sequence[str]) -> list[int]:
    """Return how little each value of a long list tells: plugins, topics and frames first, zeros at last.

    Before the zeros are the values that other parts repeat.
    """
    ends = [item[item.rfind(".", 0, item.find(" ")) + 1 :] for item in items]
    counts = Counter(ends)
    ranks = [2 if _NEUTRAL_VALUE.search(item) else int(counts[end] > 1) for item, end in zip(items, ends, strict=True)]
    return [-1 if _TELLING_NAME.match(end) else rank for end, rank in zip(ends, ranks, strict=True)]


def _compose_root(text: str) -> yaml.Node | None:
    """Return the root of a YAML document with at most as many values as a parameter file.

    Texts in it that are YAML themselves are read as such.

    Raises:
        UnreadableFileError: the text is not YAML, or has too many values.
    """
    root = compose_yaml(text)
    if root is not None:
        read_embedded_texts(root)
        collect_values(root, {})
    return root


def _find_changes(
    pair: FilePair,
    old_root: yaml.Node | None,
    new_root: yaml.Node | None,
    read_names: Callable[[Mapping[str, YamlValue]], NameRule],
    find_remappings: FindRemappings,
) -> Iterator[ValueChange]:
    labels = find_item_labels(old_root, new_root) if old_root is not None and new_root is not None else {}
    old_values, new = ({} if root is None else collect_values(root, labels) for root in (old_root, new_root))
    old_values, new = merge_nested_lists(old_values, new), merge_nested_lists(new, old_values)
    lists = find_replaced_lists(old_values, new)
    report_replaced_lists(pair, lists, new)
    old_values = {lists.get(path, path): value for path, value in old_values.items()}
    yield from drop_reasons_of_lists(_compare_values(pair, old_values, new, read_names, find_remappings), lists)


def _compare_values(
    pair: FilePair,
    old_values: dict[str, YamlValue],
    new: dict[str, YamlValue],
    read_names: Callable[[Mapping[str, YamlValue]], NameRule],
    find_remappings: FindRemappings,
) -> Iterator[ValueChange]:
    migrated = find_migrated_nodes(old_values, new)
    if migrated:
        pair.changes.append(describe_migration(migrated, new, pair.new_path))
        old_values = {rename_migrated(name, migrated): value for name, value in old_values.items()}
    old_values = report_renumbered_parts(pair, old_values, new)
    moveit = MoveItRules(old_values, new, pair.versions, pair.new_path)
    readers = KeyReaders(pair.versions, pair.new_path)
    old = _report_renamed(pair, old_values, new, moveit, readers)
    rules = NameRules(old, new, readers, find_remappings, has_types=not migrated)
    plugins = PluginPackages(pair.versions, pair.new_path)
    find_name_reason = read_names(new)
    new_keys = frozenset(_get_last_key(part) for name in new for part in list_part_paths(name))
    for name, value in new.items():
        old_value = old.get(name)
        if (
            old_value is not None
            and not _are_equal(name, old_value, value, has_types=not migrated)
            and not _is_new_label(name, old_value, value)
        ):
            location = Location(pair.new_path, value.line, value.column)
            value_texts = _format_value_pair(old_value, value)
            reason = moveit.find_change_reason(name, old_value, value)
            if reason is None and not moveit.follows_controllers(name, old_value, value):
                reason = rules.find_change_reason(name, old_value, value)
            reason = reason or readers.find_name_reason(name, old_value, value)
            reason = reason or plugins.find_change_reason(name, old_value, value)
            reason = reason or find_name_reason(name, old_value, value)
            reason = reason or find_unpublished_reason(pair.versions, pair.new_path, name, old_value, value)
            yield ValueChange(name, "changed", value_texts, location, reason)
    moves = list(
        find_parameter_moves(
            old,
            new,
            lambda name, value: any(
                (
                    moveit.find_removal_reason(name),
                    rules.find_removal_reason(name, value.text),
                    rules.find_addition_reason(name, value.text),
                )
            ),
        )
    )
    pair.changes += (move.describe(pair.new_path, new) for move in moves)
    moved = {path for move in moves for path in (*move.paths, *move.paths.values())}
    for name, values_below in _find_unpaired_parts(_leave_out(new, moved), old):
        first = next(iter(values_below.values()))
        location = Location(pair.new_path, first.line, first.column)
        reason = plugins.find_addition_reason(values_below) if old else None
        added_reasons = (
            rules.find_addition_reason(inner_name, value.text) for inner_name, value in values_below.items()
        )
        reason = reason or next((found for found in added_reasons if found is not None), None)
        yield ValueChange(name, "added", _list_values(name, values_below), location, reason)
    lost_items = find_lost_items(old, new)
    for name, values_below in _find_unpaired_parts(_leave_out(old, moved), new):
        first = next(iter(values_below.values()))
        location = Location(pair.old_path, first.line, first.column, is_old=True)
        reasons = (
            moveit.find_removal_reason(inner_name) or rules.find_removal_reason(inner_name, value.text)
            for inner_name, value in values_below.items()
        )
        reason = next((reason for reason in reasons if reason is not None), None)
        reason = reason or readers.find_key_reason(_find_lost_keys(next(iter(values_below)), new_keys))
        reason = reason or find_group_reason(pair, name, values_below, lost_items)
        node_move = None if reason is None else find_node_move(pair, name, values_below)
        if node_move is not None:
            pair.changes.append(Change(node_move, location=location))
            continue
        group_move = None if reason is None else find_group_move(pair, name, values_below)
        if group_move is not None:
            pair.changes.append(Change(group_move, Effect.BREAKING, reason, location))
            continue
        yield ValueChange(name, "removed", _list_values(name, values_below), location, reason)


def _leave_out(values: Mapping[str, YamlValue], paths: Collection[str]) -> dict[str, YamlValue]:
    return {path: value for path, value in values.items() if path not in paths}


def _format_value_pair(old: YamlValue, new: YamlValue) -> tuple[str, str]:
    """Return the texts of two values, quoted if they differ only in their quotes."""
    if old.shown != new.shown:
        return old.shown, new.shown
    old_text, new_text = (f'"{value.text}"' if value.type is YamlType.TEXT else value.text for value in (old, new))
    return old_text, new_text


def _list_values(part: str, values: Mapping[str, YamlValue]) -> tuple[str, ...]:
    """Return the value of a part that is a single value, or the names and values inside a part."""
    if part in values:
        return (shorten_covariance(part, values[part].shown),)
    names = {name: name.removeprefix(part).lstrip(".").removeprefix("ros__parameters.") for name in values}
    items = Counter(name[: end.end()] for name in values for end in _ITEM_END.finditer(name))
    return tuple(
        value.shown if _is_label(name, value) else f"{names[name]} {shorten_covariance(name, value.shown)}"
        for name, value in values.items()
        if not _is_label(name, value) or items[name.rpartition(".")[0]] == 1
    )


_ITEM_END = re.compile(r"\](?=\.)")


def _is_label(name: str, value: YamlValue) -> bool:
    """Return whether a value is the name of a list item, which labels the item in paths."""
    item, _, key = name.rpartition(".")
    return key in _ITEM_NAME_KEYS and item.endswith(f"[{value.text}]")


def _is_new_label(name: str, old: YamlValue, new: YamlValue) -> bool:
    """Return whether a changed value is the name of a list item.

    The path of the item changes with the name.
    """
    return old.text != new.text and _is_label(name, new)


def _find_unpaired_parts(
    values: Mapping[str, YamlValue], others: Mapping[str, YamlValue]
) -> Iterator[tuple[str, dict[str, YamlValue]]]:
    """Yield the largest parts of a file that the other version lacks, with their values."""
    other_parts = {part for name in others for part in list_part_paths(name)}
    parts: dict[str, dict[str, YamlValue]] = {}
    for name, value in values.items():
        if name not in others and (value.text or name not in other_parts):  # an empty key can get children
            part = next((part for part in list_part_paths(name) if part not in other_parts), name)
            parts.setdefault(part, {})[name] = value
    for part, values_below in parts.items():
        yield next(iter(values_below)) if len(values_below) == 1 else part, values_below


def _find_lost_keys(name: str, new_keys: Collection[str]) -> list[str]:
    """Return the keys in a path that the new version lacks; empty for a node parameter."""
    if is_parameter(name):
        return []  # nodes declare their parameters with defaults
    return [key for key in map(_get_last_key, list_part_paths(name)) if key not in new_keys and "[" not in key]


def _get_last_key(part: str) -> str:
    return part.rpartition(".")[2]


def _is_below(name: str, part: str) -> bool:
    return name == part or name.startswith((f"{part}.", f"{part}["))


def _report_renamed(
    pair: FilePair,
    old: Mapping[str, YamlValue],
    new: Mapping[str, YamlValue],
    moveit: MoveItRules,
    readers: KeyReaders,
) -> Mapping[str, YamlValue]:
    """Report renamed and moved parts of a file, and return the old values with the new names."""
    renamed = find_renamed_parts(old, new)
    rules, first_old, first_new = RenamingRules(old), index_parts(old), index_parts(new)
    groups: dict[Hashable, list[Change]] = {}
    added_nodes = set(filter(None, map(find_node_name, new))) - set(filter(None, map(find_node_name, old)))
    for old_part, new_part in renamed.items():
        first_value = new[first_new[new_part]]
        text = phrase("{old} moved to {name}", old=old_part, name=new_part)
        if get_parent(old_part) == get_parent(new_part):
            text = phrase("{old} renamed to {name}", old=old_part, name=new_part)
        reason = moveit.find_renaming_reason(old_part)
        if reason is None and not _follows_node(old_part, first_old[old_part], added_nodes, readers):
            reason = rules.find_reason(old_part, new_part)
        effect = Effect.CHANGED if reason is None else Effect.BREAKING
        change = Change(text, effect, reason, Location(pair.new_path, first_value.line, first_value.column))
        kind = None if reason is None else reason.template
        groups.setdefault((find_edit(old_part, new_part), kind), []).append(change)
    for first, *others in groups.values():
        names = tuple(f"{change.sentence.arguments['old']} -> {change.sentence.arguments['name']}" for change in others)
        reason = merge_reasons(change.reason for change in (first, *others))
        pair.changes.append(replace(first, reason=reason, other_names=names))
    return rename_parts(old, renamed)


def _follows_node(part: str, name: str, added_nodes: Collection[str], readers: KeyReaders) -> bool:
    """Return whether a renamed part is a node that the programs renamed, too.

    Args:
        part: the old path of the part.
        name: the old path of its first value.
        added_nodes: the nodes that only the new version of the file has.
        readers: the programs that may read the values.
    """
    node = find_node_name(name)
    is_node = node is not None and part in (node, f"{node}.ros__parameters")
    return is_node and readers.have_renamed_node(node or "", added_nodes)


def _are_equal(name: str, old: YamlValue, new: YamlValue, has_types: bool) -> bool:
    """Return whether two values are equal as texts or as numbers, such as ``0`` and ``0.000``.

    The parameters of a node must also have the same type, unless the old ones are of ROS 1, which has no types.
    """
    if has_types and is_parameter(name) and has_different_type(old, new):
        return False
    if old.is_null or new.is_null:
        return old.is_null and new.is_null
    if old.text == new.text:
        return True
    if old.type is new.type is YamlType.TRUTH:
        return old.text.lower() == new.text.lower()
    try:
        old_numbers, new_numbers = (
            [float(word) for word in value.text.strip("[]").split(", ")] for value in (old, new)
        )
    except ValueError:
        return False
    if len(old_numbers) != len(new_numbers):
        return False
    if old.type is new.type is YamlType.INTEGER:
        return old_numbers == new_numbers
    return all(itertools.starmap(_differ_by_rounding, zip(old_numbers, new_numbers, strict=True)))


def _differ_by_rounding(old: float, new: float) -> bool:
    """Return whether two numbers are equal, or differ only because one was written in 64 or in 32 bits."""
    rounded = [float(np.float32(value)) for value in (old, new)]
    return math.isclose(old, new, rel_tol=_ROUNDING, abs_tol=0) or (
        rounded[0] == rounded[1] and not {old, new}.isdisjoint(rounded)
    )
