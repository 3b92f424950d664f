"""Findings that are known already: those of a baseline file, or of another version.

Lines are not compared, because an insertion above a finding moves it.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, phrase
from linkwright.files.whole_files import write_whole_file
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import NamedTuple

_QUOTED = lazy_pattern("'([^']*)'")
_VERSION = 1
"""The version of the format of baseline files."""


class Key(NamedTuple):
    """The part of a finding that stays the same when the lines around it change.

    Attributes:
        code: the code.
        file: the path relative to a folder, with ``/``; empty for a finding without a location.
        message: the message in English, without the path of the folder.
    """

    code: str
    file: str
    message: str

    @property
    def names(self) -> frozenset[str]:
        """The quoted names in the message."""
        return frozenset(_QUOTED.findall(self.message))


def key_of(finding: Diagnostic, folder: Path) -> Key:
    """Return the key of a finding.

    Args:
        finding: the finding.
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
    """Return the number of findings with each key; see `key_of`.

    Args:
        findings: the findings.
        folder: the absolute folder to which the paths in the keys are relative.
        names: the other names that files have in the keys.
    """
    counts: dict[Key, int] = {}
    for finding in findings:
        key = key_of(finding, folder)
        key = key._replace(file=names.get(key.file) or key.file)
        counts[key] = counts.get(key, 0) + 1
    return counts


def new_findings(findings: Sequence[Diagnostic], folder: Path, known: Mapping[Key, int]) -> list[Diagnostic]:
    """Return the findings without as many of each key as are known.

    A finding that names several items, such as undeclared dependencies, is not new if a known finding names them all.
    """
    remaining = dict(known)
    names: dict[tuple[str, str], list[frozenset[str]]] = {}
    for key in known:
        names.setdefault((key.code, key.file), []).append(key.names)
    result = []
    for finding in findings:
        key = key_of(finding, folder)
        if remaining.get(key, 0) > 0:
            remaining[key] -= 1
        elif not (key.names and any(key.names < others for others in names.get((key.code, key.file), ()))):
            result.append(finding)
    return result


def read_baseline(path: Path) -> dict[Key, int]:
    """Return the number of findings with each key in a baseline file.

    Raises:
        LinkwrightError: LINT311, the file cannot be read or is not a baseline.
    """
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        items = {_VERSION: data["findings"]}[data["version"]]
        return {Key(item["code"], item["file"], item["message"]): int(item["count"]) for item in items}
    except (OSError, ValueError, LookupError, TypeError) as error:
        message = phrase(
            "cannot read the baseline '{path}': {reason}", path=display_path(path), reason=foreign(str(error))
        )
        hint = phrase("create it with `linkwright check --baseline {path} --write-baseline`", path=display_path(path))
        raise LinkwrightError(Diagnostic("LINT311", message, hint=hint)) from None


def write_baseline(path: Path, findings: Iterable[Diagnostic], folder: Path) -> int:
    """Write a baseline file with a line for each key, in a fixed order, and return the number of findings.

    Raises:
        OSError: the file cannot be written.
    """
    counts = count_keys(findings, folder)
    items = [json.dumps({**key._asdict(), "count": count}, ensure_ascii=False) for key, count in sorted(counts.items())]
    lines = ",\n    ".join(items)
    listed = f"[\n    {lines}\n  ]" if items else "[]"
    write_whole_file(path, f'{{\n  "version": {_VERSION},\n  "findings": {listed}\n}}\n')
    return sum(counts.values())
