"""Worlds that Gazebo classic has saved."""

from __future__ import annotations

from math import pi

import pytest

from linkwright.sdf.frames import placed_links
from linkwright.sdf.saved import with_saved_state
from tests.sdf.worlds import make_world_text

MODEL = '<model name="m"><pose>9 9 9 0 0 0</pose><link name="a"/><link name="b"><pose>1 0 0 0 0 0</pose></link></model>'


def model_poses(elements: str) -> dict[str, tuple[float, ...]]:
    return {
        placed_link.name: placed_link.pose[:3]
        for placed_link in placed_links(with_saved_state(make_world_text(elements)))
    }


def test_world_without_state_is_unchanged():
    plain = make_world_text(MODEL)
    assert with_saved_state(plain) is plain


def test_state_sets_poses_of_models_and_links():
    positions = model_poses(
        MODEL
        + f"""<state world_name="w"><model name="m"><pose>1 0 0 0 0 {pi / 2}</pose>
        <link name="b"><pose>4 5 6 0 0 0</pose></link></model></state>"""
    )
    assert positions["m::a"] == (1, 0, 0)
    assert positions["m::b"] == pytest.approx((4, 5, 6))


def test_last_state_applies_and_other_models_keep_poses():
    second_model = MODEL.replace('"m"', '"n"')
    positions = model_poses(
        f"""{MODEL}{second_model}<state><model name="m"><pose>1 0 0 0 0 0</pose></model></state>
        <state><model name="m"><pose>2 0 0 0 0 0</pose></model></state>"""
    )
    assert (positions["m::a"], positions["n::a"]) == ((2, 0, 0), (9, 9, 9))


def test_state_applies_to_nested_models_and_lights():
    elements = """<model name="o"><pose>1 0 0 0 0 0</pose>
<model name="i"><pose>1 0 0 0 0 0</pose><link name="l"/></model>
        </model><light name="sun" type="point"><pose>0 0 9 0 0 0</pose></light>
        <state><model name="o"><pose>2 0 0 0 0 0</pose><model name="i"><pose>7 0 0 0 0 0</pose></model></model>
        <light name="sun"><pose>0 0 3 0 0 0</pose></light></state>"""
    assert model_poses(elements) == {"o::i::l": pytest.approx((7, 0, 0))}
    assert with_saved_state(make_world_text(elements)).lights[0].pose.pose.xyz == (0, 0, 3)


def test_insertions_and_deletions_of_state_apply():
    elements = f"""{MODEL}<state><insertions><model name="new"><link name="l"/></model></insertions>
        <deletions><name>m</name></deletions></state>"""
    assert list(model_poses(elements)) == ["new::l"]
