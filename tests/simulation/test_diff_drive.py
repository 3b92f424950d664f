"""Differential drives with the plugins of Gazebo classic and of gz."""

from __future__ import annotations

import pytest

from linkwright.control.odometry import get_yaw
from linkwright.messages import get_message
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, robot, running_server
from tests.simulation.worlds import GROUND


def classic_plugin(extra: str = "", source: int = 0) -> str:
    """Return the plugin of Gazebo classic for mbot."""
    return (
        '<plugin name="diff_drive" filename="libgazebo_ros_diff_drive.so"><left_joint>left_joint</left_joint>'
        "<right_joint>right_joint</right_joint><wheel_separation>0.38</wheel_separation>"
        "<wheel_diameter>0.12</wheel_diameter><max_wheel_torque>5</max_wheel_torque>"
        f"<max_wheel_acceleration>1</max_wheel_acceleration><odometry_source>{source}</odometry_source>"
        f"<publish_odom>true</publish_odom><publish_odom_tf>true</publish_odom_tf>{extra}</plugin>"
    )


def gz_plugin(extra: str = "<max_linear_acceleration>1</max_linear_acceleration>") -> str:
    """Return the plugin of gz for mbot."""
    return (
        '<plugin name="gz::sim::systems::DiffDrive" filename="gz-sim-diff-drive-system">'
        "<left_joint>left_joint</left_joint><right_joint>right_joint</right_joint>"
        "<wheel_separation>0.38</wheel_separation><wheel_radius>0.06</wheel_radius>"
        f"<topic>cmd_vel</topic><odom_topic>odom</odom_topic><tf_topic>tf</tf_topic>{extra}</plugin>"
    )


class DrivenRobot:
    """A driven robot with its odometry."""

    def __init__(self, server, graph) -> None:
        self.server = server
        self.odometry = Recording(graph, server.node, "/odom")
        self._graph = graph
        self._publisher = graph.create_node("driver").create_publisher(
            get_message("geometry_msgs/msg/Twist"), "/cmd_vel", 10
        )

    async def drive(self, forward: float, yaw_rate: float, seconds: float) -> None:
        """Publish a velocity command, and advance the time."""
        twist = get_message("geometry_msgs/msg/Twist")()
        twist.linear.x, twist.angular.z = forward, yaw_rate
        self._publisher.publish(twist)
        await self._graph.settle()
        self.server.advance(round(seconds * SECOND_NS))
        await self._graph.settle()

    @property
    def pose(self):
        """Return the robot's pose in the world."""
        return self.server.simulation.model_pose("mbot")


@pytest.mark.parametrize("plugin", [classic_plugin(), gz_plugin()], ids=["classic", "gz"])
async def test_robot_drives_straight_with_correct_odometry(plugin):
    async with running_server(GROUND, robot(plugin)) as (server, graph, log):
        driven_robot = DrivenRobot(server, graph)
        await driven_robot.drive(0.5, 0.0, 1.5)
        start = driven_robot.pose
        await driven_robot.drive(0.5, 0.0, 2.0)
        assert driven_robot.pose[0] - start[0] == pytest.approx(1.0, abs=1e-3)
        assert driven_robot.pose[1] == pytest.approx(0.0, abs=1e-3)
        odometry = driven_robot.odometry.last
        assert odometry.pose.pose.position.x == pytest.approx(driven_robot.pose[0], abs=1e-2)
        assert odometry.twist.twist.linear.x == pytest.approx(0.5, abs=1e-2)
        assert not [record for record in log if record.level > 20]


@pytest.mark.parametrize("plugin", [classic_plugin(), gz_plugin()], ids=["classic", "gz"])
async def test_robot_turns_in_place(plugin):
    async with running_server(GROUND, robot(plugin)) as (server, graph, _):
        driven_robot = DrivenRobot(server, graph)
        await driven_robot.drive(0.0, 1.0, 1.0)
        start = get_yaw(driven_robot.pose)
        await driven_robot.drive(0.0, 1.0, 1.0)
        assert get_yaw(driven_robot.pose) - start == pytest.approx(1.0, abs=0.01)
        assert driven_robot.odometry.last.twist.twist.angular.z == pytest.approx(1.0, abs=0.02)


async def test_world_odometry_reports_true_pose_and_backward_speed():
    async with running_server(GROUND, robot(classic_plugin(source=1))) as (server, graph, _):
        driven_robot = DrivenRobot(server, graph)
        transforms = Recording(graph, server.node, "/tf")
        await driven_robot.drive(-0.3, 0.0, 2.0)
        odometry = driven_robot.odometry.last
        assert odometry.pose.pose.position.x == pytest.approx(driven_robot.pose[0], abs=1e-9)
        assert odometry.twist.twist.linear.x == pytest.approx(-0.3, abs=1e-2)
        assert (odometry.header.frame_id, odometry.child_frame_id) == ("odom", "base_footprint")
        assert odometry.pose.covariance[0] == 1e-5
        transform = transforms.last.transforms[0]
        assert transform.transform.translation.x == odometry.pose.pose.position.x
        assert (transform.header.frame_id, transform.child_frame_id) == ("odom", "base_footprint")


async def test_reset_stops_robot_at_start():
    async with running_server(GROUND, robot(classic_plugin())) as (server, graph, _):
        driven_robot = DrivenRobot(server, graph)
        await driven_robot.drive(0.5, 0.5, 1.0)
        server.reset()
        server.advance(SECOND_NS)
        await graph.settle()
        assert driven_robot.pose[:2] == pytest.approx((0.0, 0.0), abs=1e-3)
        assert driven_robot.odometry.last.pose.pose.position.x == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize(
    ("plugin", "message"),
    [
        (classic_plugin("<right_joint>front</right_joint>"), "1 left wheels, but 2 right wheels"),
        (classic_plugin().replace("0.12", "0"), "must be positive"),
        (classic_plugin().replace(">left_joint<", ">left_jiont<"), "there is no movable joint 'left_jiont'"),
    ],
)
async def test_invalid_parameters_are_reported(plugin, message):
    async with running_server(GROUND, robot(plugin)) as (server, _, log):
        assert server.plugins("mbot") == ()
        assert any(message in record.text for record in log)


async def test_wheel_transforms_are_published_if_enabled():
    plugin = classic_plugin("<publish_wheel_tf>true</publish_wheel_tf>")
    async with running_server(GROUND, robot(plugin)) as (server, graph, log):
        transforms = Recording(graph, server.node, "/tf")
        server.advance(SECOND_NS // 10)
        await graph.settle()
        last = {transform.transforms[0].child_frame_id: transform.transforms[0] for transform in transforms}
        assert sorted(last) == ["base_footprint", "left_wheel", "right_wheel"]
        assert last["left_wheel"].header.frame_id == "base_link"
        translation = last["left_wheel"].transform.translation
        assert (translation.x, translation.y, translation.z) == pytest.approx((0.0, 0.19, -0.05), abs=1e-3)
        assert not log


@pytest.mark.parametrize("plugin", [classic_plugin(source=1), gz_plugin()], ids=["classic", "gz"])
async def test_world_poses_are_computed_only_for_subscribers(plugin, monkeypatch):
    async with running_server(GROUND, robot(plugin)) as (server, graph, _):
        server.advance(SECOND_NS // 10)
        refresh_times: list[int] = []
        refresh = server.simulation.refresh
        monkeypatch.setattr(
            server.simulation, "refresh", lambda: (refresh_times.append(server.simulation.time), refresh())
        )
        server.advance(SECOND_NS // 10)
        assert not refresh_times
        recording = Recording(graph, server.node, "/odom")
        await graph.settle()
        server.advance(SECOND_NS // 10)
        await graph.settle()
        assert recording.last.header.stamp.nanosec == 300_000_000


async def test_world_with_many_drives_is_compiled_once():
    robots = (
        robot(classic_plugin(f"<ros><namespace>/{name}</namespace></ros>"), name=name) for name in ("a", "b", "c")
    )
    async with running_server(GROUND, *robots) as (server, _graph, _log):
        assert [len(server.plugins(name)) for name in ("a", "b", "c")] == [1, 1, 1]
        assert server.simulation.revision == 1
