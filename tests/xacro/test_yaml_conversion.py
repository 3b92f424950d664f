"""The fast conversion of YAML nodes to values, compared with PyYAML."""

from __future__ import annotations

from typing import Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from linkwright.xacro.expressions.yaml_conversion import NodeLoader, construct

PIECES = [
    *("a", ": ", "- ", "\n", "\n  ", "1", "0x1f", "012", "1:20", "~", "yes", "&x ", "*x", "<<: ", "[", "]", "{", "}"),
    *(", ", "1e3", "1.5", ".inf", "2001-01-01", '"q"', "'s'", "? ", "!!str ", "!!set ", "|\n", "# c", "=", "null"),
]

PLAIN_LOADER = NodeLoader.__base__
"""PyYAML's loader; if PyYAML uses libyaml, some of its errors differ from those of the parser in Python."""


def load_outcome(load: Any) -> str:
    try:
        return repr(load())
    except (yaml.YAMLError, ValueError, TypeError) as error:
        return type(error).__name__


def load_text(text: str) -> Any:
    loader = NodeLoader(text)
    try:
        node = loader.get_single_node()
        return None if node is None else construct(loader, node)
    finally:
        loader.dispose()


@given(st.lists(st.sampled_from(PIECES), max_size=14).map("".join))
def test_conversion_of_any_text_matches_pyyaml(text: str) -> None:
    assert load_outcome(lambda: load_text(text)) == load_outcome(lambda: yaml.load(text, PLAIN_LOADER))


@pytest.mark.parametrize(
    "text",
    [
        "a: {b: [1, 2.5, yes, ~, text, '1']}",
        "a: &x {b: 1}\nc: *x\nd: {<<: *x, e: 2}",
        "when: 2001-01-01",
        "",
    ],
)
def test_conversion_of_examples_matches_pyyaml(text: str) -> None:
    assert load_text(text) == yaml.safe_load(text)


def test_aliases_share_one_value() -> None:
    value = load_text("a: &x [1]\nb: *x")
    assert value["a"] is value["b"]
