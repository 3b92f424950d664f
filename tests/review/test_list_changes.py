"""Changed values and shortened texts in one line."""

from __future__ import annotations

import pytest

from linkwright.review.list_changes import change_text, shorten


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
    assert shorten(text, 16) == expected


def test_lists_in_lists_are_compared_by_their_items():
    old = [f"[input_{number}, output_{number}]" for number in range(12)]
    new = [*old[::-1], "[x, y]"]
    text = change_text("pairs", f"[{', '.join(old)}]", f"[{', '.join(new)}]")
    assert str(text) == "pairs: [x, y] added"


def test_long_text_of_words_has_the_replaced_added_and_removed_ones():
    words = [f"/camera/topic_{number}" for number in range(20)]
    new = ["/first", *words[:5], "/lidar/points", *words[6:12], *words[13:]]
    text = change_text("topics", " ".join(words), " ".join(new))
    assert str(text) == "topics: /camera/topic_5 -> /lidar/points; /first added; /camera/topic_12 removed"


def test_words_of_a_long_command_keep_their_substitutions():
    arguments = " ".join(f"option_{number}:=$(arg option_{number})" for number in range(12))
    text = change_text("args", f"{arguments} x:=$(find a b)/c", f"{arguments} x:=$(find a d)/c -v")
    assert str(text) == "args: x:=$(find a d)/c, -v added; x:=$(find a b)/c removed"


def test_long_text_of_numbers_is_not_compared_by_words():
    old, new = " ".join(["0.25"] * 80), " ".join(["0.25"] * 60 + ["0.5"] * 20)
    assert " -> " in str(change_text("matrix", old, new))
