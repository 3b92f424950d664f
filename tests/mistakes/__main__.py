"""Write the current findings into the Markdown files.

Run ``python -m tests.mistakes``, and read the difference afterwards.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from .cases import read_cases


def rewrite_findings(page: Path) -> None:
    """Write the current findings into one file."""
    text = page.read_text(encoding="utf-8")
    for case in read_cases(page):
        with tempfile.TemporaryDirectory() as folder:
            result = case.check(Path(folder).resolve())
        start = text.index("\n```text\n", text.index(f"## {case.title}\n")) + len("\n```text\n")
        text = text[:start] + (f"{result}\n" if result else "") + text[text.index("```\n", start) :]
    page.write_text(text, encoding="utf-8")


for name in sys.argv[1:] or [path.name for path in sorted(Path(__file__).parent.glob("*.md"))]:
    rewrite_findings(Path(__file__).with_name(name))
