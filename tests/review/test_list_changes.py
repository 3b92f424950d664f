"""Changed values and shortened texts in one line."""

from __future__ import annotations

import pytest

from linkwright.review.list_changes import change_text, shortened


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[front, back, left]", "[front, back, ..."),
        ("see the left camera", "see the left ..."),
        ("front_left_camera_x", "front_left_camer..."),
        ("[front, back]", "[front, back]"),
    ],
)
def test_shortened_text_ends_after_a_whole_item(text, expected):
    assert shortened(text, 16) == expected


def test_lists_in_lists_are_compared_by_their_items():
    old = [f"[input_{number}, output_{number}]" for number in range(12)]
    new = [*old[::-1], "[x, y]"]
    text = change_text("pairs", f"[{', '.join(old)}]", f"[{', '.join(new)}]")
    assert str(text) == "pairs: [x, y] added"
