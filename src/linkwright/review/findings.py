"""The findings of `linkwright check` that only one of two versions has."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Mapping

from linkwright.diagnostics import Diagnostic
from linkwright.lint.checking import Checker
from linkwright.lint.targets import Targets
from linkwright.review.versions import Version

_QUOTED = re.compile("'([^']*)'")
Findings = dict[tuple[str, str, str], list[Diagnostic]]
"""Findings by code, file and message. Lines are not compared, because an insertion above a finding moves it."""


def find(version: Version, targets: Targets, renamed: Mapping[str, str]) -> Findings:
    """Return the findings of a version.

    Args:
        version: the version.
        targets: the files and packages to check.
        renamed: the new paths of files that were renamed later, by path, relative to the root.
    """
    findings: Findings = defaultdict(list)
    checker = Checker(folders=(version.root,))
    for finding in checker.check(targets, [version.root])[0]:
        shown = version.labelled(finding)
        path = "" if shown.span is None else shown.span.file
        message = str(finding.message).replace(str(version.root), "")
        findings[finding.code, renamed.get(path, path), message].append(shown)
    return findings


def without(findings: Findings, others: Findings) -> list[Diagnostic]:
    """Return the findings without as many of each kind as the others have.

    A finding that names several items, such as undeclared dependencies, is not new if another finding named them all.
    """
    named = [(*_place(key), _names(key)) for key in others]
    return [
        finding
        for key, items in findings.items()
        for finding in items[len(others.get(key, ())) :]
        if not any(_place(key) == other[:2] and _names(key) and _names(key) < other[2] for other in named)
    ]


def _place(key: tuple[str, str, str]) -> tuple[str, str]:
    """Return the code and the file."""
    return key[:2]


def _names(key: tuple[str, str, str]) -> frozenset[str]:
    """Return the quoted names in a message."""
    return frozenset(_QUOTED.findall(key[2]))
