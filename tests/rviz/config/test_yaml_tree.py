"""YAML documents that keep their layout when they are edited."""

from __future__ import annotations

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.diagnostics import LinkwrightError
from linkwright.rviz.config import yaml_tree

PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=12,
)


@settings(deadline=None)  # a busy machine is slow
@given(st.dictionaries(st.text(min_size=1, max_size=8), PLAIN, min_size=1, max_size=5))
def test_unchanged_documents_are_written_back_with_equal_data(data):
    text = yaml.safe_dump(data, allow_unicode=True)
    assert yaml.safe_load(yaml_tree.write(yaml_tree.parse(text, "x"))) == yaml.safe_load(text)


def test_spelling_and_order_survive():
    text = 'b: "quoted"\na: 0x10\nstate: 000000ff00000000\nzeros: 0000012\nempty: {}\n'
    assert yaml_tree.write(yaml_tree.parse(text, "x")) == text


@pytest.mark.parametrize(
    "text",
    [
        "Displays:\n  - Class: a\n    Tree:\n      {}\n    List:\n      - x\nSaved: ~\n",
        "Displays:\n  - Class: a\n    Tree: {}\n",
        "Displays:\n- Class: a\n  Tree: {}\n",
        "a: {b: 1, c: [2, 3]}\n",
    ],
)
def test_layout_of_source_is_kept(text):
    assert yaml_tree.write(yaml_tree.parse(text, "x")) == text


def test_only_first_document_is_read():
    assert yaml_tree.parse("a: 1\n---\nb: 2\n", "x").keys() == ["a"]


def test_alias_is_a_copy_of_its_anchor():
    section = yaml_tree.parse("a: &x {b: 1}\nc: *x\nd: *x\n", "x")
    section.put(("c", "b"), "2")
    assert yaml.safe_load(yaml_tree.write(section)) == {"a": {"b": 1}, "c": {"b": 2}, "d": {"b": 1}}


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("a: &x [*x]\n", "refers to itself"),
        (
            "a: &a ["
            + "x," * 99
            + "]\n"
            + "".join(f"{c}: &{c} [{f'*{p},' * 99}]\n" for p, c in zip("abc", "bcd", strict=True)),
            "more than",
        ),
    ],
)
def test_alias_bombs_and_loops_are_rejected(text, word, monkeypatch):
    monkeypatch.setattr(yaml_tree, "MAX_NODES", 50_000)  # low, because so many nodes are created
    with pytest.raises(LinkwrightError) as caught:
        yaml_tree.parse(text, "x")
    assert (caught.value.diagnostics[0].code, word in caught.value.diagnostics[0].message) == ("RVIZ102", True)


def test_new_key_is_inserted_alphabetically_if_others_are_sorted():
    ordered = yaml_tree.parse("Alpha: 1\nName: x\n", "x")
    ordered.put(("Class",), "y", string=True)
    assert ordered.keys() == ["Alpha", "Class", "Name"]
    mixed = yaml_tree.parse("Name: x\nAlpha: 1\n", "x")
    mixed.put(("Class",), "y", string=True)
    assert mixed.keys() == ["Name", "Alpha", "Class"]


def test_path_to_mapping_means_its_value_key():
    section = yaml_tree.parse("Line Style:\n  Line Width: 0.5\n  Value: Lines\n", "x")
    assert section.scalar("Line Style").text == "Lines"
    assert section.scalar("Line Style", "Line Width").text == "0.5"
    assert section.scalar("Line Style", "Value", "deeper") is None


def test_null_and_missing_scalars_are_none():
    section = yaml_tree.parse("a: ~\nb:\nc: {d: 1}\n", "x")
    assert section.scalar("a") is section.scalar("b") is section.scalar("c") is section.scalar("z") is None


def test_scalars_have_source_spans():
    scalar = yaml_tree.parse("a:\n  b: word\n", "f.rviz").scalar("a", "b")
    assert (str(scalar.span), scalar.span.end_column) == ("f.rviz:2:6", 10)


def test_put_replaces_values_and_creates_missing_keys():
    section = yaml_tree.parse("Topic: /old\nLinks:\n  {}\nname: x\n", "x")
    section.put(("name",), "12", string=True)
    section.put(("Topic", "Depth"), "5")
    section.put(("Links", "base", "Alpha"), "0.5")
    section.put(("Style",), "Lines", string=True, nested=True)
    assert yaml.safe_load(yaml_tree.write(section)) == {
        "Topic": {"Value": "/old", "Depth": 5},
        "Links": {"base": {"Alpha": 0.5}},
        "name": "12",
        "Style": {"Value": "Lines"},
    }


@pytest.mark.parametrize(
    ("text", "code", "line", "word"),
    [
        ("a: b: c\n", "RVIZ102", 1, "not valid YAML"),
        ("a: 1\nb: [1\n", "RVIZ102", 3, "not valid YAML"),
        ("a: *gone\n", "RVIZ102", 1, "undefined alias"),
        ("- a\n", "RVIZ103", 1, "is not a mapping"),
        ("", "RVIZ103", 1, "is empty"),
    ],
)
def test_document_that_is_not_a_mapping_is_rejected_with_line(text, code, line, word):
    with pytest.raises(LinkwrightError) as caught:
        yaml_tree.parse(text, "x.rviz")
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == code
    assert diagnostic.span.line == line
    assert word in diagnostic.message


def test_tab_indentation_error_has_hint():
    with pytest.raises(LinkwrightError) as caught:
        yaml_tree.parse("a:\n\tb: 1\n", "x")
    assert "tabs" in caught.value.diagnostics[0].hint


@pytest.mark.parametrize(
    "text", ["[" * 100_000, "{a: " * 5000, "- " * 3000, "\n".join(" " * n + "a:" for n in range(400))]
)
def test_deep_nesting_is_rejected(text):
    with pytest.raises(LinkwrightError) as caught:
        yaml_tree.parse(text, "x")
    assert caught.value.diagnostics[0].code == "RVIZ102"


def test_python_object_tags_are_kept_as_text():
    text = "a: !!python/object/apply:os.system [exit 1]\n"
    assert "python/object/apply:os.system" in yaml_tree.write(yaml_tree.parse(text, "x"))
