"""Ball shooters: the speed of the ball against the impulse of a step, and the number of shots."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.messages import get_message
from tests.simulation.fluids.server import weightless_server
from tests.simulation.test_plugins import SECOND_NS
from tests.simulation.worlds import box

BALL_MASS, FORCE, STEP_S = 0.5, 250.0, 0.01
SPEED = FORCE / BALL_MASS * STEP_S


def shooter(parameters: str = "", link: str = "link") -> str:
    return (
        '<model name="boat"><pose>0 0 0 0 0 1.5707963</pose><link name="launcher"><inertial><mass>1e6</mass></inertial>'
        '</link><plugin name="vrx::BallShooterPlugin" filename="libBallShooterPlugin.so"><projectile>'
        f"<model_name>ball</model_name><link_name>{link}</link_name><frame>boat::launcher</frame>"
        f"<pose>0.5 0 1 0 0 0</pose></projectile><topic>/fire</topic>{parameters}</plugin></model>"
    )


BALL = box("ball", "5 5 0 0 0 3", "0.1 0.1 0.1", BALL_MASS)


async def fire(graph) -> None:
    node = graph.create_node("gunner")
    node.create_publisher("std_msgs/msg/Bool", "/fire", 10).publish(get_message("std_msgs/msg/Bool")(data=True))
    await graph.settle()
    node.destroy_node()


async def test_ball_leaves_the_launcher_along_its_x_axis():
    async with weightless_server(shooter(), BALL, step=STEP_S) as (server, graph, log):
        await fire(graph)
        server.advance(SECOND_NS // 10)
        linear, _ = server.simulation.link_velocity("ball::link")
        assert linear == pytest.approx((0.0, SPEED, 0.0), rel=0.02, abs=0.02)
        position = np.array(server.simulation.model_pose("ball")[:3])
        assert position == pytest.approx((0.0, 0.5 + SPEED * 0.09, 1.0), abs=0.06)
        await fire(graph)
        server.advance(SECOND_NS // 50)
        assert server.simulation.model_pose("ball")[1] < 0.7
        assert not log, [record.text for record in log]


async def test_classic_shooter_is_fired_by_an_empty_message():
    classic = shooter().replace("libBallShooterPlugin.so", "libball_shooter_plugin.so")
    async with weightless_server(classic, BALL, step=STEP_S) as (server, graph, log):
        node = graph.create_node("gunner")
        node.create_publisher("std_msgs/msg/Empty", "/fire", 10).publish(get_message("std_msgs/msg/Empty")())
        await graph.settle()
        server.advance(SECOND_NS // 10)
        assert server.simulation.link_velocity("ball::link")[0] == pytest.approx((0.0, SPEED, 0.0), rel=0.02, abs=0.02)
        assert not log, [record.text for record in log]
        node.destroy_node()


async def test_shots_are_limited():
    async with weightless_server(shooter("<num_shots>1</num_shots><shot_force>50</shot_force>"), BALL) as (
        server,
        graph,
        _,
    ):
        await fire(graph)
        server.advance(SECOND_NS)
        first = server.simulation.model_pose("ball")[1]
        assert first == pytest.approx(0.5 + 50.0 / BALL_MASS * STEP_S, rel=0.1)
        await fire(graph)
        server.advance(SECOND_NS)
        assert server.simulation.model_pose("ball")[1] > first + 0.5


async def test_missing_projectile_is_told_of_when_it_is_shot():
    async with weightless_server(shooter(link="shell"), BALL) as (server, graph, log):
        assert not log
        await fire(graph)
        server.advance(SECOND_NS // 10)
        assert [record.text for record in log] == ["plugin 'vrx::BallShooterPlugin': there is no link 'ball::shell'"]


async def test_shooter_without_projectile_does_not_run():
    text = '<model name="m"><link name="l"/><plugin name="s" filename="libBallShooterPlugin.so"/></model>'
    async with weightless_server(text) as (_, __, log):
        assert "<projectile> needs <model_name> and <link_name>" in log[0].text
