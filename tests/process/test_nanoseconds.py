"""The number of nanoseconds in a second is defined in one file only."""

from __future__ import annotations

import re
from pathlib import Path

import linkwright
from linkwright.process import nanoseconds


def test_nanoseconds_per_second_is_defined_only_once() -> None:
    number = re.compile(r"\b1_?000_?000_?000\b|^_?(?:SECOND|NANO|NANOSECONDS|NS) = ", re.MULTILINE)
    sources = Path(linkwright.__file__).parent.rglob("*.py")
    offending_files = [path for path in sources if number.search(path.read_text(encoding="utf-8"))]
    assert offending_files == [Path(nanoseconds.__file__)]
