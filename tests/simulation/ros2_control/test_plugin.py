"""The ros2_control plugin of Gazebo: controlled joints and sensors in a simulation."""

from __future__ import annotations

from math import isnan

import pytest

from linkwright.graph import DESCRIPTION_QOS
from linkwright.messages import String, get_service
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, robot, running_server
from tests.simulation.worlds import GROUND, model

FILE = """
controller_manager:
  ros__parameters:
    update_rate: 100
    broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    wheels: {type: velocity_controllers/JointGroupVelocityController}
wheels:
  ros__parameters:
    joints: [left_joint, right_joint]
"""
PLUGINS = {
    "classic": ("libgazebo_ros2_control.so", "gazebo_ros2_control", "gazebo_ros2_control/GazeboSystem"),
    "gz": ("gz_ros2_control-system", "gz_ros2_control::GazeboSimROS2ControlPlugin", "gz_ros2_control/GazeboSimSystem"),
    "copy": ("libvendor_ros2_control.so", "ign_ros2_control::IgnitionROS2ControlPlugin", "vendor/IgnitionSystem"),
}
IMU = "<sensor name='imu' type='imu'><update_rate>10</update_rate></sensor>"


def wheel_joint(name: str, command: str = "velocity", initial: str = "") -> str:
    value = f"<param name='initial_value'>{initial}</param>" if initial else ""
    return (
        f"<joint name='{name}'><command_interface name='{command}'/>"
        f"<state_interface name='position'>{value}</state_interface><state_interface name='velocity'/>"
        "<state_interface name='effort'/></joint>"
    )


def robot_description(control: str, plugin: str = PLUGINS["classic"][2]) -> str:
    joints = "".join(
        f"<link name='{side}'/><joint name='{side}_joint' type='continuous'><parent link='base'/><child link='{side}'/>"
        "</joint>"
        for side in ("left", "right", "third")
    )
    return (
        f"<robot name='mbot'><link name='base'/>{joints}<ros2_control name='drive' type='system'><hardware><plugin>"
        f"{plugin}</plugin></hardware>{control}</ros2_control></robot>"
    )


class ControlledRobot:
    """A simulated robot with a controller manager."""

    def __init__(self, server, graph) -> None:
        self.server, self.graph = server, graph
        self.node = graph.create_node("test_node")

    async def describe(self, text: str, topic: str = "/robot_description") -> None:
        self.node.create_publisher(String, topic, DESCRIPTION_QOS).publish(String(data=text))
        await self.advance(0.01)

    async def advance(self, seconds: float) -> None:
        await self.graph.settle()
        self.server.advance(round(seconds * SECOND_NS))
        await self.graph.settle()

    async def call(self, service: str, manager: str = "/controller_manager", **fields):
        service_type = get_service(
            "controller_manager_msgs/srv/" + "".join(part.capitalize() for part in service.split("_"))
        )
        future = self.node.create_client(service_type, f"{manager}/{service}").call_async(
            service_type.Request(**fields)
        )
        await self.advance(0.01)
        return future.result()

    async def start(self, *names: str, manager: str = "/controller_manager") -> None:
        for name in names:
            assert (await self.call("load_controller", manager, name=name)).ok
            assert (await self.call("configure_controller", manager, name=name)).ok
        assert (await self.call("switch_controller", manager, activate_controllers=list(names), strictness=2)).ok

    async def command(self, *values: float, topic: str = "/wheels/commands") -> None:
        publisher = self.node.create_publisher("std_msgs/msg/Float64MultiArray", topic, 10)
        publisher.publish(publisher.msg_type(data=list(values)))
        await self.advance(0.02)


def robot_with_plugin(path, plugin: str = "classic", extra: str = "", elements: str = "") -> str:
    filename, name, _ = PLUGINS[plugin]
    text = robot(f'<plugin filename="{filename}" name="{name}"><parameters>{path}</parameters>{extra}</plugin>')
    return text.replace("</link>", f"{elements}</link>", 1)


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "controllers.yaml"
    path.write_text(FILE)
    return path


@pytest.mark.parametrize("plugin", PLUGINS)
async def test_wheels_follow_commands_and_stop_with_controller(file, plugin):
    async with running_server(GROUND, robot_with_plugin(file, plugin)) as (server, graph, log):
        world = ControlledRobot(server, graph)
        states = Recording(graph, server.node, "/joint_states")
        await world.describe(
            robot_description(wheel_joint("left_joint") + wheel_joint("right_joint"), PLUGINS[plugin][2])
        )
        await world.start("broadcaster", "wheels")
        await world.command(2.0, 2.0)
        await world.advance(2.0)
        assert states.last.name == ["left_joint", "right_joint"]
        assert list(states.last.velocity) == pytest.approx([2.0, 2.0], abs=0.05)
        x = server.simulation.model_pose("mbot")[0]
        assert x > 0.15
        assert (await world.call("switch_controller", deactivate_controllers=["wheels"], strictness=2)).ok
        await world.advance(0.5)
        assert list(states.last.velocity) == pytest.approx([0.0, 0.0], abs=0.05)
        assert not [record.text for record in log if record.level.name in ("WARN", "ERROR")]


async def test_servos_of_all_joints_require_one_model_compilation(file):
    async with running_server(robot_with_plugin(file), options=None) as (server, graph, _):
        world = ControlledRobot(server, graph)
        revision = server.simulation.revision
        wheels = wheel_joint("left_joint", "position", "0.5") + wheel_joint("right_joint", "position", "-0.4")
        await world.describe(robot_description(wheels))
        assert server.simulation.revision == revision + 1
        await world.advance(0.5)
        positions = [server.simulation.joint_state(f"mbot::{side}_joint")[0] for side in ("left", "right")]
        assert positions == pytest.approx([0.5, -0.4], abs=0.01)


async def test_positions_are_held_from_initial_values(file, tmp_path):
    positions = tmp_path / "positions.yaml"
    positions.write_text(
        "controller_manager: {ros__parameters: {arm: {type: position_controllers/JointGroupPositionController}}}\n"
        "arm: {ros__parameters: {joints: [left_joint]}}\n"
    )
    extra = f"<parameters>{positions}</parameters>"
    async with running_server(robot_with_plugin(file, extra=extra), options=None) as (server, graph, _):
        world = ControlledRobot(server, graph)
        await world.describe(robot_description(wheel_joint("left_joint", "position", "0.5")))
        assert server.simulation.joint_state("mbot::left_joint")[0] == pytest.approx(0.5, abs=0.01)
        await world.start("arm")
        await world.command(-0.25, topic="/arm/commands")
        await world.advance(0.5)
        assert server.simulation.joint_state("mbot::left_joint")[0] == pytest.approx(-0.25, abs=0.01)


async def test_efforts_are_applied_and_measured(file, tmp_path):
    efforts = tmp_path / "efforts.yaml"
    efforts.write_text(
        "controller_manager: {ros__parameters: {arm: {type: effort_controllers/JointGroupEffortController},"
        " broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}}}\n"
        "arm: {ros__parameters: {joints: [left_joint]}}\n"
    )
    async with running_server(GROUND, robot_with_plugin(efforts)) as (server, graph, _):
        world = ControlledRobot(server, graph)
        states = Recording(graph, server.node, "/joint_states")
        await world.describe(robot_description(wheel_joint("left_joint", "effort")))
        await world.start("arm", "broadcaster")
        await world.command(0.01, topic="/arm/commands")
        await world.advance(0.2)
        assert list(states.last.effort) == pytest.approx([0.01])
        assert server.simulation.joint_state("mbot::left_joint")[1] > 0.05


async def test_imu_provides_state_interfaces(file):
    states = "<state_interface name='orientation.w'/><state_interface name='linear_acceleration.z'/>"
    sensor = f"<sensor name='imu'>{states}</sensor>"
    async with running_server(GROUND, robot_with_plugin(file, elements=IMU)) as (server, graph, _):
        world = ControlledRobot(server, graph)
        states = Recording(graph, server.node, "/dynamic_joint_states")
        await world.describe(robot_description(wheel_joint("left_joint") + sensor))
        await world.start("broadcaster")
        await world.advance(0.5)
        values = dict(zip(states.last.joint_names, states.last.interface_values, strict=True))["imu"]
        assert values.interface_names == ["orientation.w", "linear_acceleration.z"]
        assert list(values.values) == pytest.approx([1.0, 9.8], abs=0.05)


async def test_namespace_name_and_remappings_of_manager(file):
    file.write_text(FILE.replace("\ncontroller_manager:", "\n/r1/manager:").replace("\nwheels:", "\n/r1/wheels:"))
    extra = (
        "<controller_manager_name>manager</controller_manager_name>"
        "<ros><namespace>r1</namespace><remapping>wheels/commands:=wanted</remapping></ros>"
    )
    async with running_server(GROUND, robot_with_plugin(file, extra=extra)) as (server, graph, _):
        world = ControlledRobot(server, graph)
        await world.describe(
            robot_description(wheel_joint("left_joint") + wheel_joint("right_joint")), "/r1/robot_description"
        )
        await world.start("wheels", manager="/r1/manager")
        assert "/r1/wheels" in graph.node_names()


async def test_joints_and_sensors_missing_in_model_are_reported(file):
    text = (
        wheel_joint("left_joint")
        + wheel_joint("third_joint")
        + "<sensor name='ft'><state_interface name='force.x'/></sensor>"
    )
    async with running_server(GROUND, robot_with_plugin(file)) as (server, graph, log):
        world = ControlledRobot(server, graph)
        await world.describe(robot_description(text))
        joint, sensor = (record.text for record in log if record.level.name == "WARN")
        assert joint == "Skipping joint in the URDF named 'third_joint' which is not in the gazebo model."
        assert sensor.startswith(
            "sensor 'ft' of <ros2_control> has no IMU or force-torque sensor of this name in the model"
        )
        interfaces = await world.call("list_hardware_interfaces")
        assert [command_interface.name for command_interface in interfaces.command_interfaces] == [
            "left_joint/velocity"
        ]


async def test_reset_keeps_controllers_active(file):
    async with running_server(GROUND, robot_with_plugin(file)) as (server, graph, _):
        world = ControlledRobot(server, graph)
        states = Recording(graph, server.node, "/joint_states")
        await world.describe(robot_description(wheel_joint("left_joint") + wheel_joint("right_joint")))
        await world.start("broadcaster", "wheels")
        await world.command(2.0, 2.0)
        await world.advance(0.5)
        server.reset()
        await world.advance(1.0)
        assert states.last.header.stamp.sec == 1
        assert list(states.last.velocity) == pytest.approx([2.0, 2.0], abs=0.05)
        assert not any(isnan(effort) for effort in states.last.effort)


async def test_manager_is_removed_with_robot(file):
    async with running_server(GROUND, robot_with_plugin(file)) as (server, graph, _):
        world = ControlledRobot(server, graph)
        await world.describe(robot_description(wheel_joint("left_joint") + wheel_joint("right_joint")))
        await world.start("broadcaster", "wheels")
        server.delete("mbot")
        await world.advance(0.1)
        assert graph.node_names() == ["/gazebo", "/test_node"]


async def test_controllers_stay_active_when_model_is_replaced(file):
    text = robot_with_plugin(file)
    async with running_server(GROUND, text) as (server, graph, _):
        world = ControlledRobot(server, graph)
        await world.describe(robot_description(wheel_joint("left_joint") + wheel_joint("right_joint")))
        await world.start("broadcaster", "wheels")
        heavier = text.replace("<mass>", "<mass>1", 1)
        server.replace_model(model(heavier), "mbot")
        await world.advance(0.1)
        listed = (await world.call("list_controllers")).controller
        assert {controller.name: controller.state for controller in listed} == {
            "broadcaster": "active",
            "wheels": "active",
        }
        await world.command(2.0, 2.0)
        await world.advance(1.0)
        assert server.simulation.joint_state("mbot::left_joint")[1] == pytest.approx(2.0, abs=0.05)


async def test_respawned_robot_has_no_controllers(file):
    text = robot_with_plugin(file)
    async with running_server(GROUND, text) as (server, graph, _):
        world = ControlledRobot(server, graph)
        await world.describe(robot_description(wheel_joint("left_joint") + wheel_joint("right_joint")))
        await world.start("wheels")
        server.delete("mbot")
        server.spawn(model(text), "mbot")
        await world.advance(0.1)
        assert (await world.call("list_controllers")).controller == []


async def test_vendor_copy_of_plugin_is_reported_once(file):
    description_with_two_plugins = robot_with_plugin(
        file, "copy", "<controller_manager_name>other</controller_manager_name>"
    )
    async with running_server(
        GROUND, robot_with_plugin(file, "copy"), description_with_two_plugins.replace('"mbot"', '"two"')
    ) as (_, __, log):
        logged = [record.text for record in log if "is simulated as" in record.text]
    assert logged == [
        (
            "'libvendor_ros2_control.so' is simulated as 'ign_ros2_control-system', because its plugin class "
            "belongs to 'ign_ros2_control-system'"
        )
    ]
