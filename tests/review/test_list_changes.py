"""Changed values and shortened texts in one line."""

from __future__ import annotations

import pytest

from linkwright.review.texts.excerpts import differing_excerpts, shorten, shorten_middle
from linkwright.review.texts.list_changes import change_text


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


def test_a_list_of_numbers_has_an_order():
    text = change_text("map", "[0, 1, 2, 3, 4, 5]", "[5, 6, 4, 3, 2, 1]")
    assert str(text) == "map [0, 1, 2, 3, 4, 5] -> [5, 6, 4, 3, 2, 1]"


def test_changed_numbers_of_a_long_list_have_their_indexes():
    numbers = [f"{number / 8}" for number in range(20)]
    old = f"[{', '.join(numbers)}]"
    new = old.replace(" 0.25,", " 0.3,").replace(" 2.0,", " -1,")
    assert str(change_text("points", old, new)) == "points: [2] 0.25 -> 0.3, [16] 2.0 -> -1"
    longer = new.replace("]", ", 7.0]")
    assert str(change_text("points", old, longer)).startswith("points [0.0, 0.125, 0.25,")
    others = old.replace("5,", "6,")
    assert str(change_text("points", old, others)) == f"points {old} -> {others}"


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


def test_middle_of_a_long_text_is_omitted():
    text = "[front_left_controller, --controller-manager, /robot/controller_manager, --inactive]"
    assert shorten_middle(text, 48) == "[front_left_controller, ... /robot/controller_manager, --inactive]"
    assert shorten_middle(text, 80) == text


def test_every_difference_of_a_long_text_is_shown():
    middle = " ".join(f"word_{number}" for number in range(60))
    old, new = (
        f"run {first} {middle} {second} {middle} end" for first, second in (("left", "slow"), ("right", "fast"))
    )
    excerpts = differing_excerpts(old, new)
    assert excerpts == (
        "run left word_0 word_1 word_2 ... word_57 word_58 word_59 slow word_0 word_1 word_2 ...",
        "run right word_0 word_1 word_2 ... word_57 word_58 word_59 fast word_0 word_1 word_2 ...",
    )


def test_difference_behind_a_long_one_is_shown():
    common = " ".join(f"word_{number}" for number in range(40))
    inserted = "inserted " * 80
    old, new = f"a {common} b", f"a {inserted}{common} c"
    before, after = differing_excerpts(old, new)
    assert before.endswith(" b")
    assert after.endswith(" c")
    assert len(after) < 600


def test_difference_of_a_text_with_many_tokens_is_shown():
    old = " ".join(str(number) for number in range(3000))
    assert differing_excerpts(old, old.replace(" 1500 ", " x ")) == (
        "... 1496 1497 1498 1499 1500 1501 1502 1503 1504 ...",
        "... 1496 1497 1498 1499 x 1501 1502 1503 1504 ...",
    )


@pytest.mark.parametrize("frame", ["#", "*", "="])
def test_frame_around_a_long_text_is_left_out(frame):
    text = f"{frame * 80}\n{'#' if frame == '#' else '*'}  Use camera.launch.py!  *\n{frame * 80}\n"
    assert shorten_middle(text, 60) == "Use camera.launch.py!"
    assert shorten_middle("#### a ####", 60) == "#### a ####"


def test_changed_value_of_an_option_is_told_with_the_option():
    items = [
        "-topic",
        "/arm/robot_description",
        "-entity",
        "arm",
        "-x",
        "1.0",
        "-y",
        "2.0",
        "-z",
        "0.4",
        "-timeout",
        "9",
    ]
    old = f"[{', '.join(items)}]"
    assert str(change_text("arguments", old, old.replace("0.4", "0.5"))) == "arguments: -z 0.4 -> 0.5"
    assert str(change_text("arguments", old, old.replace("-z", "-R"))) == "arguments: -R added, -z removed"
