"""Launch files in YAML: completion, hover and definition."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.language.formats import Place, make_packages


@pytest.fixture
def position_at(tmp_path: Path):
    folder = make_packages(tmp_path)
    return lambda text: Place(folder / "launch" / "lamp.launch.yaml", text)


NODE = "launch:\n- node:\n    pkg: lamp_nodes\n    exec: blink\n"
INCLUDE = (
    "launch:\n- include:\n    file: $(find-pkg-share lamp_bringup)/launch/parts.launch.xml\n    arg:\n    - name: "
)


def test_keys_are_completed(position_at):
    assert position_at("|").labels() == ["launch"]
    assert position_at("launch:\n- no|").labels() == ["node", "node_container"]
    assert position_at(f"{NODE}    na|").labels() == ["name", "namespace"]
    assert position_at(f"{NODE}    pa|").labels() == ["param"]
    assert position_at(f"{NODE}    param:\n    - fr|").labels() == ["from"]
    assert position_at("launch:\n- group:\n  - inc|").labels() == ["include"]
    assert position_at("launch:\n- timer:\n    period: 1.0\n    children:\n    - inc|").labels() == ["include"]


def test_values_are_completed_by_element(position_at):
    assert position_at("launch:\n- node:\n    pkg: |").labels()[:2] == ["lamp_bringup", "lamp_nodes"]
    assert position_at('launch:\n- node:\n    pkg: "lamp_nodes"\n    exec: "|"').labels() == ["blink"]
    assert position_at(f"{NODE}    output: |").labels()[:2] == ["screen", "log"]
    assert position_at(NODE.replace("blink", "bl|ink")).targets() == ["blink.py:main"]


def test_arguments_of_file_and_includes_are_completed(position_at):
    assert position_at(f"{INCLUDE}|").labels() == ["rate", "mode"]
    assert position_at(f"{INCLUDE}rate\n      value: '3'\n    - name: |").labels() == ["mode"]
    assert position_at(f'{INCLUDE}mode\n      value: "|"').labels()[:2] == ["slow", "fast"]
    assert position_at(f"{INCLUDE}ra|te").targets() == ["parts.launch.xml:rate"]
    declared = 'launch:\n- arg:\n    name: "gui"\n    default: "true"\n    description: "Show it"\n'
    place = position_at(f'{declared}- let:\n    name: a\n    value: "$(var g|ui)"')
    assert place.labels() == ["gui"]
    assert place.hover() == "**gui** = `true`, lamp.launch.yaml\n\nShow it"


def test_paths_have_completion_links_and_hover(position_at):
    place = position_at("launch:\n- node:\n    param:\n    - from: $(find-pkg-share lamp_bringup)/config/la|mp.yaml")
    assert place.labels() == ["lamp.yaml"]
    assert place.links() == ["lamp.yaml"]
    assert "starts a node" in position_at("launch:\n- no|de:\n    pkg: a\n").hover()
    assert "package of the executable" in position_at("launch:\n- node:\n    p|kg: a\n").hover()


def test_symbols_are_actions(position_at):
    place = position_at(f"|{NODE}- group:\n  - executable:\n      cmd: ls\n")
    (launch,) = place.format.symbols(place.document)
    assert [child.name for child in launch.children] == ["node blink", "group"]


def test_remapping_completion_offers_topics_of_the_node(position_at):
    node = "launch:\n- node:\n    pkg: joy\n    exec: joy_node\n    remap:\n    - from: {}\n      to: {}"
    assert position_at(node.format("j|", "a")).labels() == ["joy"]
    assert "sensor_msgs/msg/Joy" in position_at(node.format("jo|y", "a")).hover()
