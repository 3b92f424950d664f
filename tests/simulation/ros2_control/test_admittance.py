"""An admittance controller in a simulated world: a force moves the joint against the spring of the controller."""

from __future__ import annotations

import pytest

from linkwright.messages import get_message
from tests.simulation.ros2_control.test_plugin import ControlledRobot
from tests.simulation.test_plugins import running_server

FORCE_N, STIFFNESS_N_PER_M = 10.0, 100.0
FILE = f"""
controller_manager:
  ros__parameters:
    update_rate: 200
    compliance: {{type: admittance_controller/AdmittanceController}}
compliance:
  ros__parameters:
    joints: [slide]
    command_interfaces: [position]
    state_interfaces: [position]
    kinematics:
      plugin_name: kinematics_interface_kdl/KinematicsInterfaceKDL
      plugin_package: kinematics_interface
      base: rail
      tip: tool
    ft_sensor: {{name: wrist, frame: {{id: tool}}, filter_coefficient: 0.5}}
    control: {{frame: {{id: rail}}}}
    fixed_world_frame: {{frame: {{id: rail}}}}
    gravity_compensation: {{frame: {{id: tool}}, CoG: {{pos: [0.0, 0.0, 0.0], force: 0.0}}}}
    admittance:
      selected_axes: [true, false, false, false, false, false]
      mass: [4.0, 1.0, 1.0, 1.0, 1.0, 1.0]
      damping_ratio: [1.0, 1.0, 1.0, 1.0, 1.0, 1.0]
      stiffness: [{STIFFNESS_N_PER_M}, 1.0, 1.0, 1.0, 1.0, 1.0]
"""
DESCRIPTION = """<robot name='slider'><link name='rail'/><link name='tool'/>
<joint name='slide' type='prismatic'><parent link='rail'/><child link='tool'/><axis xyz='1 0 0'/>
<limit lower='-1' upper='1' effort='100' velocity='1'/></joint>
<ros2_control name='slider' type='system'><hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
<joint name='slide'><command_interface name='position'/><state_interface name='position'/></joint>
<sensor name='wrist'><state_interface name='force.x'/><state_interface name='force.y'/><state_interface name='force.z'/>
<state_interface name='torque.x'/><state_interface name='torque.y'/><state_interface name='torque.z'/></sensor>
</ros2_control></robot>"""
MODEL = """<model name="slider"><link name="rail"/><joint name="fix" type="fixed"><parent>world</parent>
<child>rail</child></joint><link name="tool"><inertial><mass>0.5</mass></inertial></link>
<joint name="slide" type="prismatic"><parent>rail</parent><child>tool</child>
<axis><xyz>1 0 0</xyz><limit><lower>-1</lower><upper>1</upper></limit></axis>
<sensor name="wrist" type="force_torque"><update_rate>200</update_rate><force_torque><frame>child</frame>
<measure_direction>child_to_parent</measure_direction></force_torque></sensor></joint>
<plugin filename="gz_ros2_control-system" name="gz_ros2_control::GazeboSimROS2ControlPlugin">
<parameters>{file}</parameters></plugin></model>"""
WRENCHES = '<plugin filename="gz-sim-apply-link-wrench-system" name="gz::sim::systems::ApplyLinkWrench"/>'


async def test_joint_yields_to_a_force_and_returns(tmp_path) -> None:
    file = tmp_path / "controllers.yaml"
    file.write_text(FILE)
    async with running_server(WRENCHES, MODEL.format(file=file)) as (server, graph, _):
        world = ControlledRobot(server, graph)
        await world.describe(DESCRIPTION)
        await world.start("compliance")
        await world.advance(0.5)
        assert server.simulation.joint_state("slider::slide")[0] == pytest.approx(0.0, abs=0.002)
        wrench = get_message("ros_gz_interfaces/msg/EntityWrench")()
        wrench.entity.name, wrench.entity.type = "slider::tool", wrench.entity.LINK
        wrench.wrench.force.x = FORCE_N
        world.node.create_publisher(type(wrench), "/world/test/wrench/persistent", 10).publish(wrench)
        for _ in range(40):
            await world.advance(0.1)
        displacement = server.simulation.joint_state("slider::slide")[0]
        assert displacement == pytest.approx(FORCE_N / STIFFNESS_N_PER_M, rel=0.05)
        world.node.create_publisher(type(wrench.entity), "/world/test/wrench/clear", 10).publish(wrench.entity)
        for _ in range(40):
            await world.advance(0.1)
        assert server.simulation.joint_state("slider::slide")[0] == pytest.approx(0.0, abs=0.005)
