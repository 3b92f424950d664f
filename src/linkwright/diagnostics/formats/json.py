"""Diagnostics as JSON: an object with a list ``diagnostics``.

Lines and columns count from 1; a missing position is null.
"""

from __future__ import annotations

import json
from collections.abc import Iterable

from linkwright.diagnostics.diagnostic import Diagnostic
from linkwright.diagnostics.render import to_data


def to_text(diagnostics: Iterable[Diagnostic]) -> str:
    """Return diagnostics as the text of one JSON object."""
    data = {"diagnostics": [to_data(diagnostic) for diagnostic in diagnostics]}
    return json.dumps(data, indent=2, ensure_ascii=False) + "\n"
