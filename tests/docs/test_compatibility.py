"""The page of supported names, compared with the tables."""

from __future__ import annotations

import subprocess
import sys

from tests.docs.pages import DOCS


def test_compatibility_pages_are_current():
    tool = DOCS.parent / "tools" / "compatibility.py"
    subprocess.run([sys.executable, tool, "--check"], check=True, timeout=60)


def test_names_added_after_humble_are_listed_separately():
    page = (DOCS / "compatibility.md").read_text()
    section = page.partition("### launch.actions\n")[2].partition("###")[0]
    assert "`ExecuteProcess`" in section.partition("- Since")[0]
    assert "- Since Kilted: `ForEach`, `ForLoop`" in section
