"""Joints whose gains controllers command, and the forces of feet, as gz_quadruped_hardware has them."""

from __future__ import annotations

import pytest

from linkwright.simulation.plugins.ros2_control.plugin import SimulatedControl
from linkwright.testing import Recording
from tests.simulation.ros2_control.test_plugin import ControlledRobot
from tests.simulation.test_plugins import running_server
from tests.simulation.worlds import GROUND

KINDS = ("position", "velocity", "effort", "kp", "kd")
FILE = "controller_manager:\n  ros__parameters:\n    update_rate: 1000\n" + "".join(
    f"    {kind}_forward: {{type: forward_command_controller/ForwardCommandController}}\n" for kind in KINDS
)
FILE += "    states: {type: joint_state_broadcaster/JointStateBroadcaster}\n"
FILE += "".join(
    f"{kind}_forward:\n  ros__parameters:\n    joints: [knee]\n    interface_name: {kind}\n" for kind in KINDS
)
FORCE_SENSOR = (
    "<sensor name='FR_foot_force' type='force_torque'><update_rate>1000</update_rate><force_torque>"
    "<frame>child</frame></force_torque></sensor>"
)


def leg(path) -> str:
    """Return a heavy body with a shank that turns about y, and a foot on the shank."""
    return (
        '<model name="dog"><pose>0 0 2 0 0 0</pose><link name="base"><inertial><mass>1e6</mass><inertia><ixx>1e6</ixx>'
        "<iyy>1e6</iyy><izz>1e6</izz></inertia></inertial></link>"
        '<link name="shank"><inertial><mass>0.5</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia>'
        '</inertial></link><link name="foot"><inertial><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy>'
        "<izz>0.1</izz></inertia></inertial></link>"
        '<joint name="mount" type="fixed"><parent>world</parent><child>base</child></joint>'
        '<joint name="knee" type="revolute"><parent>base</parent><child>shank</child><axis><xyz>0 1 0</xyz><limit>'
        "<lower>-2</lower><upper>2</upper><effort>20</effort></limit></axis></joint>"
        f'<joint name="ankle" type="fixed"><parent>shank</parent><child>foot</child>{FORCE_SENSOR}</joint>'
        '<plugin filename="gz_quadruped_hardware-system" name="gz_quadruped_hardware::GazeboSimQuadrupedPlugin">'
        f"<parameters>{path}</parameters></plugin></model>"
    )


COMMANDS = "".join(f"<command_interface name='{kind}'/>" for kind in KINDS)
STATES = "".join(f"<state_interface name='{kind}'/>" for kind in KINDS[:3])
DESCRIPTION = (
    "<robot name='dog'><link name='base'/><link name='shank'/><joint name='knee' type='revolute'><parent link='base'/>"
    "<child link='shank'/><axis xyz='0 1 0'/><limit lower='-2' upper='2' effort='20' velocity='30'/></joint>"
    "<ros2_control name='system' type='system'><hardware><plugin>gz_quadruped_hardware/GazeboSimSystem</plugin>"
    f"</hardware><joint name='knee'>{COMMANDS}{STATES}</joint>"
    "<sensor name='foot_force'><state_interface name='FR_foot_force'/></sensor></ros2_control></robot>"
)


async def test_torque_is_the_sum_of_effort_stiffness_and_damping(tmp_path):
    path = tmp_path / "controllers.yaml"
    path.write_text(FILE)
    async with running_server(GROUND, leg(path)) as (server, graph, log):
        world = ControlledRobot(server, graph)
        await world.describe(DESCRIPTION)
        await world.start("states", *(f"{kind}_forward" for kind in KINDS))
        states = Recording(graph, server.node, "/dynamic_joint_states")
        await world.command(10.0, topic="/kp_forward/commands")
        await world.command(1.5, topic="/kd_forward/commands")
        await world.command(0.4, topic="/position_forward/commands")
        await world.advance(3.0)
        position, velocity = server.simulation.joint_state("dog::knee")
        assert (position, velocity) == pytest.approx((0.4, 0.0), abs=0.01)
        await world.command(2.0, topic="/effort_forward/commands")
        await world.advance(3.0)
        assert server.simulation.joint_state("dog::knee")[0] == pytest.approx(0.6, abs=0.01)
        await world.command(0.0, topic="/kp_forward/commands")
        await world.command(0.0, topic="/effort_forward/commands")
        await world.command(0.5, topic="/velocity_forward/commands")
        await world.advance(0.5)
        assert server.simulation.joint_state("dog::knee")[1] == pytest.approx(0.5, abs=0.05)
        values = {
            name: dict(zip(item.interface_names, item.values, strict=True))
            for name, item in zip(states.last.joint_names, states.last.interface_values, strict=True)
        }
        assert values["foot_force"]["FR_foot_force"] == pytest.approx(2.0 * 9.81, rel=0.02)
        assert values["knee"]["velocity"] == pytest.approx(0.5, abs=0.1)
        errors = [record.text for record in log if record.level.name in ("WARN", "WARNING", "ERROR")]
        assert not errors


async def test_torque_is_limited_to_the_effort_of_the_joint(tmp_path):
    path = tmp_path / "controllers.yaml"
    path.write_text(FILE)
    async with running_server(GROUND, leg(path)) as (server, graph, _):
        world = ControlledRobot(server, graph)
        await world.describe(DESCRIPTION)
        await world.start("effort_forward")
        await world.command(500.0, topic="/effort_forward/commands")
        assert server.simulation.data.joint("dog::knee").qfrc_applied[0] == pytest.approx(20.0)


def test_plugin_of_quadrupeds_runs_a_controller_manager():
    from linkwright.simulation.plugins.registry import find_plugin_class

    assert find_plugin_class("gz_quadruped_hardware-system") is SimulatedControl
