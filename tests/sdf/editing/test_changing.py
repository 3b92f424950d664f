"""Changing entities of a world: only the requested values change."""

from __future__ import annotations

import difflib
from math import cos, pi, sin

import pytest

from linkwright.geometry.single import rotate
from linkwright.sdf.editing import Change, EditError, change, copy, delete
from tests.sdf.editing.texts import BOX_MODEL, PLAIN_WORLD, world_text, world_with


def changed_lines(old: str, new: str) -> list[str]:
    """Return the removed and the added lines, without surrounding spaces."""
    lines = difflib.ndiff(old.splitlines(), new.splitlines())
    return [f"{line[0]} {line[1:].strip()}" for line in lines if line[0] in "+-"]


def lines_changed_by(text: str, *changes: Change) -> list[str]:
    original = world_text(text)
    return changed_lines(original.text, change(original, changes).text)


def test_world_entities_are_listed():
    entities = world_text(PLAIN_WORLD).entities
    assert list(entities) == ["ground_plane", "box", "lamp"]
    assert [entity.kind for entity in entities.values()] == ["model", "model", "light"]
    assert entities["ground_plane"].is_static
    assert entities["box"].shape.kind == "box"
    assert entities["box"].shape.size == (0.5, 0.5, 0.5)
    assert entities["box"].shape.color == (0.9, 0.4, 0.1, 1.0)
    assert entities["lamp"].world_pose[:3] == (0, 0, 3)


def test_pose_change_replaces_only_changed_numbers():
    assert lines_changed_by(PLAIN_WORLD, Change("box", pose=(2.0, 1.5, 0.25, 0, 0, pi / 2))) == [
        "- <pose>2 0 0.250 0 0 0</pose>",
        "+ <pose>2 1.5 0.250 0 0 1.570796327</pose>",
    ]


def test_missing_pose_is_inserted():
    assert lines_changed_by(PLAIN_WORLD, Change("ground_plane", pose=(0, 0, -1, 0, 0, 0))) == [
        "- <include><uri>model://ground_plane</uri></include>",
        "+ <include><uri>model://ground_plane</uri><pose>0 0 -1 0 0 0</pose></include>",
    ]
    text = world_with('    <model name="m">\n      <link name="l"/>\n    </model>\n')
    moved = change(text, [Change("m", pose=(1, 0, 0, 0, 0, 0))])
    assert '<model name="m">\n      <pose>1 0 0 0 0 0</pose>\n      <link name="l"/>\n' in moved.text


@pytest.mark.parametrize(
    ("written", "result"),
    [
        ('<pose degrees="true">1 2 3 0 0 90</pose>', '<pose degrees="true">4 2 3 0 0 45</pose>'),
        ('<pose relative_to="">1 2 3\n 0 0 0</pose>', '<pose relative_to="">4 2 3\n 0 0 0.785398163</pose>'),
        ("<pose><!-- x -->1 2 3 0 0 0</pose>", "<pose><!-- x -->4 2 3 0 0 0.785398163</pose>"),
        ("<pose><![CDATA[1 2 3 0 0 0]]></pose>", "<pose>4 2 3 0 0 0.785398163</pose>"),
        ("<pose/>", "<pose>4 2 3 0 0 0.785398163</pose>"),
        (
            "<pose rotation_format='quat_xyzw'>1 2 3 0 0 0 -1</pose>",
            "<pose rotation_format='quat_xyzw'>4 2 3 0 0 -0.382683432 -0.923879533</pose>",
        ),
    ],
)
def test_pose_notation_is_kept(written, result):
    text = world_with(f'<model name="m">{written}<link name="l"/></model>')
    moved = change(text, [Change("m", pose=(4, 2, 3, 0, 0, pi / 4))])
    assert result in moved.text
    place = moved.entities["m"].world_pose
    assert (*place[:3], *rotate(place[3:], (1, 0, 0))) == pytest.approx((4, 2, 3, cos(pi / 4), sin(pi / 4), 0))


def test_world_pose_is_converted_to_pose_frame():
    text = world_with(
        '<frame name="f"><pose>1 0 0 0 0 1.5707963267948966</pose></frame>',
        '<model name="m"><pose relative_to="f">1 0 0 0 0 0</pose><link name="l"/></model>',
        '<model name="n" placement_frame="tip"><pose relative_to="m">0 0 1 0 0 0</pose><link name="l"/>',
        '<link name="tip"><pose>0 0 5 0.5 0 0</pose></link></model>',
        '<light name="lamp" type="spot"><pose relative_to="m">0 0 2 0 0 0</pose></light>',
    )
    expected = {
        "n": (7, 8, 9, 0.1, pi / 2, 0.3),
        "m": (1, 2, 3, 0.1, 0.2, 0.3),
        "lamp": (4, 5, 6, 0, 0, 1),
    }
    moved = change(text, [Change(name, pose=pose) for name, pose in expected.items()])
    for name, pose in expected.items():
        assert moved.entities[name].world_pose[:3] == pytest.approx(pose[:3], abs=1e-8)
    assert moved.text.count("relative_to") == 3
    changed_again = change(moved, [Change(name, pose=pose) for name, pose in expected.items()])
    for name, entity in changed_again.entities.items():
        assert entity.world_pose == pytest.approx(moved.entities[name].world_pose, abs=1e-8)


def test_unknown_pose_frame_is_reported():
    text = world_with('<model name="m"><pose relative_to="none">1 0 0 0 0 0</pose><link name="l"/></model>')
    with pytest.raises(EditError, match="'m' is relative to 'none', which cannot be placed"):
        change(text, [Change("m", pose=(0, 0, 0, 0, 0, 0))])


def test_resizing_changes_collision_visual_and_inertia():
    assert [line for line in lines_changed_by(PLAIN_WORLD, Change("box", size=(0.5, 0.5, 1.0))) if line[0] == "+"] == [
        "+ <mass>4</mass>",
        "+ <inertia><ixx>0.416667</ixx><iyy>0.416667</iyy><izz>0.166667</izz></inertia>",
        *["+ <geometry><box><size>0.5 0.5 1</size></box></geometry>"] * 2,
    ]


@pytest.mark.parametrize("size", [(1, 1), (1, 1, 0), (1, 1, -1), (1, 1, float("nan")), ()])
def test_invalid_size_is_rejected(size):
    with pytest.raises(EditError, match="is not a valid size for a box"):
        change(world_text(PLAIN_WORLD), [Change("box", size=size)])


def test_included_model_has_no_size_or_color():
    with pytest.raises(EditError, match="'ground_plane' cannot be resized"):
        change(world_text(PLAIN_WORLD), [Change("ground_plane", size=(1, 1, 1))])
    with pytest.raises(EditError, match="the color of 'ground_plane' cannot be changed"):
        change(world_text(PLAIN_WORLD), [Change("ground_plane", color=(1, 1, 1, 1))])


def test_color_replaces_material_script():
    text = PLAIN_WORLD.replace(
        "<material><ambient>0.9 0.4 0.1 1</ambient><diffuse>0.9 0.4 0.1 1</diffuse></material>",
        "<material><script><uri>file://media/gazebo.material</uri><name>Gazebo/Red</name></script></material>",
    )
    assert world_text(text).entities["box"].shape.color == (1, 0, 0, 1)
    recolored = change(world_text(text), [Change("box", color=(0, 1, 0, 0.5))])
    assert "<material><ambient>0 1 0 0.5</ambient><diffuse>0 1 0 0.5</diffuse></material>" in recolored.text
    assert recolored.entities["box"].shape.color == (0, 1, 0, 0.5)
    assert lines_changed_by(PLAIN_WORLD, Change("lamp", color=(1, 0, 0, 1)))[-1] == "+ <diffuse>1 0 0 1</diffuse>"


def test_static_flag_is_set_and_cleared():
    static_text = change(world_text(PLAIN_WORLD), [Change("box", static=True), Change("ground_plane", static=False)])
    assert static_text.entities["box"].is_static
    assert not static_text.entities["ground_plane"].is_static
    assert "<pose>2 0 0.250 0 0 0</pose>\n      <static>true</static>\n" in static_text.text
    plain_model = PLAIN_WORLD.replace(
        PLAIN_WORLD[PLAIN_WORLD.index("        <inertial>") : PLAIN_WORLD.index("        <collision")], ""
    )
    static_text = change(world_text(plain_model), [Change("box", static=True)])
    moves = change(static_text, [Change("box", static=False, size=(1.0, 1.0, 1.0))])
    assert "<static>false</static>" in moves.text
    assert moves.world.models[0].links[0].inertial.inertia.ixx == pytest.approx(1 / 6, abs=1e-6)
    with pytest.raises(EditError, match="'lamp' is a light"):
        change(world_text(PLAIN_WORLD), [Change("lamp", static=True)])


def test_renaming_updates_references():
    text = world_with(
        '<model name="a"><link name="l"/></model><model name="ab"><link name="l"/></model>',
        '<model name="b"><pose relative_to="a::l">0 0 1 0 0 0</pose><link name="l"/></model>',
        "<frame name='f' attached_to='a'><pose relative_to='ab'>0 0 0 0 0 0</pose></frame>",
        '<joint name="j" type="revolute"><parent>a::l</parent><child> b </child>',
        '<axis><xyz expressed_in="a">0 0 1</xyz></axis></joint>',
    )
    renamed = change(text, [Change("a", new_name='c "1"')])
    lines = changed_lines(text.text.replace("><", ">\n<"), renamed.text.replace("><", ">\n<"))
    assert [line for line in lines if line[0] == "+"] == [
        '+ <model name="c &quot;1&quot;">',
        '+ <pose relative_to="c &quot;1&quot;::l">0 0 1 0 0 0</pose>',
        "+ <frame name='f' attached_to='c \"1\"'>",
        "+ <parent>c &quot;1&quot;::l</parent>",
        '+ <xyz expressed_in="c &quot;1&quot;">0 0 1</xyz>',
    ]
    assert change(renamed, [Change('c "1"', new_name="a")]).text == text.text


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("lamp", "an entity named 'lamp' already exists"),
        (" ", "a name cannot be empty"),
        ("a::b", "SDF reserves it"),
        ("world", "SDF reserves it"),
        ("__x__", "SDF reserves it"),
    ],
)
def test_invalid_names_are_rejected(name, reason):
    with pytest.raises(EditError, match=reason):
        change(world_text(PLAIN_WORLD), [Change("box", new_name=name)])


def test_include_is_renamed_without_other_changes():
    renamed = change(world_text(PLAIN_WORLD), [Change("ground_plane", new_name="floor", static=True)])
    assert "<include><uri>model://ground_plane</uri><name>floor</name></include>" in renamed.text
    assert list(renamed.entities) == ["floor", "box", "lamp"]


def test_copies_get_unique_names_and_offset():
    text, names = copy(world_text(PLAIN_WORLD), ["box", "lamp", "ground_plane"], (1, 0, 0))
    assert names == ["box_2", "lamp_2", "ground_plane_2"]
    assert text.entities["box_2"].world_pose == pytest.approx((3, 0, 0.25, 0, 0, 0, 1))
    assert text.entities["lamp_2"].world_pose[:3] == (1, 0, 3)
    assert BOX_MODEL.replace("'box'", "'box_2'").replace(">2 0 0.250", ">3 0 0.250") in text.text
    with_copies, names = copy(text, ["box_2", "box"], (0, 1, 0))
    assert names == ["box_3", "box_4"]
    assert delete(with_copies, ["box_2", "box_3", "box_4", "lamp_2", "ground_plane_2"]).text == PLAIN_WORLD


def test_deleting_removes_only_lines_of_entity():
    assert delete(world_text(PLAIN_WORLD), ["box"]).text == PLAIN_WORLD.replace(BOX_MODEL, "")
    with pytest.raises(EditError, match="there is no model or light 'crate' in the world's file"):
        delete(world_text(PLAIN_WORLD), ["crate"])


def test_referenced_entity_is_deleted_only_with_its_references():
    text = world_with(
        '<model name="a"><link name="l"/></model>',
        '<model name="b"><pose relative_to="a">0 0 1 0 0 0</pose><link name="l"/></model>',
    )
    with pytest.raises(EditError, match="'a' cannot be deleted: 'b' refers to it"):
        delete(text, ["a"])
    assert not delete(text, ["b", "a"]).entities


def test_line_endings_are_preserved():
    text = world_text(PLAIN_WORLD.replace("\n", "\r\n"))
    edited, _ = copy(change(text, [Change("lamp", color=(1, 1, 1, 1)), Change("box", static=True)]), ["box"], (1, 0, 0))
    assert "\n" not in edited.text.replace("\r\n", "")


def test_xml_with_entities_can_be_edited():
    text = (
        "<?xml version='1.0'?><!DOCTYPE sdf [<!ENTITY size '1 1 1'>]>\n<sdf version='1.6'><world name='w'>"
        "<model name='m'><link name='l'><collision name='c'><geometry><box><size>&size;</size></box></geometry>"
        "</collision></link></model></world></sdf>"
    )
    edited = change(world_text(text), [Change("m", size=(2.0, 2.0, 2.0), pose=(1, 0, 0, 0, 0, 0))])
    assert "<size>2 2 2</size>" in edited.text
    assert "<model name='m'><pose>1 0 0 0 0 0</pose><link" in edited.text
    entity = text.replace("'1 1 1'", "'<box/>'").replace("<size>&size;</size>", "<size>1 1 1</size>&size;")
    assert change(world_text(entity), [Change("m", static=True)]).entities["m"].is_static


def test_element_from_xml_entity_is_rejected():
    text = (
        "<?xml version='1.0'?><!DOCTYPE sdf [<!ENTITY m \"<model name='m'><link name='l'/></model>\">]>\n"
        "<sdf version='1.6'><world name='w'>&m;</world></sdf>"
    )
    with pytest.raises(EditError, match="cannot be edited because it comes from an XML entity"):
        change(world_text(text), [Change("m", static=True)])
    with pytest.raises(EditError, match="cannot be edited because it comes from an XML entity"):
        delete(world_text(text), ["m"])


def test_file_without_world_is_rejected():
    with pytest.raises(EditError, match="there is no world in"):
        world_text("<sdf version='1.6'><model name='m'><link name='l'/></model></sdf>")
