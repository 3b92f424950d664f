"""Colors of a terminal, by the stand-in of osrf_pycommon."""

from __future__ import annotations

import pytest
from osrf_pycommon import terminal_color


@pytest.fixture(autouse=True)
def _restored_colors():
    yield
    terminal_color.enable_ansi_color_substitution_globally()


def test_color_marks_become_escape_sequences(capsys):
    assert terminal_color.format_color("@{redf}a@!b@|c") == "\033[31ma\033[1mb\033[0mc\033[0m"
    terminal_color.print_color("@{greenb}x", 1, end="")
    assert capsys.readouterr().out == "\033[42mx 1\033[0m"
    assert terminal_color.ansi("boldon") == "\033[1m"
    with pytest.raises(KeyError):
        terminal_color.format_color("@{pinkf}")


def test_color_marks_are_removed_if_disabled():
    terminal_color.disable_ansi_color_substitution_globally()
    assert terminal_color.format_color("@{redf}a@|") == "a"
    assert terminal_color.ansi("reset") == ""


def test_sanitized_text_stays_unchanged():
    text = "a@b.cc @! @/ @_ @| {redf} @{redf} @@"
    assert (
        terminal_color.remove_ansi_escape_sequences(terminal_color.format_color(terminal_color.sanitize(text))) == text
    )


def test_text_is_split_at_escape_sequences():
    text = "\033[31mred\033[0m"
    assert terminal_color.split_by_ansi_escape_sequence(text) == ["", "red", ""]
    assert terminal_color.split_by_ansi_escape_sequence(text, True) == ["", "\033[31m", "red", "\033[0m", ""]
