"""Expand a description, or only its valid parts if it contains errors."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from linkwright.diagnostics import LinkwrightError
from linkwright.language.workspace import Workspace
from linkwright.xacro import Expansion, expand
from linkwright.xacro.parts import expand_parts
from linkwright.xacro.session import Inputs
from linkwright.xmltree import Overlay


def expand_valid_parts(workspace: Workspace, texts: Mapping[Path, str], entry: Path) -> Expansion | None:
    """Expand a description with default arguments, or only its valid parts if it has errors.

    Returns None if nothing can be expanded.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        entry: the description.
    """
    overlay = Overlay({str(path): text for path, text in texts.items()})
    inputs = Inputs(str(entry), {}, workspace.finder(entry), overlay=overlay)
    try:
        return expand(entry, packages=workspace.finder(entry), overlay=overlay)
    except (LinkwrightError, OSError, RecursionError) as error:
        with suppress(LinkwrightError, OSError, RecursionError):
            return expand_parts(inputs, error) if isinstance(error, LinkwrightError) else None
    return None
