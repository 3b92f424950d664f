"""Findings in the notation of ``mistakes.md``."""

from __future__ import annotations

import tempfile
from pathlib import Path

from linkwright.descriptions import examine_world
from linkwright.lint.engine import sort_by_location
from tests.urdf.mistakes import finding_lines


def describe_findings(text: str) -> str:
    """Return the findings about a world in an empty folder, with one line for each fact."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "w.world")
        path.write_text(text, encoding="utf-8")
        diagnostics = examine_world(path, environment={"HOME": folder}).diagnostics
        lines = [line for diagnostic in sort_by_location(diagnostics, str(path)) for line in finding_lines(diagnostic)]
        return "\n".join(lines).replace(folder, "FOLDER")
