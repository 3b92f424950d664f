"""Regular expressions with a time limit: their matches, and their interruption."""

from __future__ import annotations

import pytest

from linkwright.graph.names.expressions import Expression, ExpressionError, TooCostlyError

ENDLESS = r"(a|aa)+$"


@pytest.mark.parametrize(
    ("expression", "found", "not_found"),
    [
        ("", ["", "a"], []),
        (r"^camera_(left|right)_\w+_frame$", ["camera_left_optical_frame"], ["camera_front_optical_frame"]),
        ("^(?!.*camera).*link$", ["base_link"], ["camera_link"]),
        (r"\x61\u0062\.", ["ab."], ["abc"]),
        ("[[:alpha:]]+_[0-9]{2,}", ["wheel_12"], ["wheel_1", "12_12"]),
        (r"[\w-]/", ["a/", "-/"], ["/"]),
    ],
)
def test_expressions_match_like_rviz(expression: str, found: list[str], not_found: list[str]) -> None:
    assert Expression(expression).found_in(found + not_found) == set(found)


def test_matches_requires_whole_name() -> None:
    assert Expression("/scan.*").matches("/scan_front")
    assert not Expression("/scan").matches("/scan_front")


@pytest.mark.parametrize(
    ("expression", "problem"),
    [
        ("(", "missing ) at position 1"),
        ("*a", "nothing to repeat at position 0"),
        ("[b-a]", "bad character range at position 4"),
        ("a" * 2001, "it has 2001 characters, more than 2000"),
    ],
)
def test_invalid_expression_is_reported(expression: str, problem: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        Expression(expression)
    assert str(caught.value) == problem


def test_costly_search_is_aborted() -> None:
    endless = Expression(ENDLESS)
    with pytest.raises(TooCostlyError):
        endless.found_in(["a" * 200 + "!"])
    with pytest.raises(TooCostlyError):
        endless.matches("a" * 200 + "!")
    assert endless.found_in(["1aa", "a1"]) == {"1aa"}
