"""Find lists of mappings in parameter files of ROS 2 that become mappings.

No parameter of ROS 2 is a list of mappings, so that no node had the old values.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from linkwright.diagnostics import joined_first, phrase
from linkwright.review.changes import MAX_NAMES, Change, Location
from linkwright.review.file_pair import FilePair
from linkwright.review.files.parameters.value_changes import ValueChange
from linkwright.review.files.parameters.yaml_values import YamlValue

_ITEM = re.compile(r"(?P<list>(?:.*\.)?ros__parameters\.[^\[\]]+)\[[^\[\]]*\](?P<rest>\..+)")
"""The path of a value in a mapping that is an item of a list."""


def find_replaced_lists(old: Mapping[str, YamlValue], new: Mapping[str, YamlValue]) -> dict[str, str]:
    """Return the new paths of values in lists of mappings that are mappings in the new version, by old path.

    Args:
        old: the old values by path.
        new: the new values by path.
    """
    matches = {path: match for path in old if (match := _ITEM.fullmatch(path)) is not None}
    remaining = {match["list"] for path in new if (match := _ITEM.fullmatch(path)) is not None}
    paths = {path: match["list"] + match["rest"] for path, match in matches.items()}
    counts = Counter(paths.values())
    return {
        path: new_path
        for path, new_path in paths.items()
        if matches[path]["list"] not in remaining and counts[new_path] == 1 and new_path in new
    }


def report_replaced_lists(pair: FilePair, paths: Mapping[str, str], new: Mapping[str, YamlValue]) -> None:
    """Report the lists of mappings that become mappings.

    Args:
        pair: both versions of the file.
        paths: the new paths of their values, by old path.
        new: the new values by path.
    """
    if not paths:
        return
    first = new[next(iter(paths.values()))]
    text = phrase(
        "lists of mappings, which no parameter of ROS 2 can be, became mappings: {names}",
        names=joined_first(_list_names(paths), MAX_NAMES),
    )
    pair.changes.append(Change(text, location=Location(pair.new_path, first.line, first.column)))


def drop_reasons_of_lists(changes: Iterable[ValueChange], paths: Iterable[str]) -> Iterator[ValueChange]:
    """Yield the changes; those of values in lists of mappings that become mappings break nothing.

    Args:
        changes: the changes of the values.
        paths: the old paths of the values in such lists.
    """
    names = _list_names(paths)
    for change in changes:
        is_inside = any(change.name == name or change.name.startswith((f"{name}.", f"{name}[")) for name in names)
        yield replace(change, reason=None) if is_inside else change


def _list_names(paths: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(_ITEM.sub(r"\g<list>", path) for path in paths))
