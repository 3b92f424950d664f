"""Find renamed and moved parts of YAML files, such as nodes, plugins and joints."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import product

from linkwright.review.files.parameters.moved_values import find_moved_values
from linkwright.review.files.parameters.names import list_part_paths
from linkwright.review.files.parameters.yaml_values import YamlValue
from linkwright.review.texts.merging import name_edit

_MIN_FACTS = 6
"""The minimum number of parameters and values by which a renamed part is recognized."""
_MIN_SIMILARITY = 0.6
_MIN_CONTAINED_SHARE = 0.8
"""The minimum share of the names and values of an old part that a moved part with many new ones has."""
_MIN_EQUAL_EDITS = 2
"""The minimum number of sibling parts with the same edit that are recognized without many values."""
_MAX_PAIRS = 2_500
"""The maximum number of pairs of old and new sibling parts whose names are compared."""
_MAX_NEW_SIBLINGS = 200
"""The maximum number of new sibling parts that are compared with a part."""
_MAX_PARTS = 60
"""The maximum number of parts of either version for which moved parts are searched."""
_ITEM = re.compile(r"\[(old )?\d+\]$")
"""The end of the path of a list item without a name."""
_NUMBER_OR_BOOLEAN = re.compile(r"[^=]*=([-+.,\s\d\[\]e]*|true|false)", re.IGNORECASE)
"""A name and a value that many parts can have in common, such as a limit."""
_SECTION = ".ros__parameters."
_Facts = Counter[str]
"""The names and values in a part, alone and together."""


def find_renamed_parts(old: Mapping[str, YamlValue], new: Mapping[str, YamlValue]) -> dict[str, str]:
    """Return the new paths of renamed and moved parts with similar values, by old path."""
    old_parts, new_parts = _find_unpaired_parts(old, new), _find_unpaired_parts(new, old)
    renamed = dict(_find_equal_renames(old_parts, new_parts))
    remaining_new = {
        name: facts for name, facts in new_parts.items() if name not in renamed.values() and not _ITEM.search(name)
    }
    new_siblings = _group_siblings(remaining_new)
    remaining_old = {name: facts for name, facts in old_parts.items() if name not in renamed}
    for parent, removed in _group_siblings(remaining_old).items():
        added = new_siblings.get(parent, [])
        renamed |= _match_similar(
            {name: remaining_old[name] for name in removed}, {name: remaining_new[name] for name in added}
        )
    remaining_old = {name: facts for name, facts in old_parts.items() if name not in renamed}
    new_names = set(renamed.values())
    unmatched_new = {name: facts for name, facts in new_parts.items() if name not in new_names}
    renamed |= dict(_find_moved(_add_inner_parts(remaining_old, old), _add_inner_parts(unmatched_new, new)))
    is_paired = partial(_is_inside, parts={*renamed, *renamed.values()})
    old_values, new_values = (
        {name: value for name, value in values.items() if not is_paired(name)} for values in (old, new)
    )
    return renamed | dict(find_moved_values(old_values, new_values))


def rename_parts(values: Mapping[str, YamlValue], renamed: Mapping[str, str]) -> dict[str, YamlValue]:
    """Return the values of the old version with the new paths of renamed parts."""
    return {_rename_part(name, renamed): value for name, value in values.items()}


def _rename_part(name: str, renamed: Mapping[str, str]) -> str:
    for part in reversed(list_part_paths(name)):
        if part in renamed:
            return f"{renamed[part]}{name.removeprefix(part)}"
    return name


def find_edit(old: str, new: str) -> Hashable:
    """Return the edit between the last names of sibling paths; both parents for other paths."""
    parent, new_parent = get_parent(old), get_parent(new)
    if parent != new_parent:
        return parent, new_parent
    name, new_name = old.removeprefix(parent), new.removeprefix(parent)
    if any(map(str.isalpha, name)) and (name.startswith(new_name) or new_name.startswith(name)):
        return name[len(new_name) :], new_name[len(name) :], False
    return name_edit(name, new_name)


def get_parent(part: str) -> str:
    """Return the path of the mapping or list that contains a part; empty for a top-level part."""
    return (["", *list_part_paths(part)])[-2]


def _find_equal_renames(old: Mapping[str, _Facts], new: Mapping[str, _Facts]) -> Iterator[tuple[str, str]]:
    """Yield sibling parts that are renamed in the same way.

    An example is a new prefix of all joints of a controller. The edit of the most names comes first, and among equally
    many, the one that keeps the most values. Several edits that are equally good tell nothing.
    Unless the edit covers all old or all new parts and their keys are equal, their values must also be similar.
    """
    old_groups, new_groups = _group_siblings(old), _group_siblings(new)
    for parent, removed in old_groups.items():
        added = new_groups.get(parent, [])
        if any(_ITEM.search(name) for name in (*removed, *added)):
            continue
        used_names: set[str] = set()
        ranked = [
            ((len(group), _count_equal(group, old, new)), group) for group in _group_pairs_by_edit(removed, added)
        ]
        ranked.sort(key=lambda item: item[0], reverse=True)
        for rank, group in ranked:
            rivals = [other for other_rank, other in ranked if other_rank == rank and other is not group]
            if rank[1] < len(group) and any(_share_old_names(group, other) for other in rivals):
                continue
            pairs = _select_unused_pairs(group, used_names)
            covers_all = len(pairs) in (len(removed), len(added))
            if not (covers_all and all(_get_names(old[first]) == _get_names(new[second]) for first, second in pairs)):
                pairs = [pair for pair in pairs if _compute_similarity(old[pair[0]], new[pair[1]]) >= _MIN_SIMILARITY]
            if len(pairs) >= _MIN_EQUAL_EDITS:
                used_names.update(name for pair in pairs for name in pair)
                yield from pairs


def _share_old_names(pairs: Sequence[tuple[str, str]], others: Sequence[tuple[str, str]]) -> bool:
    """Return whether two groups of pairs give other new names to the same parts."""
    return {old for old, _ in pairs} == {old for old, _ in others}


def _group_pairs_by_edit(removed: Sequence[str], added: Sequence[str]) -> list[list[tuple[str, str]]]:
    """Return the groups of pairs of names that differ in the same way."""
    groups: dict[Hashable, list[tuple[str, str]]] = {}
    pairs = product(removed, added) if len(removed) * len(added) <= _MAX_PAIRS else zip(removed, added, strict=False)
    for pair in pairs:
        groups.setdefault(find_edit(*pair), []).append(pair)
    return list(groups.values())


def _count_equal(pairs: Sequence[tuple[str, str]], old: Mapping[str, _Facts], new: Mapping[str, _Facts]) -> int:
    """Return the number of pairs whose parts have equal names and values."""
    return sum(old[first] == new[second] for first, second in pairs)


def _select_unused_pairs(pairs: Iterable[tuple[str, str]], used_names: Collection[str]) -> list[tuple[str, str]]:
    """Return the pairs whose names are in no other pair, in their order."""
    selected: dict[str, str] = {}
    for old_name, new_name in pairs:
        if not {old_name, new_name} & {*used_names, *selected, *selected.values()}:
            selected[old_name] = new_name
    return list(selected.items())


def _match_similar(old: Mapping[str, _Facts], new: Mapping[str, _Facts]) -> dict[str, str]:
    """Return the new paths of sibling parts with similar contents, by old path.

    A text that is unique in each version, such as a type, counts more than equal numbers.
    """
    if len(new) > _MAX_NEW_SIBLINGS:
        return {}
    old_owners, new_owners = _find_sole_owners(old), _find_sole_owners(new)
    shared = Counter((owner, new_owners[text]) for text, owner in old_owners.items() if text in new_owners)
    max_shared: Counter[str] = Counter()
    for pair, count in shared.items():
        max_shared |= Counter(dict.fromkeys(pair, count))
    ranked: list[tuple[tuple[int, bool, float], str, str]] = []
    for old_name, new_name in product(old, new):
        count = shared[old_name, new_name]
        if old[old_name].total() < _MIN_FACTS or count < max(max_shared[old_name], max_shared[new_name]):
            continue
        similarity = _compute_similarity(old[old_name], new[new_name])
        if similarity >= _MIN_SIMILARITY or _has_parameters_of_node(old[old_name], new[new_name]):
            old_start, new_start = old_name.rstrip("]"), new_name.rstrip("]")
            is_longer = old_start.startswith(new_start) or new_start.startswith(old_start)
            ranked.append(((count, is_longer, similarity), old_name, new_name))
    ranked.sort(key=lambda pair: pair[0], reverse=True)
    return dict(_select_unused_pairs(((old_name, new_name) for _, old_name, new_name in ranked), ()))


def _has_parameters_of_node(old: _Facts, new: _Facts) -> bool:
    """Return whether a node of ROS 2 has nearly all parameters of another one, whatever their values and its others."""
    old_names, new_names = ({name for name in _get_names(facts) if name.startswith(_SECTION)} for facts in (old, new))
    return len(old_names) >= _MIN_FACTS and len(old_names & new_names) >= _MIN_CONTAINED_SHARE * len(old_names)


def _find_sole_owners(parts: Mapping[str, _Facts]) -> dict[str, str]:
    """Return the only part that contains a text, by the text with its name."""
    owners: dict[str, list[str]] = {}
    for name, facts in parts.items():
        for fact in facts:
            if "=" in fact and not _NUMBER_OR_BOOLEAN.fullmatch(fact):
                owners.setdefault(fact, []).append(name)
    return {fact: names[0] for fact, names in owners.items() if len(names) == 1}


def _get_names(facts: _Facts) -> set[str]:
    return {fact for fact in facts if "=" not in fact}


def _group_siblings(parts: Mapping[str, _Facts]) -> dict[str, list[str]]:
    groups: dict[str, list[str]] = {}
    for name in parts:
        groups.setdefault(get_parent(name), []).append(name)
    return groups


def _find_moved(old: Mapping[str, _Facts], new: Mapping[str, _Facts]) -> Iterator[tuple[str, str]]:
    """Yield the old and new paths of parts that move into a different part.

    Moved parts keep their last name.

    A small part counts as moved if it has the same sibling in both versions.
    """
    moved = dict(_find_moved_together(old, new))
    old = {name: facts for name, facts in old.items() if not _is_inside(name, moved)}
    new = {name: facts for name, facts in new.items() if not _is_inside(name, moved.values())}
    if max(len(old), len(new)) > _MAX_PARTS:
        yield from moved.items()
        return
    parents = {(get_parent(old_name), get_parent(new_name)) for old_name, new_name in moved.items()}
    for is_by_contents in (True, False):
        for old_name, first in old.items():
            if _is_inside(old_name, moved):
                continue
            for new_name, second in new.items():
                pair_of_parents = get_parent(old_name), get_parent(new_name)
                if _get_last_name(new_name) != _get_last_name(old_name) or _is_inside(new_name, moved.values()):
                    continue
                if _has_similar_contents(first, second) if is_by_contents else pair_of_parents in parents:
                    moved[old_name] = new_name
                    parents.add(pair_of_parents)
                    break
    for name, new_name in moved.items():
        outer_part = next((part for part in list_part_paths(name)[:-1] if part in moved), None)
        if outer_part is None or f"{moved[outer_part]}{name.removeprefix(outer_part)}" != new_name:
            yield name, new_name


def _has_similar_contents(old: _Facts, new: _Facts) -> bool:
    """Return whether two parts of the same name are similar, or the new one has most values of the old one."""
    if old.total() < _MIN_FACTS:
        return False
    is_contained = (old & new).total() >= _MIN_CONTAINED_SHARE * old.total()
    return is_contained or _compute_similarity(old, new) >= _MIN_SIMILARITY


def _find_moved_together(old: Mapping[str, _Facts], new: Mapping[str, _Facts]) -> Iterator[tuple[str, str]]:
    """Yield parts that move together to a different part, such as all poses.

    They keep their names.
    """
    groups: dict[tuple[str, str], list[tuple[str, str]]] = {}
    names_in_new = _group_by_last_name(new)
    for last_name, old_names in _group_by_last_name(old).items():
        new_names = names_in_new.get(last_name, [])
        if max(len(old_names), len(new_names)) > _MAX_PARTS:
            continue
        for old_name, new_name in product(old_names, new_names):
            size = min(old[old_name].total(), new[new_name].total())
            if size >= _MIN_FACTS and (old[old_name] & new[new_name]).total() >= _MIN_SIMILARITY * size:
                groups.setdefault((get_parent(old_name), get_parent(new_name)), []).append((old_name, new_name))
    moved: dict[str, str] = {}
    for pairs in sorted(groups.values(), key=len, reverse=True):
        if len(pairs) < _MIN_EQUAL_EDITS:
            break
        for old_name, new_name in pairs:
            if not _is_inside(old_name, moved) and not _is_inside(new_name, moved.values()):
                moved[old_name] = new_name
    yield from moved.items()


def _group_by_last_name(parts: Mapping[str, _Facts]) -> dict[str, list[str]]:
    names: dict[str, list[str]] = {}
    for name in parts:
        if not _ITEM.search(name):
            names.setdefault(_get_last_name(name), []).append(name)
    return names


def _is_inside(name: str, parts: Collection[str]) -> bool:
    """Return whether a part is among the given parts or inside one of them."""
    return any(part in parts for part in list_part_paths(name))


def _get_last_name(part: str) -> str:
    return part.removeprefix(get_parent(part)).lstrip(".")


def _add_inner_parts(parts: Mapping[str, _Facts], values: Mapping[str, YamlValue]) -> dict[str, _Facts]:
    """Return parts with the parts inside them, the outer ones first."""
    result: dict[str, _Facts] = dict(parts)
    for name, value in values.items():
        is_inside = False
        for part in list_part_paths(name)[:-1]:
            if is_inside:
                result.setdefault(part, Counter()).update(_list_facts(name.removeprefix(part), value))
            is_inside = is_inside or part in parts
    return result


def _compute_similarity(first: _Facts, second: _Facts) -> float:
    return 2 * (first & second).total() / (first.total() + second.total())


def _find_unpaired_parts(values: Mapping[str, YamlValue], others: Mapping[str, YamlValue]) -> dict[str, _Facts]:
    """Return the largest parts that the other values lack, with names and values as facts."""
    other_parts = {part for name in others for part in list_part_paths(name)}
    parts: dict[str, _Facts] = {}
    for name, value in values.items():
        part = next((part for part in list_part_paths(name) if part not in other_parts), None)
        if part is not None:
            parts.setdefault(part, Counter()).update(_list_facts(name.removeprefix(part), value))
    return parts


def _list_facts(name: str, value: YamlValue) -> list[str]:
    return [name, f"{name}={value.text}"]
