"""Joints that follow a trajectory with gz's controller."""

from __future__ import annotations

import pytest

from linkwright.messages import Duration, Time, get_message
from linkwright.testing import Recording
from tests.simulation.test_joint_controllers import arm_model
from tests.simulation.test_plugins import SECOND_NS, running_server

TOPIC = "/model/arm/joint_trajectory"
GAINS = (
    "<position_p_gain>400</position_p_gain><position_i_gain>400</position_i_gain><position_d_gain>40</position_d_gain>"
    "<position_i_min>-20</position_i_min><position_i_max>20</position_i_max>"
)


def controller_plugin(extra: str = GAINS) -> str:
    """Return the plugin."""
    name = "gz::sim::systems::JointTrajectoryController"
    return f'<plugin name="{name}" filename="gz-sim-joint-trajectory-controller-system">{extra}</plugin>'


def make_trajectory(*points: tuple[float, float], name: str = "shoulder", stamp: int = 0):
    """Return a trajectory; its points are seconds from the start and positions in rad."""
    message = get_message("trajectory_msgs/msg/JointTrajectory")(joint_names=[name])
    message.header.stamp = Time(sec=stamp, nanosec=0)
    for seconds, position in points:
        point = get_message("trajectory_msgs/msg/JointTrajectoryPoint")(positions=[position])
        point.time_from_start = Duration(sec=int(seconds), nanosec=round(seconds % 1 * SECOND_NS))
        message.points.append(point)
    return message


async def follow_trajectory(graph, server, message, seconds: float) -> None:
    """Publish a trajectory, and advance the time."""
    node = graph.create_node("planner")
    node.create_publisher("trajectory_msgs/msg/JointTrajectory", TOPIC, 10).publish(message)
    await graph.settle()
    server.advance(round(seconds * SECOND_NS))
    await graph.settle()
    node.destroy_node()


async def test_joints_hold_each_point_until_next_is_due():
    async with running_server(arm_model(controller_plugin("<initial_position>0.5</initial_position>" + GAINS))) as (
        server,
        graph,
        log,
    ):
        progress = Recording(graph, server.node, f"{TOPIC}_progress")
        server.advance(3 * SECOND_NS)
        assert server.simulation.joint_state("arm::shoulder")[0] == pytest.approx(0.5, abs=5e-3)
        await follow_trajectory(graph, server, make_trajectory((0.0, 0.2), (3.0, -0.4), (6.0, 1.0)), 2.9)
        assert [message.data for message in progress] == pytest.approx([1 / 3, 2 / 3])
        assert server.simulation.joint_state("arm::shoulder")[0] == pytest.approx(-0.4, abs=5e-3)
        server.advance(4 * SECOND_NS)
        await graph.settle()
        assert server.simulation.joint_state("arm::shoulder")[0] == pytest.approx(1.0, abs=5e-3)
        assert progress.last.data == 1.0
        server.reset()
        server.advance(3 * SECOND_NS)
        assert server.simulation.joint_state("arm::shoulder")[0] == pytest.approx(0.5, abs=5e-3)
        assert not log


async def test_header_start_time_delays_trajectory():
    settings = "<use_header_start_time>true</use_header_start_time>" + GAINS
    async with running_server(arm_model(controller_plugin(settings))) as (server, graph, _):
        progress = Recording(graph, server.node, f"{TOPIC}_progress")
        await follow_trajectory(graph, server, make_trajectory((0.0, 0.1), (1.0, 0.3), stamp=2), 2.5)
        assert [message.data for message in progress] == [0.5, 1.0]


async def test_efforts_alone_are_applied_without_gains():
    async with running_server(arm_model(controller_plugin("<joint_name>shoulder</joint_name>"))) as (
        server,
        graph,
        log,
    ):
        server.advance(3 * SECOND_NS)
        assert server.simulation.joint_state("arm::shoulder")[0] > 1.0
        message = make_trajectory((0.0, 0.0))
        message.points[0].effort = [-30.0]
        await follow_trajectory(graph, server, message, 3.0)
        assert server.simulation.joint_state("arm::shoulder")[0] == pytest.approx(-2.0, abs=0.01)
        assert not log


async def test_unknown_joint_is_reported_and_empty_trajectory_ends_current():
    async with running_server(arm_model(controller_plugin())) as (server, graph, log):
        await follow_trajectory(graph, server, make_trajectory((0.0, 1.0), name="elbow"), 0.1)
        assert [record.text for record in log] == [
            "plugin 'gz::sim::systems::JointTrajectoryController' does not control a joint named elbow"
        ]
        await follow_trajectory(graph, server, make_trajectory((3.0, 0.4), (8.0, 1.0)), 2.9)
        await follow_trajectory(graph, server, make_trajectory(), 5.0)
        assert server.simulation.joint_state("arm::shoulder")[0] == pytest.approx(0.4, abs=5e-3)
