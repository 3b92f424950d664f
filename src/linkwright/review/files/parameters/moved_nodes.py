"""Find nodes whose parameters, and other parts whose values, move to another parameter file or to a launch file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from linkwright.diagnostics import Phrase, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.file_pair import FilePair, UnreadableFileError
from linkwright.review.files.parameters.lost_groups import LAUNCH_SUFFIXES, is_named_by_launch_file, list_changed_files
from linkwright.review.files.parameters.names import find_node_name
from linkwright.review.files.parameters.yaml_values import YamlValue, read_yaml_values
from linkwright.review.texts.list_changes import change_text
from linkwright.review.versions import Version

_PARAMETERS = "ros__parameters"
_MIN_VALUES = 3
"""The minimum number of values by which a part in another file is recognized."""
_MIN_SHARE = 0.5
"""The minimum share of the values that stay equal."""


def find_node_move(pair: FilePair, name: str, values: Mapping[str, YamlValue]) -> Phrase | None:
    """Return the line about a removed node whose parameters another file newly has; None for other parts.

    Args:
        pair: both versions of the file that loses the parameters.
        name: the path of the removed part.
        values: the removed values by path.
    """
    nodes = {find_node_name(path) for path in values}
    if len(nodes) != 1 or None in nodes or not (name in nodes or f"{name}.".startswith(f"{next(iter(nodes))}.ros__")):
        return None
    versions = pair.versions
    launch_file = _find_setting_file(pair, next(filter(None, nodes)), values)
    if launch_file is not None:
        return _describe_move(name, launch_file, [])
    for path in list_changed_files(pair):
        items = _compare_part(pair, name, values, path) if is_named_by_launch_file(versions.new, path) else None
        if items is not None:
            return _describe_move(name, path, items)
    return None


def find_group_move(pair: FilePair, name: str, values: Mapping[str, YamlValue]) -> Phrase | None:
    """Return the line about a removed part that another changed file newly has; None if no file has it.

    Args:
        pair: both versions of the file that loses the part.
        name: the path of the removed part.
        values: the removed values by path.
    """
    for path in list_changed_files(pair) if len(values) >= _MIN_VALUES else ():
        items = _compare_part(pair, name, values, path)
        if items is not None:
            text = _describe_move(name, path, items)
            return text if items else phrase("{change} with the same values", change=text)
    return None


def _describe_move(name: str, path: str, items: Sequence[Phrase]) -> Phrase:
    text = phrase("{old} moved to {name}", old=name, name=path)
    return phrase("{change}, with {items}", change=text, items=joined_first(items, MAX_NAMES)) if items else text


def _compare_part(pair: FilePair, name: str, values: Mapping[str, YamlValue], path: str) -> list[Phrase] | None:
    """Return the values that differ in a part that moved to a file, or None if the file does not newly have it."""
    versions = pair.versions
    found = _read_values(versions.new, path) if path != pair.new_path else {}
    old_path = next((file.old_path for file in versions.changed_files if file.new_path == path), None)
    known = _read_values(versions.old, old_path) if old_path is not None else {}
    if not values.keys() <= found.keys() or not values.keys().isdisjoint(known):
        return None
    changed = [item for item, value in values.items() if value.text != found[item].text]
    if len(changed) > (1 - _MIN_SHARE) * len(values):
        return None
    added = [item for item in found if item.startswith(f"{name}.") and item not in values and item not in known]
    names = {item: item.removeprefix(name).lstrip(".").removeprefix(f"{_PARAMETERS}.") for item in (*changed, *added)}
    items = [change_text(names[item], values[item].shown, found[item].shown) for item in changed]
    return items + [phrase("{name} {value} added", name=names[item], value=found[item].shown) for item in added]


def _find_setting_file(pair: FilePair, node: str, values: Iterable[str]) -> str | None:
    """Return the changed launch file that newly sets the parameters of a node itself; None if there is none."""
    short_name = node.rpartition(".")[2].rpartition("/")[2]
    names = [path.rpartition(f"{_PARAMETERS}.")[2] for path in values]
    for file in pair.versions.changed_files:
        if file.old_path is None or file.new_path is None or not file.new_path.endswith(LAUNCH_SUFFIXES):
            continue
        old, new = pair.versions.old.text(file.old_path), pair.versions.new.text(file.new_path)
        sets_all = [all(_is_quoted(name, text) for name in names) for text in (old, new)]
        if _is_quoted(short_name, new) and sets_all == [False, True]:
            return file.new_path
    return None


def _is_quoted(name: str, text: str) -> bool:
    return f"'{name}'" in text or f'"{name}"' in text


def _read_values(version: Version, path: str) -> dict[str, YamlValue]:
    """Return the values of a file by path; none if it cannot be read."""
    try:
        return read_yaml_values(version.text(path))
    except UnreadableFileError:
        return {}
