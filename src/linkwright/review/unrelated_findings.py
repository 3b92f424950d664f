"""Find findings that are new only because the repository lost the description of another robot."""

from __future__ import annotations

import re
from collections.abc import Sequence

from linkwright.diagnostics import Diagnostic
from linkwright.review.versions import Versions

_UNUSED_CODE = "LW701"
"""The finding about a property that neither its description nor another one of the package uses."""
_DESCRIPTION_SUFFIXES = (".xacro", ".urdf")


def drop_unrelated_findings(versions: Versions, added: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Return the new findings without those about unused properties of other robots.

    A removed description that used a property of an unchanged file may have defined one of the same name. Then its uses
    meant its own property, and the property of the unchanged file had no use before either.

    Args:
        versions: both versions.
        added: the findings that only the new version has, with relative paths.
    """
    changed = {file.new_path for file in versions.changed_files}
    removed = [
        versions.old.text(file.old_path)
        for file in versions.changed_files
        if file.new_path is None and file.old_path is not None and file.old_path.endswith(_DESCRIPTION_SUFFIXES)
    ]

    def is_unrelated(finding: Diagnostic) -> bool:
        if finding.code != _UNUSED_CODE or finding.span is None or finding.span.file in changed:
            return False
        name = re.escape(str(getattr(finding.message, "arguments", {}).get("name", "")))
        own = re.compile(rf"<(?:xacro:)?property\s[^>]*\bname\s*=\s*[\"']{name}[\"']")
        return any(own.search(text) for text in removed)

    return [finding for finding in added if not is_unrelated(finding)]
