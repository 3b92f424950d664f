"""Find added nodes that start a launch file which an action included before."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path, PurePosixPath

from linkwright.review.launches.outlines import Entry
from linkwright.review.launches.programs.default_names import find_script


def find_starting_node(include: Entry, added: Sequence[Entry], root: Path) -> Entry | None:
    """Return the added node whose script names an included file, or None.

    Args:
        include: the removed action that included the file.
        added: the actions that only the new version has.
        root: the folder of the new version of the repository.
    """
    name = PurePosixPath(include.name).name
    if include.kind != "include" or not name or "$" in name:
        return None
    word = re.compile(rf"(?<![\w.-]){re.escape(name)}(?![\w.-])")
    for entry in added:
        script = find_script(root, entry.name) if entry.kind == "node" else None
        if script is not None and word.search(script.read_text("utf-8", errors="replace")):
            return entry
    return None
