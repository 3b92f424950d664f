"""The documentation's pages and the code blocks in them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from tests.places import REPOSITORY

DOCS = REPOSITORY / "docs"
READMES = (REPOSITORY / "README.md", REPOSITORY / "README.zh-CN.md")

_BLOCK = re.compile(
    r'^```(?P<language>\w+)(?: title="(?P<title>[^"]+)")?\n(?P<text>.*?)^```$', re.MULTILINE | re.DOTALL
)


@dataclass(frozen=True)
class Block:
    """A fenced code block; `title` is the file in which the page puts it, or empty."""

    language: str
    title: str
    text: str


def find_pages() -> list[Path]:
    """Return all pages for users, including the READMEs, without the decision records."""
    pages = [path for path in sorted(DOCS.rglob("*.md")) if "decisions" not in path.parts]
    return [*READMES, *pages]


def read_blocks(page: Path) -> list[Block]:
    """Return the page's code blocks in order."""
    matches = _BLOCK.finditer(page.read_text(encoding="utf-8"))
    return [Block(match["language"], match["title"] or "", match["text"]) for match in matches]


def read_commands(page: Path) -> list[str]:
    """Return the ``linkwright`` lines of the page's shell blocks, without comments."""
    lines = [line for block in read_blocks(page) if block.language == "bash" for line in block.text.splitlines()]
    lines = [line.split(" #")[0].strip() for line in lines]
    return [line for line in lines if line.startswith("linkwright ")]
