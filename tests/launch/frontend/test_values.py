"""The conversion of values to types, as in ``launch.utilities.type_utils``."""

from __future__ import annotations

from typing import List, Union  # noqa: UP035 - what users write

import pytest
from launch.substitutions import TextSubstitution
from launch.utilities import type_utils

from launch import LaunchContext

TEXT = TextSubstitution(text="a")


def test_type_annotations_are_recognized() -> None:
    assert type_utils.is_typing_list(List)  # noqa: UP006
    assert type_utils.is_typing_list(List[int])  # noqa: UP006
    assert not type_utils.is_typing_list(list)
    assert type_utils.extract_type(List[bool]) == (bool, True)  # noqa: UP006
    assert type_utils.extract_type(list[str]) == (str, True)
    assert type_utils.extract_type(float) == (float, False)
    for unsupported in (bytes, List, Union[int, str]):  # noqa: UP006, UP007
        with pytest.raises(ValueError, match="Unrecognized data type"):
            type_utils.extract_type(unsupported)


def test_is_instance_of_checks_values_and_strings() -> None:
    assert type_utils.is_instance_of([1, 2], list[int])
    assert not type_utils.is_instance_of([1, 2.0], list[int])
    assert not type_utils.is_instance_of(1, float)
    assert type_utils.is_instance_of(["1", 2], list[int], can_be_str=True)
    assert not type_utils.is_instance_of([1, "2"])
    assert type_utils.is_instance_of([1, "2"], can_be_str=True)
    assert not type_utils.is_instance_of({"a": 1})


@pytest.mark.parametrize(
    ("text", "data_type", "value"),
    [
        ("asd", None, "asd"),
        ("'1'", None, "1"),
        ("1000.", None, 1000.0),
        ("on", None, True),
        ("[on, false, no]", None, [True, False, False]),
        ("'off'", str, "'off'"),
        ("1", float, 1.0),
        ("1", bool, True),
        ("[.2, .1]", list[float], [0.2, 0.1]),
    ],
)
def test_text_is_coerced_to_type(text: str, data_type: object, value: object) -> None:
    assert type_utils.coerce_to_type(text, data_type) == value


@pytest.mark.parametrize(
    ("text", "data_type"),
    [("''1''", None), ("{1}", None), ("[1, 2.0]", None), ("1000.5", int), ("Bsd", bool), ("[1, 2.0]", list[float])],
)
def test_invalid_text_is_rejected(text: str, data_type: object) -> None:
    with pytest.raises(ValueError, match=r".+"):
        type_utils.coerce_to_type(text, data_type)


def test_can_be_str_keeps_text() -> None:
    assert type_utils.get_typed_value("asd", float, can_be_str=True) == "asd"
    assert type_utils.get_typed_value("[asd, 2.0]", list[float], can_be_str=True) == ["asd", 2.0]
    assert type_utils.get_typed_value(["asd", "1000"], None, can_be_str=True) == ["asd", 1000]
    with pytest.raises(TypeError):
        type_utils.get_typed_value(["1", "2"], int)
    with pytest.raises(ValueError, match="cannot convert"):
        type_utils.coerce_list(["asd", "1000"])


def test_typed_substitution_is_normalized() -> None:
    normalize = type_utils.normalize_typed_substitution
    assert normalize(1, int) == 1
    assert normalize(TEXT, int) == [TEXT]
    assert [type(part) for part in normalize(["a", TEXT], None)] == [TextSubstitution, TextSubstitution]
    assert normalize([[TEXT], 2], list[int]) == [[TEXT], 2]
    with pytest.raises(TypeError):
        normalize(1, list[int])
    with pytest.raises(TypeError):
        normalize(["asd", 2], list[int])
    with pytest.raises(ValueError, match="Unrecognized"):
        normalize(1, bytes)


def test_normalized_substitution_is_evaluated() -> None:
    context = LaunchContext()
    perform = type_utils.perform_typed_substitution
    parts = [TextSubstitution(text=text) for text in ("100", ".", "5")]
    assert perform(context, parts, float) == 100.5
    assert perform(context, [[parts[0]], 5], list[int]) == [100, 5]
    assert perform(context, [TextSubstitution(text="[1, 2]")], None) == [1, 2]
    with pytest.raises(TypeError):
        perform(context, 1.0, int)
    with pytest.raises(ValueError, match="invalid literal"):
        perform(context, [TextSubstitution(text="1.")], int)
