"""Worlds that Gazebo classic has saved."""

from __future__ import annotations

from math import pi

import pytest

from linkwright.sdf.frames import placed_links
from linkwright.sdf.saved import with_saved_state
from tests.sdf.worlds import world

MODEL = '<model name="m"><pose>9 9 9 0 0 0</pose><link name="a"/><link name="b"><pose>1 0 0 0 0 0</pose></link></model>'


def places(inside: str) -> dict[str, tuple[float, ...]]:
    return {placed_link.name: placed_link.pose[:3] for placed_link in placed_links(with_saved_state(world(inside)))}


def test_a_world_without_a_state_is_as_it_is():
    plain = world(MODEL)
    assert with_saved_state(plain) is plain


def test_the_state_says_where_models_and_links_are_in_the_world():
    found = places(
        MODEL
        + f"""<state world_name="w"><model name="m"><pose>1 0 0 0 0 {pi / 2}</pose>
        <link name="b"><pose>4 5 6 0 0 0</pose></link></model></state>"""
    )
    assert found["m::a"] == (1, 0, 0)
    assert found["m::b"] == pytest.approx((4, 5, 6))


def test_the_last_state_counts_and_a_model_without_one_stays():
    other = MODEL.replace('"m"', '"n"')
    found = places(
        f"""{MODEL}{other}<state><model name="m"><pose>1 0 0 0 0 0</pose></model></state>
        <state><model name="m"><pose>2 0 0 0 0 0</pose></model></state>"""
    )
    assert (found["m::a"], found["n::a"]) == ((2, 0, 0), (9, 9, 9))


def test_models_in_models_and_lights_have_their_state_too():
    inside = """<model name="o"><pose>1 0 0 0 0 0</pose><model name="i"><pose>1 0 0 0 0 0</pose><link name="l"/></model>
        </model><light name="sun" type="point"><pose>0 0 9 0 0 0</pose></light>
        <state><model name="o"><pose>2 0 0 0 0 0</pose><model name="i"><pose>7 0 0 0 0 0</pose></model></model>
        <light name="sun"><pose>0 0 3 0 0 0</pose></light></state>"""
    assert places(inside) == {"o::i::l": pytest.approx((7, 0, 0))}
    assert with_saved_state(world(inside)).lights[0].pose.pose.xyz == (0, 0, 3)


def test_what_was_put_in_is_there_and_what_was_taken_out_is_gone():
    inside = f"""{MODEL}<state><insertions><model name="new"><link name="l"/></model></insertions>
        <deletions><name>m</name></deletions></state>"""
    assert list(places(inside)) == ["new::l"]
