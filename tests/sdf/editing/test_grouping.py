"""Groups: models inside a model, with unchanged poses in the world."""

from __future__ import annotations

import pytest

from linkwright.sdf.editing import EditError, WorldText, add_shape, change, group, ungroup
from linkwright.sdf.editing.changing import Change
from linkwright.sdf.frames import placed_links
from tests.sdf.editing.texts import BOX_MODEL, PLAIN_WORLD, world_text, world_with

OTHER_BOX = BOX_MODEL.replace("'box'", "'crate'").replace(">2 0 0.250 0 0 0<", ">4 1 0.25 0 0 1.5<")
TWO_BOXES = PLAIN_WORLD.replace(BOX_MODEL, f"{BOX_MODEL}    <!-- between -->\n{OTHER_BOX}")


def link_poses(world: WorldText) -> dict[str, tuple[float, ...]]:
    return {placed_link.name: placed_link.pose for placed_link in placed_links(world.world)}


def test_group_is_a_model_and_members_keep_poses():
    original = world_text(TWO_BOXES)
    grouped = group(original, ["crate", "box"], "pile")
    assert grouped.entities["pile"].member_names == ("box", "crate")
    assert list(grouped.entities) == ["ground_plane", "pile", "lamp"]
    assert "    <model name=\"pile\">\n      <pose>3 0.5 0.25 0 0 0</pose>\n      <model name='box'>" in grouped.text
    assert "    <!-- between -->\n" in grouped.text
    poses_before, poses_after = link_poses(original), link_poses(grouped)
    assert poses_after["pile::box::link"] == pytest.approx(poses_before["box::link"])
    assert poses_after["pile::crate::link"] == pytest.approx(poses_before["crate::link"])


def test_ungrouping_restores_text():
    original = PLAIN_WORLD.replace(BOX_MODEL, BOX_MODEL + OTHER_BOX).replace("0.250", "0.25")
    text, names = ungroup(group(world_text(original), ["box", "crate"], "pile"), "pile")
    assert names == ["box", "crate"]
    assert text.text == original


def test_nested_and_rotated_groups_keep_link_poses():
    text, _ = add_shape(group(world_text(TWO_BOXES), ["box", "crate"], "pile"), "box", (0, 0, 1, 0.1, 0.2, 0.3))
    text = change(text, [Change("pile", pose=(1, 1, 1, 0.5, 0.6, 0.7))])
    text = group(text, ["pile", "box"], "heap")
    poses_before = link_poses(text)
    text, names = ungroup(text, "heap")
    assert set(names) == {"pile", "box"}
    text, names = ungroup(text, "pile")
    assert names == ["box_2", "crate"]  # another model has the name 'box' now
    poses_after = link_poses(text)
    assert poses_after["box_2::link"] == pytest.approx(poses_before["heap::pile::box::link"], abs=1e-8)
    assert poses_after["crate::link"] == pytest.approx(poses_before["heap::pile::crate::link"], abs=1e-8)


def test_relative_poses_are_preserved():
    text = world_with(
        '<frame name="f"><pose>1 0 0 0 0 1.5</pose></frame>\n',
        '<model name="a"><pose relative_to="f">1 0 0 0 0 0</pose><link name="l"/></model>\n',
        '<model name="b" placement_frame="l"><pose relative_to="a">0 0 1 0 0 0</pose>',
        '<link name="l"><pose>0 3 0 0 0 0</pose></link></model>\n',
        '<model name="c"><pose relative_to="b::l">0 0 1 0 0 0</pose><link name="l"/></model>\n',
    )
    poses_before = link_poses(text)
    grouped = group(text, ["a", "b"], "g")
    assert '<pose relative_to="a">0 0 1 0 0 0</pose>' in grouped.text
    assert '<pose relative_to="g::b::l">0 0 1 0 0 0</pose>' in grouped.text
    poses_after = link_poses(grouped)
    for name, new_name in (("a::l", "g::a::l"), ("b::l", "g::b::l"), ("c::l", "c::l")):
        assert poses_after[new_name] == pytest.approx(poses_before[name], abs=1e-8)
    ungrouped, _ = ungroup(grouped, "g")
    for name, pose in link_poses(ungrouped).items():
        assert pose == pytest.approx(poses_before[name], abs=1e-8)


def test_included_models_can_be_grouped_and_static_group_is_static():
    text = world_text(PLAIN_WORLD.replace(BOX_MODEL, ""))
    text, wall = add_shape(text, "wall", (1, 0, 0.5, 0, 0, 0))
    grouped = group(text, ["ground_plane", wall], "floor")
    assert grouped.entities["floor"].is_static
    assert grouped.entities["floor"].member_names == ("wall", "ground_plane")
    ungrouped, names = ungroup(grouped, "floor")
    assert sorted(names) == ["ground_plane", "wall"]
    assert all(ungrouped.entities[name].is_static for name in names)


@pytest.mark.parametrize(
    ("names", "reason"),
    [
        (["box"], "at least two models"),
        (["box", "box"], "at least two models"),
        (["box", "lamp"], "'lamp' is a light"),
        (["box", "ground_plane"], "'ground_plane' is static and 'box' is not"),
        (["box", "none"], "there is no model or light 'none' in the world's file"),
    ],
)
def test_invalid_group_is_rejected(names, reason):
    with pytest.raises(EditError, match=reason):
        group(world_text(TWO_BOXES), names, "g")


def test_ungrouping_other_models_is_rejected():
    with pytest.raises(EditError, match="'box' cannot be ungrouped: it contains more than models"):
        ungroup(world_text(PLAIN_WORLD), "box")
    with pytest.raises(EditError, match="'ground_plane' is not a group"):
        ungroup(world_text(PLAIN_WORLD), "ground_plane")
    grouped = group(world_text(TWO_BOXES), ["box", "crate"], "g").text
    with_frame = grouped.replace("    <light", '    <frame name="f" attached_to="g"/>\n    <light')
    with pytest.raises(EditError, match="another element refers to it"):
        ungroup(world_text(with_frame), "g")
