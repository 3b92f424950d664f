"""``libgazebo_ros_control.so``: robots of ROS 1 with ``<transmission>`` elements."""

from __future__ import annotations

import re
from contextlib import asynccontextmanager
from math import tau
from pathlib import Path

import pytest

from linkwright.control.motion.pid import CLAMPED, NONE
from linkwright.descriptions import DescriptionLibrary
from linkwright.graph import Graph, LogLevel
from linkwright.sdf.from_urdf import model_from_robot
from linkwright.simulation.plugins.ros2_control.classic_gains import parse_gains, read_gains
from linkwright.testing import Recording
from tests.simulation.ros2_control.test_plugin import ControlledRobot
from tests.simulation.test_plugins import running_server

TYPES = {
    "effort": "effort_controllers/JointGroupEffortController",
    "position": "position_controllers/JointGroupPositionController",
    "velocity": "velocity_controllers/JointGroupVelocityController",
}
MANAGER = """
/**/controller_manager:
  ros__parameters:
    broadcaster: {{type: joint_state_broadcaster/JointStateBroadcaster}}
    arm: {{type: {type}}}
/**/arm:
  ros__parameters:
    joints: [swing]
"""
GAINS = "\n{node}:\n  ros__parameters:\n    pid_gains:\n      swing: {{{gains}}}\n"
SOFT_LIMITS = (
    "<safety_controller soft_lower_limit='-0.2' soft_upper_limit='0.2' k_position='{k_position}' "
    "k_velocity='{k_velocity}'/>"
)


def robot_urdf(interface: str, extra: str = "", safety: str = "", effort: float = 20.0) -> str:
    """Return a horizontal arm at a height of 1 m.

    It turns up and down about the joint ``swing``.
    """
    return f"""
<robot name="arm">
  <link name="world"/>
  <link name="bar"><inertial><origin xyz="0.2 0 0"/><mass value="1"/>
    <inertia ixx="0.01" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="swing" type="revolute"><origin xyz="0 0 1"/><parent link="world"/><child link="bar"/>
    <axis xyz="0 1 0"/><limit lower="-0.5" upper="0.5" effort="{effort}" velocity="4"/>{safety}</joint>
  <transmission name="drive"><type>transmission_interface/SimpleTransmission</type>
    <joint name="swing"><hardwareInterface>hardware_interface/{interface.capitalize()}JointInterface</hardwareInterface>
    </joint><actuator name="motor"><mechanicalReduction>50</mechanicalReduction></actuator></transmission>
  <gazebo><plugin name="gazebo_ros_control" filename="libgazebo_ros_control.so">{extra}</plugin></gazebo>
</robot>"""


class ClassicRobot(ControlledRobot):
    """The arm, which was spawned and described by its URDF."""

    manager = "/controller_manager"

    @property
    def state(self) -> tuple[float, float]:
        return self.server.simulation.joint_state("arm::swing")

    async def start_controllers(self, *names: str) -> None:
        await self.start(*(names or ("arm", "broadcaster")), manager=self.manager)

    async def move(self, value: float, topic: str = "/arm/commands") -> None:
        await self.command(value, topic=topic)


@asynccontextmanager
async def run_arm(text: str, topic: str = "/robot_description"):
    """Run the arm's simulation; yield the robot and the log."""
    async with running_server(options=None) as (server, graph, log):
        robot = DescriptionLibrary().read(text).robot
        assert robot is not None
        server.spawn(model_from_robot(robot, lump_fixed_joints=True).model, "arm")
        world = ClassicRobot(server, graph)
        await world.describe(text, topic)
        yield world, log


@pytest.fixture
def write_parameter_file(tmp_path):
    """Return a function that writes the parameters for a kind of command.

    It returns the plugin's element.
    """

    def write(kind: str, gains: str = "", node: str = "gazebo_ros_control") -> str:
        path = tmp_path / "controllers.yaml"
        text = MANAGER.format(type=TYPES[kind])
        path.write_text(text + (GAINS.format(node=node, gains=gains) if gains else ""))
        return f"<parameters>{path}</parameters>"

    return write


async def test_position_commands_set_the_joint_despite_its_reduction(write_parameter_file):
    async with run_arm(robot_urdf("position", write_parameter_file("position"))) as (world, log):
        states = Recording(world.graph, world.server.node, "/joint_states")
        await world.advance(0.3)
        assert world.state[0] == pytest.approx(0.0, abs=0.01)  # held before any controller starts
        await world.start_controllers()
        await world.move(0.3)
        await world.advance(0.3)
        assert world.state[0] == pytest.approx(0.3, abs=0.01)
        assert states.last.name == ["swing"]
        assert list(states.last.position) == pytest.approx([0.3], abs=0.01)
        assert len(states.last.velocity) == len(states.last.effort) == 1
        replacement, limit = [str(record.text) for record in log if record.level >= LogLevel.WARN]
        assert replacement.startswith("libgazebo_ros_control.so is a plugin of ROS 1")
        assert "libgazebo_ros2_control.so" in replacement
        assert "the commanded position 0.3 is outside its limits" in limit  # its velocity limit


async def test_joint_without_command_falls_only_with_effort_interface(write_parameter_file):
    for kind, is_held in (("effort", False), ("velocity", True)):
        async with run_arm(robot_urdf(kind, write_parameter_file(kind))) as (world, _):
            await world.advance(0.3)
            assert (abs(world.state[0]) < 0.05) is is_held, kind


async def test_wheel_without_controller_is_free_for_other_plugins(write_parameter_file):
    text = robot_urdf("velocity", write_parameter_file("velocity"), effort=100.0).replace("revolute", "continuous")
    async with run_arm(text) as (world, _):
        await world.advance(0.3)
        assert world.state[0] > 0.2
        await world.start_controllers()
        await world.move(0.0)
        await world.advance(0.5)
        assert world.state[1] == pytest.approx(0.0, abs=0.12)


async def test_effort_commands_push_the_joint_within_its_limit(write_parameter_file):
    async with run_arm(robot_urdf("effort", write_parameter_file("effort"), effort=3.0)) as (world, log):
        states = Recording(world.graph, world.server.node, "/joint_states")
        await world.start_controllers()
        await world.move(-100.0)
        await world.advance(0.05)
        assert list(states.last.effort) == pytest.approx([-3.0])
        assert any("the commanded effort -100 is outside its limits; -3 is sent instead" in str(r.text) for r in log)


async def test_velocity_commands_turn_the_joint_within_its_limits(write_parameter_file):
    async with run_arm(robot_urdf("velocity", write_parameter_file("velocity"), effort=100.0)) as (world, _):
        await world.start_controllers()
        await world.move(0.5)
        await world.advance(0.4)
        assert world.state[1] == pytest.approx(0.5, abs=0.1)
        await world.advance(2.0)
        assert world.state == (pytest.approx(0.5, abs=0.02), pytest.approx(0.0, abs=0.02))


@pytest.mark.parametrize(("kind", "gains"), [("position", "p: 60.0, d: 6.0"), ("velocity", "p: 10.0")])
async def test_gains_make_a_pid_controller_push_the_joint(write_parameter_file, kind, gains):
    async with run_arm(robot_urdf(kind, write_parameter_file(kind, gains))) as (world, _):
        await world.start_controllers()
        await world.move(0.3)
        await world.advance(0.8)
        index = 0 if kind == "position" else 1
        # A PID controller without an integral term does not reach the command under load.
        assert world.state[index] == pytest.approx(0.3 + 0.2 * 9.81 / (60.0 if kind == "position" else 10.0), abs=0.03)


@pytest.mark.parametrize(
    ("gains", "is_reached"),
    [
        ("p: 30.0, d: 6.0, i: 100.0", False),
        ("p: 30.0, d: 6.0, i: 100.0, i_clamp: 5.0", True),
        ("p: 30.0, d: 6.0, i: 100.0, i_clamp_min: -5.0", True),
        ("p: 30.0, d: 6.0, i: 100.0, i_clamp_max: 5.0", False),
    ],
)
async def test_integral_of_pid_acts_within_its_clamp(write_parameter_file, gains, is_reached):
    async with run_arm(robot_urdf("position", write_parameter_file("position", gains))) as (world, _):
        await world.start_controllers()
        await world.move(0.3)
        await world.advance(2.0)
        assert (abs(world.state[0] - 0.3) < 0.01) is is_reached


@pytest.mark.parametrize(("value", "strategy"), [(True, CLAMPED), (False, NONE)])
def test_antiwindup_selects_the_strategy(value, strategy):
    gains = parse_gains("swing", {"swing.p": 1.0, "swing.antiwindup": value}, Graph().create_node("a").get_logger())
    assert gains is not None
    assert gains.antiwindup == strategy


@pytest.mark.parametrize(("legacy", "node"), [("", "/gazebo_ros_control"), ("false", "/r1/gazebo_ros_control")])
async def test_gains_are_in_the_root_namespace_unless_legacy_mode_is_off(write_parameter_file, legacy, node):
    mode = f"<legacyModeNS>{legacy}</legacyModeNS>" if legacy else ""
    for node_name, has_pid in ((node, True), ("/r2/gazebo_ros_control", False)):
        extra = (
            write_parameter_file("position", "p: 60.0, d: 6.0", node_name)
            + f"<robotNamespace>/r1</robotNamespace>{mode}"
        )
        async with run_arm(robot_urdf("position", extra), "/r1/robot_description") as (world, _):
            world.manager = "/r1/controller_manager"
            await world.start_controllers()
            await world.move(0.3, "/r1/arm/commands")
            await world.advance(0.8)
            assert (world.state[0] > 0.32) is has_pid


async def test_pid_of_continuous_joint_turns_the_shortest_way(write_parameter_file):
    text = robot_urdf("position", write_parameter_file("position", "p: 60.0, d: 6.0")).replace("revolute", "continuous")
    text = text.replace('velocity="4"', 'velocity="0"')  # without a limit, the whole command arrives at once
    async with run_arm(text) as (world, _):
        await world.start_controllers()
        await world.move(6.0)
        await world.advance(2.0)
        assert world.state[0] == pytest.approx(6.0 - tau + 0.2 * 9.81 / 60.0, abs=0.05)


async def test_gains_without_p_or_for_efforts_are_ignored(write_parameter_file):
    async with run_arm(robot_urdf("position", write_parameter_file("position", "d: 6.0"))) as (world, _):
        await world.start_controllers()
        await world.move(0.3)
        await world.advance(0.3)
        assert world.state[0] == pytest.approx(0.3, abs=0.01)
    async with run_arm(robot_urdf("effort", write_parameter_file("effort", "p: 60.0"))) as (world, _):
        await world.start_controllers()
        await world.move(-0.2 * 9.81)
        assert not world.server.plugins("arm")[0]._systems[0].has_pids


async def test_gain_that_is_not_a_number_is_reported(write_parameter_file):
    async with run_arm(robot_urdf("position", write_parameter_file("position", "p: stiff"))) as (_, log):
        warnings = [record.text for record in log if record.level == LogLevel.WARN]
        assert "the PID parameter p of joint 'swing' is not a number: 'stiff'" in warnings


async def test_soft_limits_stop_position_commands_and_slow_velocities(write_parameter_file):
    safety = SOFT_LIMITS.format(k_position=20.0, k_velocity=10.0)
    async with run_arm(robot_urdf("position", write_parameter_file("position"), safety)) as (world, _):
        await world.start_controllers()
        await world.move(0.4)
        await world.advance(1.0)
        assert world.state[0] == pytest.approx(0.2, abs=0.01)


async def test_control_period_is_the_period_of_updates(write_parameter_file):
    rates = {}
    for period in ("", "<controlPeriod>0.02</controlPeriod>", "<controlPeriod>0.0001</controlPeriod>"):
        async with run_arm(robot_urdf("position", write_parameter_file("position") + period)) as (world, log):
            rates[period] = world.server.plugins("arm")[0]._manager.update_rate
            is_reported = any("is shorter than the step of the simulation" in str(record.text) for record in log)
            assert is_reported is ("0.0001" in period)
    assert list(rates.values()) == pytest.approx([1000.0, 50.0, 1000.0])


async def test_update_rate_of_manager_applies_without_control_period(write_parameter_file, tmp_path):
    rate = tmp_path / "rate.yaml"
    rate.write_text("controller_manager: {ros__parameters: {update_rate: 200}}\n")
    async with run_arm(
        robot_urdf("position", f"{write_parameter_file('position')}<parameters>{rate}</parameters>")
    ) as (world, _):
        assert world.server.plugins("arm")[0]._manager.update_rate == 200.0


async def test_description_is_searched_for_in_outer_namespaces(write_parameter_file):
    extra = (
        write_parameter_file("position")
        + "<robotNamespace>/team/r1</robotNamespace><robotParam>arm_description</robotParam>"
    )
    for topic, is_found in (
        ("/team/r1/arm_description", True),
        ("/team/arm_description", True),
        ("/arm_description", True),
        ("/robot_description", False),
    ):
        async with run_arm(robot_urdf("position", extra), topic) as (world, _):
            assert world.server.plugins("arm")[0]._is_loaded is is_found, topic
    absolute = extra.replace("arm_description", "/far/arm_description")
    async with run_arm(robot_urdf("position", absolute), "/far/arm_description") as (world, _):
        assert world.server.plugins("arm")[0]._is_loaded


@pytest.mark.parametrize("kind", TYPES)
async def test_emergency_stop_holds_positions_and_stops_velocities_and_efforts(write_parameter_file, kind):
    extra = write_parameter_file(kind) + "<eStopTopic>e_stop</eStopTopic>"
    async with run_arm(robot_urdf(kind, extra, effort=100.0)) as (world, _):
        publisher = world.node.create_publisher("std_msgs/msg/Bool", "/e_stop", 10)
        await world.start_controllers()
        await world.move({"position": 0.1, "velocity": 0.2, "effort": -30.0}[kind])
        await world.advance(0.05)
        publisher.publish(publisher.msg_type(data=True))
        await world.advance(0.05)
        stopped = world.state[0]
        await world.move({"position": 0.4, "velocity": 1.0, "effort": -30.0}[kind])
        await world.advance(0.3)
        if kind == "effort":
            assert world.server.simulation.data.joint("arm::swing").qfrc_applied[0] == 0.0
            return
        assert world.state == (pytest.approx(stopped, abs=0.05), pytest.approx(0.0, abs=0.12))
        publisher.publish(publisher.msg_type(data=False))
        await world.advance(0.5)
        assert world.state[0] > stopped + 0.05


async def test_other_robot_simulator_is_replaced_with_a_warning(write_parameter_file):
    extra = write_parameter_file("position") + "<robotSimType>my_robot/MyRobotHWSim</robotSimType>"
    async with run_arm(robot_urdf("position", extra)) as (world, log):
        assert "the robot simulator 'my_robot/MyRobotHWSim' is not available; DefaultRobotHWSim is used" in [
            record.text for record in log
        ]
        await world.start_controllers()


async def test_position_is_kept_when_world_restarts(write_parameter_file):
    async with run_arm(robot_urdf("position", write_parameter_file("position"))) as (world, _):
        await world.start_controllers()
        await world.move(0.3)
        await world.advance(0.3)
        world.server.reset()
        await world.advance(0.5)
        assert world.state[0] == pytest.approx(0.3, abs=0.01)


@pytest.mark.parametrize("page", ["docs/control.md", "docs/zh/control.md"])
async def test_documented_parameters_move_the_joint(page, tmp_path):
    text = (Path(__file__).parents[3] / page).read_text("utf-8")
    (block,) = (block for block in re.findall(r"```yaml\n(.*?)```", text, re.DOTALL) if "gazebo_ros_control" in block)
    path = tmp_path / "controllers.yaml"
    path.write_text(block)
    description = robot_urdf("effort", f"<parameters>{path}</parameters>").replace("swing", "elbow")
    async with run_arm(description) as (world, _):
        await world.start_controllers("elbow_controller")
        publisher = world.node.create_publisher("std_msgs/msg/Float64", "/elbow_controller/command", 10)
        publisher.publish(publisher.msg_type(data=-0.3))
        await world.advance(3.0)
        assert world.server.simulation.joint_state("arm::elbow")[0] == pytest.approx(-0.3, abs=0.01)
        assert read_gains([str(path)], "/") == {"wrist.p": 50.0, "wrist.d": 5.0}
