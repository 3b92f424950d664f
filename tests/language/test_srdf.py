"""SRDF.

The tests cover completion, hover and definition of groups, and of links and joints of the description.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tests.language.formats import Place, make_packages

LAMP = """<robot name="lamp" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="foot"/>
  <xacro:macro name="arm" params="side">
    <link name="${side}_arm"/>
    <joint name="${side}_joint" type="fixed"><parent link="foot"/><child link="${side}_arm"/></joint>
  </xacro:macro>
  <xacro:arm side="left"/><xacro:arm side="right"/>
</robot>
"""


@pytest.fixture
def position_at(tmp_path: Path):
    folder = make_packages(tmp_path)
    description = folder.parent / "lamp_nodes" / "urdf" / "lamp.urdf.xacro"
    description.parent.mkdir()
    description.write_text(LAMP)

    def place(text: str) -> Place:
        place_in_file = Place(folder / "config" / "lamp.srdf", f'<robot name="lamp">{text}</robot>')
        place_in_file.document.workspace.index.refresh()
        return place_in_file

    return place


def test_links_and_joints_are_completed_from_expanded_description(position_at):
    assert position_at('<group name="g"><chain base_link="|"/>').labels() == ["foot", "left_arm", "right_arm"]
    assert position_at('<group_state name="s" group="g"><joint name="|"/>').labels() == ["left_joint", "right_joint"]
    assert position_at('<group name="g"><joint name="left_joint"/><joint name="|"/></group>').labels() == [
        "right_joint"
    ]


def test_groups_of_file_are_completed(position_at):
    text = '<group name="a"/><group name="b"><group name="|"/></group>'
    assert position_at(text).labels() == ["a", "b"]
    assert position_at('<group name="a"/><group_state group="|"/>').labels() == ["a"]
    assert position_at('<group name="a"/><group_state group="a|"/>').targets() == ["lamp.srdf:a"]


def test_elements_and_fixed_values_are_completed(position_at):
    assert position_at("<dis|").labels() == ["disable_collisions", "disable_default_collisions"]
    assert position_at('<disable_collisions link1="a" link2="b" reason="|"/>').labels()[:2] == ["Adjacent", "Never"]


def test_link_has_hover_and_definition_in_macro(position_at):
    place = position_at('<passive_joint name="left_jo|int"/>')
    assert "fixed joint from `foot` to `left_arm`" in place.hover()
    assert place.targets() == ["lamp.urdf.xacro:${side}_joint"]
    assert position_at('<group name="g"><link name="fo|ot"/></group>').targets() == ["lamp.urdf.xacro:foot"]


def test_renamed_robot_is_matched_by_its_links(position_at):
    text = '<group name="g"><chain base_link="foot" tip_link="|"/></group>'
    place = position_at(text)
    text = place.document.text.replace('name="lamp"', 'name="other"')
    document = replace(place.document, text=text, texts={place.document.file: text})
    labels = [item.label for item in place.format.complete(document, text.index('tip_link="') + 10)]
    assert labels == ["foot", "left_arm", "right_arm"]


def test_hover_of_group_lists_its_parts(position_at):
    text = '<group name="a"><chain base_link="foot" tip_link="left_arm"/></group><group_state name="s" group="|a"/>'
    assert "- chain `foot`, `left_arm`" in position_at(text).hover()
