"""Actors that a plugin moves: targets, obstacles, headings and bounds."""

from __future__ import annotations

from itertools import pairwise
from math import atan2, hypot, pi

import pytest

from linkwright.control.odometry import get_yaw
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import box

PERIOD_NS = SECOND_NS // 100
SPEED, WEIGHT = 0.8, 1.15
HEIGHT = 1.2138


def actor(parameters: str = "", pose: str = f"0 0 {HEIGHT} 0 0 {pi / 2}", name: str = "ann", extra: str = "") -> str:
    plugin = f'<plugin name="walk of {name}" filename="libActorPlugin.so">{parameters}</plugin>'
    return f'<actor name="{name}"><pose>{pose}</pose>{plugin}{extra}</actor>'


def pose_of(server, name: str = "ann"):
    figure = next(figure for figure in server.simulation.scene.figures if figure.model.name == name)
    return figure.pose_at(server.simulation.seconds)


async def test_actor_walks_straight_to_target_ahead():
    async with running_server(actor(f"<target>3 0 {HEIGHT}</target>")) as (server, graph, log):
        server.advance(SECOND_NS)
        x, y, z = pose_of(server)[:3]
        assert (x, y, z) == pytest.approx((SPEED * WEIGHT, 0.0, HEIGHT), abs=0.01)
        await graph.settle()
        assert not log


async def test_actor_turns_on_the_spot_before_it_walks():
    async with running_server(actor(f"<target>0 -5 {HEIGHT}</target>")) as (server, _, _):
        server.advance(SECOND_NS)
        assert pose_of(server)[:2] == (0.0, 0.0)
        yaw = get_yaw(pose_of(server))
        assert yaw == pytest.approx(-pi / 2 * (1 - 0.99**100), abs=0.02)
        server.advance(4 * SECOND_NS)
        assert pose_of(server)[1] < -1.0
        assert get_yaw(pose_of(server)) == pytest.approx(-pi / 2, abs=0.01)


@pytest.mark.parametrize("is_ignored", [False, True])
async def test_actor_avoids_models(is_ignored):
    ignore = "<ignore_obstacles><model>pillar</model></ignore_obstacles>" if is_ignored else ""
    pillar = box("pillar", f"0 1 {HEIGHT} 0 0 0").replace("<link ", "<static>1</static><link ", 1)
    world = actor(f"<target>3 0 {HEIGHT}</target>{ignore}"), pillar
    async with running_server(*world) as (server, _, _):
        server.advance(PERIOD_NS)
        heading, position = get_yaw(pose_of(server)), pose_of(server)[:2]
        if is_ignored:
            assert (heading, position) == (0.0, pytest.approx((WEIGHT * SPEED / 100, 0.0)))
        else:  # 1.5 away from the model at 1 m
            error = atan2(-1.5, WEIGHT)
            assert heading == pytest.approx(error / 100, rel=0.02)
            assert position == (0.0, 0.0)


async def test_actor_stays_in_region_and_chooses_new_targets():
    async with running_server(actor(f"<target>3 0 {HEIGHT}</target>")) as (server, _, _):
        corners = [pose_of(server)[:2]]
        for _ in range(60):
            server.advance(SECOND_NS)
            x, y, _ = pose_of(server)[:3]
            assert -3.0 <= x <= 3.5
            assert -10.0 <= y <= 2.0
            corners.append((x, y))
        travelled = sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(corners))
        assert travelled > 8.0
        first = corners[-1]
        server.reset()
        assert pose_of(server)[:2] == (0.0, 0.0)
        for _ in range(60):
            server.advance(SECOND_NS)
        assert pose_of(server)[:2] == pytest.approx(first, abs=1e-6)


async def test_actors_are_bodies_of_the_scene_at_their_poses():
    skeleton = (
        actor(f"<target>3 0 {HEIGHT}</target>", extra='<link name="body"/>'),
        actor(name="bob", pose="2 1 1 0 0 0"),
    )
    async with running_server(*skeleton) as (server, _, _):
        server.advance(SECOND_NS)
        server.simulation.refresh()
        for name in ("ann", "bob"):
            links = next(f for f in server.simulation.scene.figures if f.model.name == name).links
            if links:
                position = server.simulation.link_pose(links[0].name)[:3]
                assert position == pytest.approx(pose_of(server, name)[:3], abs=1e-6)
        assert any(figure.links for figure in server.simulation.scene.figures)
