"""The property store: values, defaults, identifiers and changes."""

from __future__ import annotations

import pytest
import yaml

from linkwright.rviz.config import yaml_tree
from linkwright.rviz.config.property_store import PropertyStore, property_id
from linkwright.rviz.config.schema import PropertySpec
from tests.work import lines_run

SCHEMA = (
    PropertySpec("Alpha", "float", 0.5, minimum=0.0, maximum=1.0),
    PropertySpec(
        "Line Style",
        "enum",
        "Lines",
        options=("Lines", "Billboards"),
        children=(PropertySpec("Line Width", "float", 0.03, when=(("Line Style",), "Billboards")),),
    ),
    PropertySpec(
        "Links",
        "group",
        children=(PropertySpec("a/b%", "bool", True, children=(PropertySpec("Alpha", "float", 1.0),)),),
    ),
    PropertySpec("Reference Frame", "frame", "map"),
)


@pytest.fixture
def section():
    return yaml_tree.parse("Alpha: 0.25\nLine Style:\n  Line Width: 0.2\n  Value: Billboards\nother: 1\n", "x")


@pytest.fixture
def reported_diagnostics():
    return []


@pytest.fixture
def store(section, reported_diagnostics):
    return PropertyStore(
        "display-1", section, lambda: SCHEMA, reported_diagnostics.append, frames=lambda: ["map", "odom"]
    )


def test_values_come_from_file_or_defaults(store):
    assert store.get("Alpha") == 0.25
    assert store.get("Line Style", "Line Width") == 0.2
    assert store.get("Links", "a/b%", "Alpha") == 1.0
    with pytest.raises(KeyError):
        store.get("Beta")


def test_property_ids_are_unique_for_any_name(store):
    identity = store.identity(("Links", "a/b%", "Alpha"))
    assert identity == "display-1/Links/a%2Fb%25/Alpha"
    assert store.find(identity) == ("Links", "a/b%", "Alpha")
    assert property_id("x", ("a/b",)) != property_id("x", ("a", "b"))


@pytest.mark.parametrize("identity", ["display-1", "display-2/Alpha", "display-1/", "display-1/Alpha/x", "", "/"])
def test_unknown_ids_are_not_found(store, identity):
    assert store.find(identity) is None


def test_only_changed_values_are_written(store, section):
    assert store.set(("Alpha",), 2) == 1.0
    store.set(("Links", "a/b%"), False)
    store.set(("Reference Frame",), "map")  # the default value is not written
    assert yaml.safe_load(yaml_tree.write(section)) == {
        "Alpha": 1.0,
        "Line Style": {"Line Width": 0.2, "Value": "Billboards"},
        "other": 1,
        "Links": {"a/b%": {"Value": False}},
    }


def test_conditional_rows_are_omitted(store):
    def widths():
        return [row.name for row in store.rows()[1].children]

    assert widths() == ["Line Width"]
    assert store.is_condition(("Line Style",))
    assert not store.is_condition(("Alpha",))
    store.set(("Line Style",), "Lines")
    assert widths() == []


def test_frame_property_offers_frames(store):
    assert store.rows()[3].options == ["map", "odom"]
    (change,) = store.frame_changes()
    assert (change.id, change.value, change.options) == ("display-1/Reference Frame", "map", ["map", "odom"])


def test_invalid_value_is_reported_once(reported_diagnostics):
    store = PropertyStore("x", yaml_tree.parse("Alpha: lots\n", "f.rviz"), lambda: SCHEMA, reported_diagnostics.append)
    assert store.get("Alpha") == store.get("Alpha") == 0.5
    (diagnostic,) = reported_diagnostics
    assert (diagnostic.code, str(diagnostic.span)) == ("RVIZ201", "f.rviz:1:8")


def test_base_section_is_created_on_first_value():
    document = yaml_tree.parse("a: 1\n", "x")
    store = PropertyStore("x", document, lambda: SCHEMA, print, base=("Manager", "Options"))
    assert store.get("Alpha") == 0.5
    assert yaml_tree.write(document) == "a: 1\n"
    store.set(("Alpha",), 0.1)
    assert yaml.safe_load(yaml_tree.write(document)) == {"a": 1, "Manager": {"Options": {"Alpha": 0.1}}}


@pytest.mark.parametrize(
    "text",
    [
        "a: 1\n",
        "a: 1\nManager:\n",
        "a: 1\nManager: ~\n",
        "a: 1\nManager: some text\n",
        "a: 1\nManager:\n  Options: ~\n  Views: 3\n",
        "a: 1\nManager:\n  Options: some text\n",
        "a: 1\nManager:\n  Options: {}\n",
    ],
)
def test_created_base_section_is_removed_by_undo(text):
    document = yaml_tree.parse(text, "x")
    store = PropertyStore("x", document, lambda: SCHEMA, print, base=("Manager", "Options"))
    with store.recording() as before:
        store.set(("Alpha",), 0.1)
    written = yaml_tree.write(document)
    for _ in range(2):
        after = store.current_entries(before)
        store.restore(before)
        assert yaml_tree.are_same(document, yaml_tree.parse(text, "x"))
        store.restore(after)
        assert (yaml_tree.write(document), store.get("Alpha")) == (written, 0.1)


@pytest.mark.parametrize(
    ("text", "value", "message"), [("off", True, 1), ("NO", True, 1), ("0", False, 0), ("yes", True, 0)]
)
def test_bool_property_parses_values_like_rviz(reported_diagnostics, text, value, message):
    spec = PropertySpec("Selectable", "bool", default=False)
    section = yaml_tree.parse(f"Selectable: {text}\n", "f.rviz")
    assert PropertyStore("x", section, lambda: (spec,), reported_diagnostics.append).get("Selectable") is value
    assert len(reported_diagnostics) == message
    if message:
        assert (
            reported_diagnostics[0].message
            == f"'Selectable': true or false is expected, not '{text}'; True is used instead"
        )


def test_reading_link_properties_is_linear_in_links():
    def work(count):
        links = tuple(PropertySpec(f"link_{number}", "bool", True) for number in range(count))
        schema = (PropertySpec("Links", "group", children=links),)
        store = PropertyStore("display-1", yaml_tree.parse("{}", "x"), lambda: schema, lambda _: None)
        return lines_run(lambda: [store.get("Links", link.name) for link in links])

    assert work(1000) < 12 * work(100)
