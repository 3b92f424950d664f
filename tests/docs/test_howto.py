"""How-to pages: a reader who follows them, line by line, gets what they promise."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.docs.pages import DOCS, blocks
from tests.docs.reader import Known

PUBLISH = 'linkwright topic pub -r 10 /cmd_vel geometry_msgs/msg/Twist "{linear: {x: 0.3}, angular: {z: 0.5}}"'


@pytest.mark.parametrize("page", sorted(DOCS.glob("howto-*.md")), ids=lambda page: page.stem)
def test_the_languages_show_the_same_files(page: Path) -> None:
    english, chinese = (
        [(each.title, each.text) for each in blocks(p) if each.title] for p in (page, DOCS / "zh" / page.name)
    )
    assert english == chinese


@pytest.mark.slow
def test_a_urdf_without_masses_is_driven_and_put_into_a_world(follow: Callable[..., Path]) -> None:
    follow(DOCS / "howto-drive.md", {PUBLISH: Known(shows="publishing #1")})
    home = follow(DOCS / "howto-world.md", {})
    cart = (home / "cart.urdf").read_text(encoding="utf-8")
    assert cart.count("<mass ") == 4
    assert "libgazebo_ros_diff_drive.so" in cart
    assert (home / "yard.world").is_file()
