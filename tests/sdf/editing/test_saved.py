"""Edits of worlds from Gazebo classic take precedence over ``<state>``."""

from __future__ import annotations

import pytest

from linkwright.sdf.editing import Change, add_shape, change, copy, delete, group
from linkwright.sdf.frames import placed_links
from tests.sdf.editing.texts import world_with

SAVED = world_with(
    '    <model name="m"><pose>9 9 9 0 0 0</pose><link name="a"/><link name="b"/></model>\n',
    '    <model name="n"><link name="a"/></model>\n',
    '    <model name="old"><link name="a"/></model>\n',
    '    <light name="lamp" type="point"/>\n',
    '    <state world_name="w">\n',
    '      <model name="m">\n        <pose>1 0 0 0 -0 0</pose>\n',
    '        <link name="a"><pose>1 0 0 0 0 0</pose></link>\n',
    '        <link name="b"><pose>2 0 0 0 0 0</pose></link>\n',
    "      </model>\n",
    '      <model name="n"><pose>5 0 0 0 0 0</pose></model>\n',
    '      <light name="lamp"><pose>0 0 3 0 0 0</pose></light>\n',
    '      <insertions><model name="new"><link name="a"/></model></insertions>\n',
    "      <deletions><name>old</name></deletions>\n",
    "    </state>\n",
)


def links(world):
    return {placed_link.name: placed_link.pose for placed_link in placed_links(world.world)}


def test_entities_have_poses_of_state():
    assert list(SAVED.entities) == ["m", "n", "lamp", "new"]
    assert SAVED.entities["m"].world_pose[:3] == (1, 0, 0)
    assert SAVED.entities["lamp"].world_pose[:3] == (0, 0, 3)


def test_moving_changes_pose_in_model_and_state():
    moved = change(
        SAVED, [Change("m", pose=(1, 1, 0, 0, 0, 1.5707963267948966)), Change("lamp", pose=(0, 0, 5, 0, 0, 0))]
    )
    assert moved.entities["m"].world_pose[:3] == (1, 1, 0)
    assert moved.entities["lamp"].world_pose[:3] == (0, 0, 5)
    assert links(moved)["m::b"][:3] == pytest.approx((1, 2, 0))
    assert '<model name="m"><pose>1 1 0 0 0 1.570796327</pose>' in moved.text
    assert "<pose>1 1 0 0 -0 1.570796327</pose>\n" in moved.text
    moved_insertion = change(SAVED, [Change("new", pose=(0, 3, 0, 0, 0, 0))])
    assert moved_insertion.entities["new"].world_pose[:3] == (0, 3, 0)


def test_renaming_and_deleting_change_state():
    assert change(SAVED, [Change("m", new_name="k")]).entities["k"].world_pose[:3] == (1, 0, 0)
    deleted = delete(SAVED, ["m", "lamp", "new"])
    assert list(deleted.entities) == ["n"]
    assert deleted.state.first("model").attributes == {"name": "n"}
    assert deleted.state.first("light") is None


def test_added_entity_avoids_names_deleted_in_state():
    text = SAVED.text.replace("<name>old</name>", "<name>box</name>")
    world, name = add_shape(SAVED.with_text(text), "box", (0, 0, 1, 0, 0, 0))
    assert name == "box_2"
    assert world.entities["box_2"].world_pose[:3] == (0, 0, 1)


def test_copies_and_groups_start_at_poses_of_state():
    with_copy, names = copy(SAVED, ["n"], (0, 1, 0))
    assert with_copy.entities[names[0]].world_pose[:3] == (5, 1, 0)
    grouped = group(SAVED, ["m", "n"], "g")
    assert links(grouped)["g::n::a"][:3] == (5, 0, 0)
    assert links(grouped)["g::m::a"][:3] == (1, 0, 0)
