"""Find new findings about unused definitions that a removed file with definitions of the same names only hid."""

from __future__ import annotations

import re
from collections.abc import Sequence

from linkwright.diagnostics import Diagnostic
from linkwright.review.findings.comparing import QUOTED_NAME
from linkwright.review.unprefixed_calls import DESCRIPTION_SUFFIXES
from linkwright.review.versions import Versions

_TAGS = {"LW701": "property", "LW702": "arg", "LW703": "macro"}
"""The tags of the unused definitions, by the code of the finding."""


def drop_hidden_findings(versions: Versions, added: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Return the new findings without those of unchanged files about definitions that nothing used before, either.

    The check counts a name as used if another description of the package mentions it. A removed one that defined the
    name itself used its own definition.

    Args:
        versions: both versions.
        added: the findings that only the new version has, with relative paths.
    """
    changed = {file.new_path for file in versions.changed_files}
    removed = [file.old_path for file in versions.changed_files if file.old_path and file.new_path is None]

    def is_hidden(finding: Diagnostic) -> bool:
        tag, names = _TAGS.get(finding.code), QUOTED_NAME.findall(str(finding.message))
        if tag is None or not names or finding.span is None or finding.span.file in changed:
            return False
        definition = re.compile(rf"<xacro:{tag}\s+name=[\"']{re.escape(names[0])}[\"']")
        return any(
            definition.search(versions.old.text(path)) for path in removed if path.endswith(DESCRIPTION_SUFFIXES)
        )

    return [finding for finding in added if not is_hidden(finding)]
