"""Compare lists of lists with single values, such as a polygon that becomes a text."""

from __future__ import annotations

import re
from collections.abc import Mapping

from linkwright.review.files.parameters.yaml_values import YamlType, YamlValue

_ITEM = re.compile(r"(?P<list>.+?)(?:\[\d+\])+")
"""The path of an item of a list of lists, without mappings inside it."""


def merge_nested_lists(values: Mapping[str, YamlValue], others: Mapping[str, YamlValue]) -> dict[str, YamlValue]:
    """Return values by path; a list of lists is one value if the other version has a single value in its place.

    No parameter of ROS 2 is such a list, so that its type is mixed.

    Args:
        values: the values of one version by path.
        others: the values of the other version by path.
    """
    owners = {path: match["list"] for path in values if (match := _ITEM.fullmatch(path)) is not None}
    lists: dict[str, list[YamlValue]] = {}
    for path, owner in owners.items():
        if owner in others and owner not in values:
            lists.setdefault(owner, []).append(values[path])
    merged: dict[str, YamlValue] = {}
    for path, value in values.items():
        items = lists.get(owners.get(path, ""))
        if items is None:
            merged[path] = value
        elif items[0] is value:
            text = f"[{', '.join(item.text for item in items)}]"
            merged[owners[path]] = YamlValue(text, value.line, value.column, YamlType.MIXED, is_list=True)
    return merged
