"""Known findings, from a baseline file or from another version of the sources.

Lines are not compared, because an insertion above a finding moves it.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, joined, phrase
from linkwright.diagnostics.phrase import as_phrase, listed_items
from linkwright.files.whole_files import write_whole_file
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import NamedTuple

_QUOTED_NAME = lazy_pattern("'([^']*)'")
_NUMBER = lazy_pattern(r"\d(?:[\d.,\u00a0\u2009\u202f ]*\d)?")
_FORMAT_VERSION = 1
"""The version of the format of baseline files."""


class Key(NamedTuple):
    """The part of a finding that stays the same when the lines around it change.

    Attributes:
        code: the code of the finding.
        file: the path relative to a folder, with ``/``; empty for a finding without a location.
        message: the message in English, without the path of the folder.
    """

    code: str
    file: str
    message: str

    @property
    def names(self) -> frozenset[str]:
        """The quoted names in the message."""
        return frozenset(_QUOTED_NAME.findall(self.message))

    @property
    def without_numbers(self) -> Key:
        """The key without the numbers in the message, except those in quoted names."""
        parts = self.message.split("'")
        parts[::2] = [_NUMBER.sub("#", part) for part in parts[::2]]
        return self._replace(message="'".join(parts))


def make_key(finding: Diagnostic, folder: Path) -> Key:
    """Return the key of a finding.

    Args:
        finding: a finding about any file.
        folder: the absolute folder to which the path in the key is relative.
    """
    file = (
        "" if finding.span is None else os.path.relpath(os.path.realpath(finding.span.file), os.path.realpath(folder))
    )
    message = " ".join(str(finding.message).replace(str(folder), "").split())
    return Key(finding.code, Path(file).as_posix() if file else "", message)


def count_keys(
    findings: Iterable[Diagnostic], folder: Path, names: Mapping[str, str | None] = MappingProxyType({})
) -> dict[Key, int]:
    """Return the number of findings with each key; see `make_key`.

    Args:
        findings: the findings to count.
        folder: the absolute folder to which the paths in the keys are relative.
        names: the new paths of renamed files, by their old paths. Keys of such files have the new path and file name.
    """
    counts: dict[Key, int] = {}
    for finding in findings:
        key = make_key(finding, folder)
        new_name = names.get(key.file)
        if new_name:
            message = key.message.replace(f"'{Path(key.file).name}'", f"'{Path(new_name).name}'")
            key = key._replace(file=new_name, message=message)
        counts[key] = counts.get(key, 0) + 1
    return counts


def find_new_findings(findings: Sequence[Diagnostic], folder: Path, counts: Mapping[Key, int]) -> list[Diagnostic]:
    """Return the findings, leaving out the known number of findings with each key.

    A finding that differs from a known one only in numbers is not new. Of a finding that lists names, such as
    undeclared dependencies, only the names that no known finding lists are new.
    """
    remaining = dict(counts)
    rest: list[tuple[Key, Diagnostic]] = []
    for finding in findings:
        key = make_key(finding, folder)
        if remaining.get(key, 0) > 0:
            remaining[key] -= 1
        else:
            rest.append((key, finding))
    similar: dict[Key, int] = {}
    for key, count in remaining.items():
        similar[key.without_numbers] = similar.get(key.without_numbers, 0) + count
    result = []
    for key, finding in rest:
        if similar.get(key.without_numbers, 0) > 0:
            similar[key.without_numbers] -= 1
            continue
        known_names = [other.names for other in counts if (other.code, other.file) == (key.code, key.file)]
        new = _with_new_names(finding, key, known_names)
        if new is not None:
            result.append(new)
    return result


def _with_new_names(finding: Diagnostic, key: Key, known_names: Sequence[frozenset[str]]) -> Diagnostic | None:
    """Return a finding with the names that no known finding lists, or None if there are none."""
    if key.names and any(key.names < other_names for other_names in known_names):
        return None
    message = as_phrase(finding.message)
    lists = {name: items for name, value in message.arguments.items() if (items := listed_items(value))}
    if len(lists) != 1:
        return finding
    ((argument, entries),) = lists.items()
    listed_names = frozenset(name for item in entries for name in _QUOTED_NAME.findall(item))
    other_names = key.names - listed_names
    fingerprints: frozenset[str] = frozenset().union(
        *(names for names in known_names if other_names <= names and names & listed_names)
    )
    new_items = [item for item in entries if not fingerprints.issuperset(_QUOTED_NAME.findall(item) or [item])]
    if len(new_items) == len(entries):
        return finding
    if not new_items:
        return None
    arguments = {argument: joined(new_items), "count": len(new_items)}
    return finding.with_changes(message=message.with_arguments(**arguments))


def read_baseline(path: Path) -> dict[Key, int]:
    """Return the number of findings with each key in a baseline file.

    Raises:
        LinkwrightError: LINT311, the file cannot be read or is not a baseline.
    """
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        items = {_FORMAT_VERSION: data["findings"]}[data["version"]]
        return {Key(item["code"], item["file"], item["message"]): int(item["count"]) for item in items}
    except (OSError, ValueError, LookupError, TypeError) as error:
        message = phrase(
            "cannot read the baseline '{path}': {reason}", path=display_path(path), reason=foreign(str(error))
        )
        hint = phrase("create it with `linkwright check --baseline {path} --write-baseline`", path=display_path(path))
        raise LinkwrightError(Diagnostic("LINT311", message, hint=hint)) from None


def write_baseline(path: Path, findings: Iterable[Diagnostic], folder: Path) -> int:
    """Write a baseline file, and return the number of findings.

    The file has a line for each key, in a fixed order.

    Raises:
        OSError: the file cannot be written.
    """
    counts = count_keys(findings, folder)
    items = [json.dumps({**key._asdict(), "count": count}, ensure_ascii=False) for key, count in sorted(counts.items())]
    lines = ",\n    ".join(items)
    list_text = f"[\n    {lines}\n  ]" if items else "[]"
    write_whole_file(path, f'{{\n  "version": {_FORMAT_VERSION},\n  "findings": {list_text}\n}}\n')
    return sum(counts.values())
