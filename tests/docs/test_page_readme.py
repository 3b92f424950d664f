"""The page's README names only existing code."""

from __future__ import annotations

import pytest

from tests.docs.pages import Block, read_blocks
from tests.places import REPOSITORY

README = REPOSITORY / "frontend" / "README.md"
SHOWN = [block for block in read_blocks(README) if block.title]


def test_readme_shows_four_code_blocks() -> None:
    assert len(SHOWN) == 4


@pytest.mark.parametrize("block", SHOWN, ids=lambda block: block.title)
def test_shown_code_is_in_source(block: Block) -> None:
    assert block.text.strip() in (REPOSITORY / block.title).read_text(encoding="utf-8")
