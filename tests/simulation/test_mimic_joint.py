"""Joints that follow other joints, and links without dynamics.

Both are plugins of roboticsgroup_gazebo_plugins.
"""

from __future__ import annotations

from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from linkwright.descriptions import DescriptionLibrary
from linkwright.graph import LogLevel
from linkwright.sdf.from_urdf import model_from_robot
from tests.simulation.ros2_control.test_plugin import ControlledRobot
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import GROUND, box

LIBRARIES = (
    "libroboticsgroup_gazebo_mimic_joint_plugin.so",
    "libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so",
    "libgazebo_mimic_joint_plugin.so",
    "libmimic_joint_plugin.so",
)
DISABLING = ("libroboticsgroup_gazebo_disable_link_plugin.so", "libroboticsgroup_upatras_gazebo_disable_link_plugin.so")
GAINS = "{node}: {{ros__parameters: {{pid_gains: {{{joint}: {{p: 40.0, d: 1.0}}}}}}}}\n"


def finger_link(name: str, plugin_text: str = "", effort: float = 5.0) -> str:
    """Return a finger whose joint turns about the vertical axis.

    Gravity does not move it.
    """
    return f"""
  <link name="{name}"><inertial><origin xyz="0.1 0 0"/><mass value="0.1"/>
    <inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="{name}_joint" type="revolute"><parent link="world"/><child link="{name}"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" effort="{effort}" velocity="10"/>{plugin_text}</joint>"""


def gripper_model(
    plugin: str, library: str = LIBRARIES[0], mimic: str = "", other_joints: str = "", effort: float = 5.0
) -> str:
    return f"""<robot name="gripper"><link name="world"/>{finger_link("left")}{finger_link("right", mimic, effort)}
  <gazebo><plugin name="follow" filename="{library}"><joint>left_joint</joint><mimicJoint>right_joint</mimicJoint>
    {plugin}</plugin></gazebo>{other_joints}</robot>"""


class RunningGripper:
    """The running gripper, whose left joint the test sets."""

    def __init__(self, server, log) -> None:
        self.server, self.log = server, log
        self._servo = server.simulation.add_servo("gripper::left_joint", 100.0)

    def close(self, position: float, seconds: float = 0.5) -> float:
        """Move the left joint, and return the position of the right one after a time."""
        for _ in range(round(seconds * 100)):
            self._servo.move(position, 0.01)
            self.server.advance(SECOND_NS // 100)
        return self.server.simulation.joint_state("gripper::right_joint")[0]

    @property
    def warnings(self) -> list[str]:
        return [str(record.text) for record in self.log if record.level >= LogLevel.WARN]


@asynccontextmanager
async def run_gripper(text: str):
    async with running_server() as (server, _, log):
        robot = DescriptionLibrary().read(text).robot
        assert robot is not None
        server.spawn(model_from_robot(robot, lump_fixed_joints=True).model, "gripper")
        yield RunningGripper(server, log)


def write_gains(folder: Path, node: str = "gazebo_ros_control", joint: str = "right_joint") -> str:
    path = folder / "gains.yaml"
    path.write_text(GAINS.format(node=node, joint=joint))
    return f"<parameters>{path}</parameters>"


@pytest.mark.parametrize("library", LIBRARIES)
async def test_joint_follows_with_multiplier_and_offset(library):
    async with run_gripper(gripper_model("<multiplier>-2</multiplier><offset>0.1</offset>", library)) as robot:
        assert robot.close(0.4) == pytest.approx(-0.7, abs=0.01)
        assert robot.warnings == []
    async with run_gripper(gripper_model("", library)) as robot:
        assert robot.close(0.4) == pytest.approx(0.4, abs=0.01)


async def test_sensitiveness_is_the_deviation_that_is_left():
    async with run_gripper(gripper_model("<sensitiveness>0.2</sensitiveness>")) as robot:
        assert robot.close(0.1) == pytest.approx(0.0, abs=0.01)
        assert robot.close(0.5) > 0.25


async def test_sensitiveness_applies_to_pid_controllers(tmp_path):
    async with run_gripper(
        gripper_model(f"<sensitiveness>0.2</sensitiveness><hasPID/>{write_gains(tmp_path)}")
    ) as robot:
        assert robot.close(0.1) == pytest.approx(0.0, abs=0.01)
        assert robot.server.simulation.data.joint("gripper::right_joint").qfrc_applied[0] == 0.0


async def test_pid_controller_pushes_the_joint(tmp_path):
    async with run_gripper(gripper_model(f"<hasPID/>{write_gains(tmp_path)}")) as robot:
        early_force = robot.close(0.5, 0.05)
        assert 0.0 < early_force < 0.45
        assert robot.close(0.5, 2.0) == pytest.approx(0.5, abs=0.05)
        assert robot.warnings == []


@pytest.mark.parametrize(
    ("plugin_parameters", "effort", "force"), [("<maxEffort>0.5</maxEffort>", 5.0, 0.5), ("", 1.5, 1.5)]
)
async def test_max_effort_limits_the_force_of_the_pid_controller(tmp_path, plugin_parameters, effort, force):
    async with run_gripper(
        gripper_model(f"<hasPID/><multiplier>10</multiplier>{plugin_parameters}{write_gains(tmp_path)}", effort=effort)
    ) as robot:
        assert robot.close(1.5, 1.0) == pytest.approx(2.0, abs=0.02)  # the limit of the joint, far from its target
        assert robot.server.simulation.data.joint("gripper::right_joint").qfrc_applied[0] == pytest.approx(force)


@pytest.mark.parametrize(
    ("has_pid", "namespace", "node", "joint"),
    [
        ("<hasPID/>", "", "gazebo_ros_control", "right_joint"),
        ("<hasPID/>", "<robotNamespace>/r1</robotNamespace>", "/r1/gazebo_ros_control", "right_joint"),
        ("<hasPID>gazebo_ros_control/pid_gains/fingers</hasPID>", "", "gazebo_ros_control", "fingers"),
        ("<hasPID>/gazebo_ros_control/pid_gains/fingers</hasPID>", "", "gazebo_ros_control", "fingers"),
        (
            "<hasPID>gazebo_ros_control/pid_gains/fingers</hasPID>",
            "<robotNamespace>/r1</robotNamespace>",
            "/r1/gazebo_ros_control",
            "fingers",
        ),
        ("<hasPID>r2/gazebo_ros_control/pid_gains/fingers</hasPID>", "", "/r2/gazebo_ros_control", "fingers"),
        ("<hasPID>/r2/gazebo_ros_control/pid_gains/fingers</hasPID>", "", "/r2/gazebo_ros_control", "fingers"),
    ],
)
async def test_gains_are_found_by_namespace_and_name(tmp_path, has_pid, namespace, node, joint):
    for written, is_found in ((node, True), ("/other/gazebo_ros_control", False)):
        async with run_gripper(gripper_model(has_pid + namespace + write_gains(tmp_path, written, joint))) as robot:
            robot.close(0.4)
            missing = [text for text in robot.warnings if "so it follows without a PID controller" in text]
            assert (missing == []) is is_found, robot.warnings


async def test_gains_are_shared_with_gazebo_ros_control(tmp_path):
    control = (
        '<gazebo><plugin name="gazebo_ros_control" filename="libgazebo_ros_control.so">'
        f"{write_gains(tmp_path)}</plugin></gazebo>"
    )
    async with run_gripper(gripper_model("<hasPID/>", other_joints=control)) as robot:
        assert 0.0 < robot.close(0.5, 0.05) < 0.45


async def test_transmission_does_not_hold_a_joint_that_follows():
    transmission = (
        "<transmission name='t'><type>transmission_interface/SimpleTransmission</type><joint name='right_joint'>"
        "<hardwareInterface>PositionJointInterface</hardwareInterface></joint></transmission>"
    )
    control = '<gazebo><plugin name="control" filename="libgazebo_ros_control.so"/></gazebo>'
    text = gripper_model("", other_joints=transmission + control)
    async with run_gripper(text) as robot:
        await ControlledRobot(robot.server, robot.server.node.graph).describe(text)
        assert robot.server.plugins("gripper")[1]._systems
        assert robot.close(0.4) == pytest.approx(0.4, abs=0.01)


async def test_gains_may_be_written_in_the_plugin():
    async with run_gripper(gripper_model("<hasPID><p>40</p><d>1</d></hasPID>")) as robot:
        assert 0.0 < robot.close(0.5, 0.05) < 0.45
        assert robot.warnings == []


async def test_joint_without_gains_follows_without_pid_controller():
    async with run_gripper(gripper_model("<hasPID/>")) as robot:
        assert robot.close(0.4) == pytest.approx(0.4, abs=0.01)
        (warning,) = robot.warnings
        assert warning.startswith("joint 'right_joint' has no gain p in 'pid_gains' of '/gazebo_ros_control', so it")


async def test_mimic_element_couples_joints_once_and_has_priority():
    mimic = "<mimic joint='left_joint' multiplier='-1'/>"
    for multiplier, count in (("-1", 0), ("2", 1)):
        async with run_gripper(gripper_model(f"<multiplier>{multiplier}</multiplier>", mimic=mimic)) as robot:
            assert robot.close(0.4) == pytest.approx(-0.4, abs=0.01)
            differing = [text for text in robot.warnings if "follows its <mimic>, which differs" in text]
            assert len(differing) == count


async def test_missing_joint_is_reported():
    async with run_gripper(gripper_model("").replace("<mimicJoint>right", "<mimicJoint>wrong")) as robot:
        (warning,) = robot.warnings
        assert "there is no movable joint 'wrong_joint'" in warning


async def test_joint_does_not_jump_when_world_restarts():
    async with run_gripper(gripper_model("")) as robot:
        assert robot.close(0.5) == pytest.approx(0.5, abs=0.01)
        robot.server.reset()
        robot.server.advance(SECOND_NS // 1000)
        assert robot.server.simulation.joint_state("gripper::right_joint") == pytest.approx((0.0, 0.0), abs=0.01)


async def test_world_restart_restarts_the_pid_controller():
    plugin_parameters = "<hasPID><p>1</p><i>1</i><i_clamp>5</i_clamp></hasPID>"
    async with run_gripper(gripper_model(plugin_parameters)) as robot:
        robot.close(0.5)
        (plugin,) = robot.server.plugins("gripper")
        assert plugin._pid.integral != 0.0
        robot.server.reset()
        assert plugin._pid.integral == 0.0


def ball_model(library: str, link: str = "link") -> str:
    plugin = f'<plugin name="disable" filename="{library}"><link>{link}</link></plugin>'
    return box("crate", "0 0 3 0 0 0").replace("</model>", f"{plugin}</model>")


@pytest.mark.parametrize("library", DISABLING)
async def test_disabled_link_floats_until_something_touches_it(library):
    hammer = box("hammer", "0 0 5 0 0 0")
    async with running_server(GROUND, ball_model(library), hammer) as (server, _, log):
        server.advance(SECOND_NS // 4)
        assert server.simulation.model_pose("crate")[2] == pytest.approx(3.0, abs=1e-6)
        server.advance(2 * SECOND_NS)  # the other box falls on it
        assert server.simulation.model_pose("crate")[2] < 1.0
        server.reset()
        server.advance(SECOND_NS // 4)
        assert server.simulation.model_pose("crate")[2] == pytest.approx(3.0, abs=1e-6)
        assert log == []


async def test_link_with_joints_is_not_disabled():
    plugin = f'<gazebo><plugin name="disable" filename="{DISABLING[0]}"><link>left</link></plugin></gazebo>'
    async with run_gripper(gripper_model("", other_joints=plugin)) as robot:
        assert robot.close(0.4) == pytest.approx(0.4, abs=0.01)
        (warning,) = robot.warnings
        assert warning.startswith("link 'left' is not disabled")
