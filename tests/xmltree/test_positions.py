"""Positions inside a start tag."""

from __future__ import annotations

import pytest

from linkwright.xmltree.positions import attribute_name_range, attribute_value_range, find_raw_offset

TAG = """<joint\n\tname = "a b"\n  type='fixed' note="type='x' &lt;1&gt;\r\n2"/>"""


@pytest.mark.parametrize(("name", "value"), [("name", "a b"), ("type", "fixed"), ("note", "type='x' &lt;1&gt;\r\n2")])
def test_attribute_name_and_value_ranges_are_found(name: str, value: str) -> None:
    text = f"<robot>é{TAG}</robot>"
    span = attribute_value_range(text, 8, name)
    assert span is not None
    assert text[slice(*span)] == value
    span = attribute_name_range(text, 8, name)
    assert span is not None
    assert text[slice(*span)] == name


@pytest.mark.parametrize("name", ["absent", "joint", "x", "1"])
def test_absent_attribute_has_no_range(name: str) -> None:
    assert attribute_value_range(TAG, 0, name) is None
    assert attribute_name_range(TAG, 0, name) is None


def test_raw_offsets_account_for_entities() -> None:
    start, end = attribute_value_range(TAG, 0, "note") or (0, 0)
    value = "type='x' <1> 2"
    assert [TAG[find_raw_offset(TAG, start, end, value.index(sign))] for sign in "x<1>2"] == ["x", "&", "1", "&", "2"]
    assert find_raw_offset(TAG, start, end, 100) == end
