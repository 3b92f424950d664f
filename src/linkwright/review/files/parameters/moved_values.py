"""Find single values of YAML files that move together into another part, or out of it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from linkwright.review.files.parameters.yaml_values import YamlValue

_MIN_TEXTS = 2
"""The minimum number of equal texts by which values that move together are recognized."""
_PLAIN_VALUE = re.compile(r"[-+.,\s\d\[\]e]*|true|false|null|\{\}", re.IGNORECASE)
"""A value that many parts can have in common."""


def find_moved_values(old: Mapping[str, YamlValue], new: Mapping[str, YamlValue]) -> Iterator[tuple[str, str]]:
    """Yield the old and new paths of values that move together, and keep their last names and texts.

    One of both parts around the values is inside the other one, as in ``in.topic`` and ``in.camera.topic``.

    Args:
        old: the old values by path.
        new: the new values by path.
    """
    removed, added = _group_values(old, new), _group_values(new, old)
    for parent, names in removed.items():
        matches = []
        for new_parent, new_names in added.items():
            common = [key for key in names if key in new_names and old[names[key]].text == new[new_names[key]].text]
            texts = {old[names[key]].text for key in common if not _PLAIN_VALUE.fullmatch(old[names[key]].text)}
            if len(texts) >= _MIN_TEXTS and _is_below(parent, new_parent):
                matches.append((new_names, common))
        if len(matches) == 1:
            new_names, common = matches[0]
            yield from ((names[key], new_names[key]) for key in common)


def _group_values(values: Mapping[str, YamlValue], others: Mapping[str, YamlValue]) -> dict[str, dict[str, str]]:
    """Return the paths of the values that the other version lacks, by the part around them and their last name."""
    groups: dict[str, dict[str, str]] = {}
    for name in values:
        parent, _, key = name.rpartition(".")
        if name not in others and "[" not in name:
            groups.setdefault(parent, {})[key] = name
    return groups


def _is_below(first: str, second: str) -> bool:
    """Return whether one of two parts is inside the other one."""
    return f"{first}.".startswith(f"{second}.") or f"{second}.".startswith(f"{first}.")
