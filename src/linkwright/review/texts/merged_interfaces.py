"""Merge added and removed interfaces of ros2_control that belong to one joint, GPIO or sensor."""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import replace

from linkwright.diagnostics import phrase
from linkwright.review.changes import REMOVED_VALUE, Change, Effect
from linkwright.review.texts.merged_reasons import merge_reasons
from linkwright.review.texts.numbered_names import join_numbered

_INTERFACE = re.compile(r"(?P<parent>(?:.* )?(?:command|state)_interface) (?P<name>\S+)")
"""An interface of ros2_control as a whole."""
_SIZE = re.compile(r"\bsize=(\d+)\b")
"""The number of items of an interface, each of which hardware exports under a name of its own."""


def merge_interfaces(changes: Sequence[Change]) -> list[Change]:
    """Return the changes, with added or removed interfaces of the same joint or sensor in one line.

    So is an interface with a size that is replaced by interfaces with the names of its items.
    """
    groups: dict[Hashable, list[Change]] = {}
    for number, change in enumerate(changes):
        key: Hashable = number
        interface = _INTERFACE.fullmatch(change.property_name)
        if interface is not None and change.core is change.sentence:
            content = change.effect, change.name, change.other_names, change.values, change.cases
            key = *content, interface["parent"], change.reason is None
        groups.setdefault(key, []).append(change)
    return list(_replace_sized_interfaces([_join_interfaces(group) for group in groups.values()]))


def _join_interfaces(changes: Sequence[Change]) -> Change:
    first = changes[0]
    if len(changes) == 1:
        return first
    names = [change.property_name.rpartition(" ")[2] for change in changes]
    parent = first.property_name.rpartition(" ")[0]
    sentence = first.sentence.with_arguments(property=f"{parent} {', '.join(join_numbered(names))}")
    return replace(first, sentence=sentence, reason=merge_reasons(change.reason for change in changes))


def _replace_sized_interfaces(changes: Sequence[Change]) -> Iterator[Change]:
    """Yield the changes, with a removed interface and the added interfaces for its items in one line."""
    removed = {_name_items(change): change for change in changes if _SIZE.search(_get_removed_value(change))}
    replaced: set[int] = set()
    result: list[Change] = []
    for change in changes:
        old = (
            removed.get((change.name, change.property_name))
            if change.sentence.template.endswith(("added", "added: {new}"))
            else None
        )
        if old is None or old.cases != change.cases or old.other_names != change.other_names:
            result.append(change)
            continue
        replaced.add(id(old))
        parent = _INTERFACE.fullmatch(old.property_name)
        assert parent is not None
        arguments = change.sentence.arguments
        text = phrase(
            "{subject} '{name}': {property} {old} -> {new}",
            subject=arguments["subject"],
            name=change.name,
            property=parent["parent"],
            old=f"{parent['name']} {_get_removed_value(old)}",
            new=f"{change.property_name.removeprefix(parent['parent'])} {arguments.get('new', '')}".strip(),
        )
        result.append(replace(change, sentence=text))
    yield from (change for change in result if id(change) not in replaced)


def _get_removed_value(change: Change) -> str:
    """Return the attributes of a removed interface that breaks nothing; empty for other changes."""
    is_interface = _INTERFACE.fullmatch(change.property_name) is not None and change.effect is not Effect.BREAKING
    return str(change.sentence.arguments.get(REMOVED_VALUE, "")) if is_interface else ""


def _name_items(change: Change) -> tuple[str, str]:
    """Return the extension and the property under which the items of a removed interface would be added."""
    size = _SIZE.search(_get_removed_value(change))
    assert size is not None
    parent, _, name = change.property_name.rpartition(" ")
    items = join_numbered([f"{name}_{index}" for index in range(int(size[1]))])
    return change.name, f"{parent} {', '.join(items)}"
