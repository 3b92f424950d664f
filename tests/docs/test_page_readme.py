"""The page's README explains code that is there."""

from __future__ import annotations

import pytest

from tests.docs.pages import Block, blocks
from tests.places import REPOSITORY

README = REPOSITORY / "frontend" / "README.md"
SHOWN = [block for block in blocks(README) if block.title]


def test_there_is_a_display_to_learn_from() -> None:
    assert len(SHOWN) == 4


@pytest.mark.parametrize("block", SHOWN, ids=lambda block: block.title)
def test_the_code_shown_is_the_code_there_is(block: Block) -> None:
    assert block.text.strip() in (REPOSITORY / block.title).read_text(encoding="utf-8")
