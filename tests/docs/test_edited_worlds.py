"""docs/worlds.md: the text that modeling writes."""

from __future__ import annotations

import textwrap

import pytest

from linkwright.sdf.editing import add_shape
from tests.docs.pages import DOCS, read_blocks
from tests.sdf.editing.texts import world_with


@pytest.mark.parametrize("page", [DOCS / "worlds.md", DOCS / "zh" / "worlds.md"], ids=["en", "zh"])
def test_ramp_is_written_as_shown(page) -> None:
    world, _ = add_shape(world_with(), "ramp", (3, 0, 0.25, 0, 0, 1.5), (2, 1, 0.5))
    documented = next(block.text for block in read_blocks(page) if '<model name="ramp">' in block.text)
    assert textwrap.indent(documented, "    ") in world.text
