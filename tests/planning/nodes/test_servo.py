"""servo_node on the graph: commands in, trajectories out, in the forms of Humble and Jazzy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.messages import get_message, get_service
from linkwright.nodes import NodeOptions
from linkwright.planning.nodes.servo import ServoNode
from tests.planning.arms import LIMITS, SRDF, arm, urdf
from tests.planning.nodes.bench import START, box, message

pytestmark = pytest.mark.extra("arm")

NAMES = list(arm().group.joint_names)
PARAMETERS: dict[str, Any] = {
    "robot_description": urdf(),
    "robot_description_semantic": SRDF,
    "robot_description_planning": {"joint_limits": LIMITS},
    "moveit_servo": {
        "move_group_name": "arm",
        "command_in_type": "speed_units",
        "command_out_topic": "/arm_controller/joint_trajectory",
        "joint_topic": "/joint_states",
    },
}


class ServoBench:
    """servo_node, its clients, and a robot that is at once where it is sent."""

    def __init__(self, graph: Any, clock: Any, **servo: Any) -> None:
        self.graph, self.clock = graph, clock
        settings = {**PARAMETERS["moveit_servo"], **servo}
        self.servo = ServoNode(graph, NodeOptions(parameters={**PARAMETERS, "moveit_servo": settings}))
        self.node = graph.create_node("client")
        self.positions = np.array([START.get(name, 0.0) for name in NAMES])
        self.received: list[Any] = []
        self.statuses: list[Any] = []
        self.states = self.node.create_publisher("sensor_msgs/msg/JointState", "joint_states", 10)
        kind = str(settings.get("command_out_type", "trajectory_msgs/JointTrajectory")).replace("/", "/msg/")
        self.node.create_subscription(kind, "arm_controller/joint_trajectory", self._receive, 10)
        self.twists = self.node.create_publisher("geometry_msgs/msg/TwistStamped", "servo_node/delta_twist_cmds", 10)
        self.jogs = self.node.create_publisher("control_msgs/msg/JointJog", "servo_node/delta_joint_cmds", 10)
        self.poses = self.node.create_publisher("geometry_msgs/msg/PoseStamped", "servo_node/pose_target_cmds", 10)
        status = self.servo._status_publisher.topic_name
        kind = self.graph.topics()[status][0]
        self.node.create_subscription(kind, status, self.statuses.append, 10)

    def _receive(self, command: Any) -> None:
        self.received.append(command)
        if hasattr(command, "points") and len(command.points[0].positions):
            self.positions = np.array(command.points[0].positions)

    async def publish_state(self) -> None:
        state = get_message("sensor_msgs/msg/JointState")()
        state.name, state.position = NAMES, self.positions.tolist()
        self.states.publish(state)
        await self.graph.settle()

    async def run(self, seconds: float, publisher: Any = None, command: Any = None) -> None:
        """Advance the time in steps of the period, with the command in each step."""
        for _ in range(round(seconds / 0.01)):
            await self.publish_state()
            if command is not None:
                command.header.stamp = self.node.get_clock().now().to_msg()
                publisher.publish(command)
            await self.graph.settle()
            await self.clock.advance(0.01)

    async def call(self, kind: str, name: str, **fields: Any) -> Any:
        service = get_service(kind)
        future = self.node.create_client(service, f"servo_node/{name}").call_async(service.Request(**fields))
        await self.graph.settle()
        return future.result()

    def tip(self) -> np.ndarray:
        positions = arm().positions()
        positions[arm().indexes] = self.positions
        arm().model.move(positions)
        return arm().model.link_pose("tool")


def twist(frame: str = "base", **linear: float) -> Any:
    result = message("geometry_msgs/msg/TwistStamped")
    result.header.frame_id = frame
    for axis, value in linear.items():
        setattr(result.twist.linear, axis, value)
    return result


def jog(**velocities: float) -> Any:
    return message("control_msgs/msg/JointJog", joint_names=list(velocities), velocities=list(velocities.values()))


@pytest.fixture
async def humble(graph, clock, monkeypatch):
    monkeypatch.setenv("ROS_DISTRO", "humble")
    bench = ServoBench(graph, clock)
    assert (await bench.call("std_srvs/srv/Trigger", "start_servo")).success
    yield bench
    bench.servo.close()


@pytest.fixture
async def jazzy(graph, clock, monkeypatch):
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    bench = ServoBench(graph, clock)
    yield bench
    bench.servo.close()


class TestCommands:
    async def test_twist_moves_the_tip(self, humble) -> None:
        start = humble.tip()
        await humble.run(0.5, humble.twists, twist(y=0.1))
        np.testing.assert_allclose((humble.tip() - start)[:3], (0.0, 0.05, 0.0), atol=0.004)
        command = humble.received[-1]
        assert command.joint_names == NAMES
        assert (command.header.stamp.sec, command.points[0].time_from_start.nanosec) == (0, 10_000_000)
        assert len(command.points[0].velocities) == 6

    async def test_twist_in_the_frame_of_a_link(self, humble) -> None:
        start = humble.tip()
        axis = arm().model.link_pose("tool")
        await humble.run(0.3, humble.twists, twist("tool", z=0.1))
        moved = (humble.tip() - start)[:3]
        x, y, z, w = axis[3:]
        direction = np.array((2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)))
        np.testing.assert_allclose(moved, 0.03 * direction, atol=0.004)

    async def test_twist_leaves_out_dimensions_that_are_not_controlled(self, humble) -> None:
        controlled = {f"control_{axis}_{kind}": True for axis in "xyz" for kind in ("translation", "rotation")}
        name = "change_control_dimensions"
        kind = "moveit_msgs/srv/ChangeControlDimensions"
        assert (await humble.call(kind, name, **controlled | {"control_y_translation": False})).success
        start = humble.tip()
        await humble.run(0.5, humble.twists, twist(y=0.1, z=0.1))
        np.testing.assert_allclose((humble.tip() - start)[:3], (0.0, 0.0, 0.05), atol=0.004)
        assert (await humble.call(kind, name, **controlled)).success
        start = humble.tip()
        await humble.run(0.5, humble.twists, twist(y=0.1))
        np.testing.assert_allclose((humble.tip() - start)[:3], (0.0, 0.05, 0.0), atol=0.004)

    async def test_tip_drifts_only_in_the_dimensions_that_are_named(self, humble) -> None:
        command = twist(y=0.1)
        command.twist.angular.y = 0.5
        kind, name = "moveit_msgs/srv/ChangeDriftDimensions", "change_drift_dimensions"
        assert (await humble.call(kind, name, drift_x_translation=True, drift_z_translation=True)).success
        start = humble.tip()
        await humble.run(0.3, humble.twists, command)
        moved = humble.tip() - start
        assert moved[1] == pytest.approx(0.03, abs=0.004)
        assert np.abs(moved[[0, 2]]).max() > 0.01

    async def test_jog_moves_one_joint(self, humble) -> None:
        before = humble.positions.copy()
        await humble.run(0.5, humble.jogs, jog(twist=0.4))
        np.testing.assert_allclose(humble.positions - before, (0, 0, 0, 0, 0, 0.2), atol=0.01)

    async def test_motion_stops_after_the_timeout(self, humble) -> None:
        await humble.run(0.3, humble.jogs, jog(pan=0.5))
        await humble.run(0.5)
        count, position = len(humble.received), humble.positions[0]
        assert abs(humble.received[-1].points[0].velocities[0]) < 1e-3
        await humble.run(0.2)
        assert (len(humble.received), humble.positions[0]) == (count, position)
        assert position == pytest.approx(0.15 + 0.05, abs=0.02)

    async def test_unitless_commands_are_scaled(self, graph, clock) -> None:
        bench = ServoBench(graph, clock, command_in_type="unitless", scale={"joint": 0.2})
        await bench.call("std_srvs/srv/Trigger", "start_servo")
        await bench.run(0.5, bench.jogs, jog(pan=1.0))
        assert bench.positions[0] == pytest.approx(0.1, abs=0.01)
        bench.servo.close()

    async def test_array_of_velocities(self, graph, clock) -> None:
        out = {"command_out_type": "std_msgs/Float64MultiArray", "publish_joint_positions": False}
        bench = ServoBench(graph, clock, **out)
        await bench.call("std_srvs/srv/Trigger", "start_servo")
        await bench.run(0.2, bench.jogs, jog(pan=0.3))
        assert list(bench.received[-1].data) == pytest.approx([0.3, 0, 0, 0, 0, 0], abs=1e-3)
        bench.servo.close()

    async def test_close_object_slows_and_collision_halts(self, humble) -> None:
        tip = humble.tip()
        scene = message("moveit_msgs/msg/PlanningScene", is_diff=True)
        scene.world.collision_objects = [box("wall", tip[0], tip[1] + 0.2, tip[2], size=(0.5, 0.1, 0.5))]
        publisher = humble.node.create_publisher("moveit_msgs/msg/PlanningScene", "planning_scene", 10)
        publisher.publish(scene)
        await humble.run(4.0, humble.twists, twist(y=0.1))
        assert {3} <= {status.data for status in humble.statuses}
        # The flange and the fingers are wider than the tip; the wall begins 0.15 m away.
        assert 0.05 < humble.tip()[1] - tip[1] < 0.15
        assert np.abs(humble.received[-1].points[0].velocities).max() < 0.05

    @pytest.mark.parametrize(
        ("command", "reason"),
        [
            (jog(pan=float("nan")), "a component is not finite"),
            (jog(nose=0.1), "the group 'arm' has no joint 'nose'"),
            (message("control_msgs/msg/JointJog", joint_names=["pan"]), "a joint jog needs one velocity"),
            (twist("moon", x=0.1), "there is no frame 'moon'"),
        ],
    )
    async def test_invalid_commands_move_nothing(self, humble, logged, command: Any, reason: str) -> None:
        publisher = humble.twists if hasattr(command, "twist") else humble.jogs
        await humble.run(0.05, publisher, command)
        assert humble.received == []
        assert any(reason in text for text in logged("WARN"))
        assert -1 in {status.data for status in humble.statuses}


class TestModes:
    async def test_nothing_moves_before_start_and_after_stop(self, graph, clock) -> None:
        bench = ServoBench(graph, clock)
        await bench.run(0.1, bench.jogs, jog(pan=0.5))
        assert bench.received == []
        await bench.call("std_srvs/srv/Trigger", "start_servo")
        await bench.run(0.1, bench.jogs, jog(pan=0.5))
        await bench.call("std_srvs/srv/Trigger", "stop_servo")
        count = len(bench.received)
        await bench.run(0.1, bench.jogs, jog(pan=0.5))
        assert len(bench.received) == count > 0
        bench.servo.close()

    async def test_command_type_is_switched(self, jazzy, logged) -> None:
        await jazzy.run(0.1, jazzy.twists, twist(y=0.1))
        assert jazzy.received == []
        assert "Command type is JOINT_JOG, cannot accept input of type TWIST" in logged("WARN")
        assert not (await jazzy.call("moveit_msgs/srv/ServoCommandType", "switch_command_type", command_type=7)).success
        assert (await jazzy.call("moveit_msgs/srv/ServoCommandType", "switch_command_type", command_type=1)).success
        await jazzy.run(0.1, jazzy.twists, twist(y=0.1))
        assert jazzy.received
        assert (jazzy.statuses[-1].code, jazzy.statuses[-1].message) == (0, "No warnings")

    async def test_pause(self, jazzy) -> None:
        assert (await jazzy.call("std_srvs/srv/SetBool", "pause_servo", data=True)).message == "Servoing disabled"
        await jazzy.run(0.1, jazzy.jogs, jog(pan=0.5))
        assert jazzy.received == []
        await jazzy.call("std_srvs/srv/SetBool", "pause_servo", data=False)
        await jazzy.run(0.1, jazzy.jogs, jog(pan=0.5))
        assert jazzy.received

    async def test_pose_is_tracked(self, jazzy) -> None:
        await jazzy.call("moveit_msgs/srv/ServoCommandType", "switch_command_type", command_type=2)
        target = jazzy.tip() + np.array((0.0, 0.06, 0.02, 0, 0, 0, 0))
        pose = message("geometry_msgs/msg/PoseStamped")
        pose.header.frame_id = "base"
        pose.pose.position.x, pose.pose.position.y, pose.pose.position.z = target[:3].tolist()
        rotation = pose.pose.orientation
        rotation.x, rotation.y, rotation.z, rotation.w = target[3:].tolist()
        await jazzy.run(1.0, jazzy.poses, pose)
        np.testing.assert_allclose(jazzy.tip()[:3], target[:3], atol=0.002)


@pytest.mark.parametrize(
    ("servo", "text"),
    [
        ({"move_group_name": ""}, "moveit_servo.move_group_name' of servo_node has the invalid value ''"),
        ({"move_group_name": "gripper"}, "no group 'gripper' that is a chain"),
        ({"publish_period": 0.0}, "'moveit_servo.publish_period' of servo_node has the invalid value 0.0"),
        ({"command_in_type": "knots"}, "has the invalid value 'knots'"),
        ({"scale": {"linear": "fast"}}, "'moveit_servo.scale.linear' of servo_node has the invalid value 'fast'"),
        ({"joint_limit_margins": [0.1, 0.2]}, "'moveit_servo.joint_limit_margins' of servo_node"),
        ({"hard_stop_singularity_threshold": 5.0}, "hard_stop_singularity_threshold"),
    ],
)
def test_invalid_parameters_are_told(graph, clock, servo: dict[str, Any], text: str) -> None:
    with pytest.raises(LinkwrightError) as error:
        ServoBench(graph, clock, **servo)
    assert error.value.diagnostics[0].code == "ARM107"
    assert text in str(error.value.diagnostics[0].message)
