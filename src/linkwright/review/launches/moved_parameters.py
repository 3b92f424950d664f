"""Find parameters of nodes that move from a launch file into a parameter file that the node newly loads."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.parameters.names import find_node_name
from linkwright.review.files.parameters.yaml_values import YamlValue, read_yaml_values
from linkwright.review.launches.conditional_settings import SettingPair
from linkwright.review.launches.outlines import PARAMETER, LaunchOutline
from linkwright.review.versions import Version

_FILES = "parameters"
_FILE = re.compile(r"\$\(find(?:-pkg-share)? (?P<package>[\w.-]+)\)/(?P<path>[\w./-]+\.ya?ml)")
_SECTION = ".ros__parameters."


def follow_moved_parameters(
    pairs: Sequence[SettingPair], outline: LaunchOutline, version: Version
) -> Iterator[SettingPair]:
    """Yield the changed settings of a node, with the new values of parameters that moved into a file.

    A parameter that has the same value there is left out.

    Args:
        pairs: the settings that differ.
        outline: the actions of the new version.
        version: the new version, which has the parameter files.
    """
    has_removed = any(pair.name.startswith(PARAMETER) and pair.new is None for pair in pairs)
    values = _read_added_files(pairs, outline, version) if has_removed else {}
    for pair in pairs:
        key = pair.name.removeprefix(PARAMETER).lstrip("~/").replace("/", ".")
        moved = values.get(key) if pair.new is None and pair.name.startswith(PARAMETER) else None
        if moved is None or pair.old is None:
            yield pair
            continue
        file, value = moved
        if not _are_equal(pair.old, value.text):
            yield SettingPair(pair.name, pair.old, f"{value.shown} ({file})", pair.old, value.text)


def _read_added_files(
    pairs: Sequence[SettingPair], outline: LaunchOutline, version: Version
) -> dict[str, tuple[str, YamlValue]]:
    """Return the values in the parameter files that a node newly loads, by parameter, each with the name of the file.

    Files with the parameters of several nodes are left out.
    """
    result: dict[str, tuple[str, YamlValue]] = {}
    changed = next((pair for pair in pairs if pair.name == _FILES and pair.new), None)
    known = {match[0] for match in _FILE.finditer(changed.old or "")} if changed is not None else set()
    for match in _FILE.finditer(outline.resolve(changed.new or "") if changed is not None else ""):
        share = version.share_of(match["package"], version.root)
        file = None if share is None or ".." in match["path"] else share / match["path"]
        path = None if file is None or not file.is_file() or match[0] in known else version.relative(file)
        try:
            values = read_yaml_values(version.text(path)) if path else {}
        except UnreadableFileError:
            continue
        if len({find_node_name(name) for name in values}) == 1:
            name = match["path"]
            result |= {key.rpartition(_SECTION)[2]: (name, value) for key, value in values.items()}
    return result


def _are_equal(old: str, new: str) -> bool:
    try:
        return float(old) == float(new)
    except ValueError:
        return old.strip("\"'").lower() == new.lower()
