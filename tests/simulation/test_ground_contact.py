"""Models that are placed into the ground: they are lifted onto it."""

from __future__ import annotations

import pytest

from linkwright.simulation.server.ground_contact import find_collision_warnings, lift_onto_ground
from tests.simulation.worlds import GROUND, box, make_simulation, model

PLATE = (
    '<model name="plate"><static>true</static><link name="link"><collision name="collision">'
    "<geometry><box><size>20 20 0.1</size></box></geometry></collision></link></model>"
)
WALL = (
    '<model name="wall"><static>true</static><link name="link"><pose>0.15 0 0.5 0 0 0</pose>'
    '<collision name="collision">'
    "<geometry><box><size>0.2 4 1</size></box></geometry></collision></link></model>"
)


def height_after_rest(*parts: str, z: float) -> float:
    """Return the height of a box of 0.2 m after it was placed and lifted."""
    simulation = make_simulation(*parts)
    simulation.spawn(model(box("crate", "0 0 0 0 0 0", "0.2 0.2 0.2")), "crate", (0.0, 0.0, z, 0.0, 0.0, 0.0, 1.0))
    lift_onto_ground(simulation, "crate")
    return simulation.model_pose("crate")[2]


@pytest.mark.parametrize(("ground", "top"), [(GROUND, 0.0), (PLATE, 0.05)])
def test_box_inside_ground_is_lifted_onto_it(ground: str, top: float) -> None:
    assert height_after_rest(ground, z=0.07) == pytest.approx(top + 0.1, abs=1e-6)


def test_box_above_ground_is_not_moved() -> None:
    assert height_after_rest(GROUND, z=0.1) == pytest.approx(0.1)
    assert height_after_rest(GROUND, z=0.5) == pytest.approx(0.5)


def test_box_inside_wall_is_not_lifted() -> None:
    assert height_after_rest(GROUND, WALL, z=0.1) == pytest.approx(0.1)


def test_lifted_box_rests_on_ground() -> None:
    simulation = make_simulation(PLATE)
    simulation.spawn(model(box("crate", "0 0 0 0 0 0", "0.2 0.2 0.2")), "crate")
    lift_onto_ground(simulation, "crate")
    simulation.advance(500_000_000)
    x, y, z, *_ = simulation.model_pose("crate")
    assert (x, y, z) == pytest.approx((0.0, 0.0, 0.15), abs=1e-3)


def test_model_without_collisions_is_reported():
    visual = '<visual name="v"><geometry><box><size>1 1 1</size></box></geometry></visual>'
    simulation = make_simulation(GROUND)
    for name, link in (("seen", visual), ("still", f"{visual}<gravity>false</gravity>")):
        simulation.spawn(model(f'<model name="{name}"><link name="link">{link}</link></model>'), name)
    simulation.spawn(model(box("crate", "0 0 2 0 0 0", "0.2 0.2 0.2")), "crate")
    assert [diagnostic.code for diagnostic in find_collision_warnings(simulation, "seen")] == ["SIM143"]
    assert find_collision_warnings(simulation, "still") == find_collision_warnings(simulation, "crate") == []
