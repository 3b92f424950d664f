"""Actors and roads: they are visible, and only actors with a plugin collide."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from linkwright.simulation.ray_casting import GROUP_COUNT, cast_rays
from linkwright.simulation.scene.bodies import VISUAL_GROUP
from linkwright.simulation.scene.figures import read_skeleton_origin
from linkwright.simulation.server.unsimulated import find_unsimulated_elements
from tests.simulation.worlds import GROUND, box, make_simulation

BALL = "<geometry><sphere><radius>0.5</radius></sphere></geometry>"
LINK = f'<link name="head"><pose>0 0 1 0 0 0</pose><visual name="v">{BALL}</visual></link>'
PATH = (
    "<script><loop>true</loop><trajectory id='0' type='walk'>"
    "<waypoint><time>0</time><pose>2 0 0 0 0 0</pose></waypoint>"
    "<waypoint><time>2</time><pose>6 0 0 0 0 0</pose></waypoint></trajectory></script>"
)
ACTOR = f'<actor name="walker"><pose>0 1 0 0 0 0</pose>{LINK}{PATH}</actor>'
GZ = '<plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>'
SECOND_NS = 1_000_000_000


def test_actor_follows_trajectory_in_simulated_time():
    simulation = make_simulation(GROUND, ACTOR)
    assert simulation.link_pose("walker::head")[:3] == pytest.approx((2, 0, 1))
    simulation.advance(SECOND_NS)
    assert simulation.link_pose("walker::head")[:3] == pytest.approx((4, 0, 1))
    simulation.advance(2 * SECOND_NS)
    assert simulation.link_pose("walker::head")[:3] == pytest.approx((4, 0, 1))
    simulation.reset()
    assert simulation.link_pose("walker::head")[:3] == pytest.approx((2, 0, 1))


def test_actor_trajectory_is_relative_to_actor_in_gz_worlds():
    simulation = make_simulation(GROUND, GZ, ACTOR)
    assert simulation.link_pose("walker::head")[:3] == pytest.approx((2, 1, 1))


def test_actor_without_trajectory_keeps_its_pose():
    simulation = make_simulation(GROUND, f'<actor name="walker"><pose>0 1 0 0 0 0</pose>{LINK}<script/></actor>')
    simulation.advance(SECOND_NS // 100)
    assert simulation.link_pose("walker::head")[:3] == pytest.approx((0, 1, 1))


def test_actor_does_not_collide():
    simulation = make_simulation(GROUND, box("crate", pose="4 0 0.5 0 0 0"), ACTOR)
    simulation.advance(2 * SECOND_NS)
    assert simulation.link_pose("crate::link")[:2] == pytest.approx((4, 0), abs=1e-4)


SKIN = "<skin><filename>walk.dae</filename></skin>"
COLLISIONS = '<plugin name="collisions" filename="libActorCollisionsPlugin.so"/>'


@pytest.mark.parametrize("parts", [LINK.replace("<visual", f'<collision name="c">{BALL}</collision><visual'), SKIN])
def test_actor_with_collisions_pushes_what_is_in_its_way(parts):
    walker, positions = ACTOR.replace(LINK, parts), []
    for plugin in ("", COLLISIONS):
        text = walker.replace("<script>", f"{plugin}<script>")
        crate = box("crate", pose="4 0 0.8 0 0 0", size="0.8 0.8 1.6")
        simulation = make_simulation(GROUND, crate, text)
        assert not [name for name in find_unsimulated_elements(simulation.world) if "plugin" in name]
        simulation.advance(SECOND_NS * 17 // 10)
        positions.append(simulation.link_pose("crate::link")[0])
    assert positions[0] == pytest.approx(4.0, abs=1e-3)
    assert positions[1] > 5.0


def test_rays_against_visuals_hit_actor():
    simulation = make_simulation(GROUND, ACTOR)
    simulation.advance(SECOND_NS)
    simulation.refresh()
    groups = np.zeros(GROUP_COUNT, dtype=np.uint8)
    groups[VISUAL_GROUP] = 1
    origin, ray = np.array([0.0, 0.0, 1.0]), np.array([[1.0, 0.0, 0.0]])
    distances, _ = cast_rays(
        simulation.model, simulation.data, origin, ray, groups, excluded_body=-1, max_distance=10.0
    )
    assert distances[0] == pytest.approx(3.5)


def test_figures_with_duplicate_names_are_renamed():
    road = '<road name="ground"><point>0 0 0</point><point>1 0 0</point></road>'
    simulation = make_simulation(GROUND, ACTOR, road, road)
    assert [figure.model.name for figure in simulation.scene.figures] == ["walker", "ground~", "ground~~"]


def test_road_is_strip_without_collision():
    road = '<road name="r"><width>2</width><point>0 0 0.02</point><point>4 0 0.02</point><point>4 3 0.02</point></road>'
    simulation = make_simulation(GROUND, road)
    body = simulation.model.body("r::link")
    assert body.geomnum == 3  # two straight parts, and the bend between them
    first = simulation.model.geom("r::link::part0#visual")
    assert first.size.tolist() == pytest.approx([2, 1, 0.005])
    assert first.pos.tolist() == pytest.approx([2, 0, 0.015])
    assert not first.contype[0]


DAE = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit meter="0.1"/><up_axis>Z_UP</up_axis></asset>
  <library_controllers><controller id="c"><skin source="#mesh">
    <source id="names"><Name_array id="n" count="1">Hips</Name_array></source>
    <source id="binds"><float_array id="b" count="16">{matrix}</float_array></source>
    <joints><input semantic="JOINT" source="#names"/><input semantic="INV_BIND_MATRIX" source="#binds"/></joints>
  </skin></controller></library_controllers>
</COLLADA>
"""


@pytest.mark.parametrize(
    ("matrix", "begins"),
    [
        ("1 0 0 -1 0 1 0 -2 0 0 1 -9 0 0 0 1", (0.1, 0.2, 0.9)),
        ("0 " * 16, (0, 0, 0)),
        ("1 2 3", (0, 0, 0)),
        ("nan " * 16, (0, 0, 0)),
        ("x " * 16, (0, 0, 0)),
    ],
)
def test_skin_is_placed_at_skeleton_origin(tmp_path: Path, matrix, begins):
    file = tmp_path / "walk.dae"
    file.write_text(DAE.format(matrix=matrix))
    assert read_skeleton_origin(file) == pytest.approx(begins)


def test_missing_skin_is_replaced_by_plain_figure():
    skin = "<skin><filename>walk.dae</filename></skin>"
    simulation = make_simulation(
        GROUND, ACTOR.replace(LINK, skin).replace("0 0 0 0 0 0</pose></w", "0 1 0 0 0 0</pose></w")
    )
    assert [diagnostic.code for diagnostic in simulation.scene.diagnostics] == ["SIM112"]
    (figure,) = simulation.scene.figures
    assert simulation.model.body(figure.links[0].name).geomnum == len(figure.model.links[0].visuals) > 1


def test_unsimulated_elements_are_reported_once():
    projectors = (
        '<model name="m"><static>true</static><link name="l"><projector name="p"/><projector name="q"/></link></model>'
    )
    walker = ACTOR.replace("<script>", '<animation name="walk"/><plugin name="p" filename="libwalk.so"/><script>')
    element_names = find_unsimulated_elements(make_simulation(GROUND, projectors, walker).world)
    assert element_names == ["<animation> in <actor>", "<projector>", "libwalk.so in <actor>"]
