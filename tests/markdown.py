"""Test cases on Markdown pages.

A ``##`` heading is a case, and the fenced blocks below it are its parts.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

_SECTION = re.compile(r"^## (?P<title>.+)\n(?P<body>(?:(?!^## ).*\n?)*)", re.MULTILINE)
_BLOCK = re.compile(r"^```(?P<kind>\w+)(?: +(?P<label>\S+))?\n(?P<text>(?:(?!^```$).*\n)*)^```$", re.MULTILINE)


class Block(NamedTuple):
    """A fenced block: its language, the word after it or "", its lines."""

    kind: str
    label: str
    text: str


def read_sections(page: Path) -> list[tuple[str, list[Block]]]:
    """Return the titles of a page's sections, with the blocks in each."""
    text = page.read_text(encoding="utf-8")
    return [
        (
            section["title"].strip(),
            [Block(block["kind"], block["label"] or "", block["text"]) for block in _BLOCK.finditer(section["body"])],
        )
        for section in _SECTION.finditer(text)
    ]
