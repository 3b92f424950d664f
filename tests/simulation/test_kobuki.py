"""The base Kobuki: driving, odometry, cliffs, bumps and the IMU."""

from __future__ import annotations

from math import atan2, pi

import pytest

from linkwright.messages import get_message
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import GROUND, box, mbot

SEPARATION, RADIUS, HEIGHT = 0.38, 0.06, 0.11
PARAMETERS = (
    "<publish_tf>1</publish_tf><left_wheel_joint_name>left_joint</left_wheel_joint_name>"
    "<right_wheel_joint_name>right_joint</right_wheel_joint_name>"
    f"<wheel_separation>{SEPARATION}</wheel_separation><wheel_diameter>{2 * RADIUS}</wheel_diameter>"
    "<torque>5.0</torque><velocity_command_timeout>0.6</velocity_command_timeout>"
    "<cliff_sensor_left_name>left_cliff</cliff_sensor_left_name>"
    "<cliff_sensor_center_name>front_cliff</cliff_sensor_center_name>"
    "<cliff_sensor_right_name>right_cliff</cliff_sensor_right_name>"
    "<cliff_detection_threshold>0.15</cliff_detection_threshold>"
    "<bumper_name>bumpers</bumper_name><imu_name>imu</imu_name>"
)
RAY = (
    "<ray><scan><horizontal><samples>1</samples><min_angle>0</min_angle><max_angle>0</max_angle></horizontal></scan>"
    "<range><min>0.01</min><max>0.5</max></range></ray>"
)
CLIFFS = "".join(
    f'<sensor name="{name}_cliff" type="ray"><pose>{x} {y} 0 0 {pi / 2} 0</pose>{RAY}</sensor>'
    for name, x, y in (("left", 0.15, 0.15), ("front", 0.21, 0.0), ("right", 0.15, -0.15))
)
SENSORS = (
    f'{CLIFFS}<sensor name="imu" type="imu"/><sensor name="bumpers" type="contact"><contact><collision>collision'
    "</collision></contact></sensor>"
)
ENTRANCE = '<link name="base_link">'


def kobuki(parameters: str = PARAMETERS, pose: str = f"0 0 {HEIGHT} 0 0 0") -> str:
    plugin = f'<plugin name="kobuki" filename="libgazebo_ros_kobuki.so">{parameters}</plugin>'
    return mbot(pose).replace(ENTRANCE, ENTRANCE + SENSORS).replace("</model>", f"{plugin}</model>")


async def send(graph, topic: str, message_type: str, **fields) -> None:
    node = graph.create_node("driver")
    node.create_publisher(message_type, f"/mobile_base/{topic}", 10).publish(get_message(message_type)(**fields))
    await graph.settle()
    node.destroy_node()


async def drive(graph, speed: float, yaw_rate: float = 0.0) -> None:
    twist = get_message("geometry_msgs/msg/Twist")()
    twist.linear.x, twist.angular.z = speed, yaw_rate
    await send(graph, "commands/velocity", "geometry_msgs/msg/Twist", linear=twist.linear, angular=twist.angular)


async def test_robot_follows_commands_until_they_are_late():
    async with running_server(GROUND, kobuki()) as (server, graph, log):
        odometry = Recording(graph, server.node, "/odom")
        await graph.settle()
        await drive(graph, 0.2)
        server.advance(SECOND_NS // 2)
        await graph.settle()
        assert odometry[-1].twist.twist.linear.x == pytest.approx(0.2, abs=0.02)
        assert odometry[-1].pose.pose.position.x == pytest.approx(server.simulation.model_pose("mbot")[0], abs=0.01)
        assert (odometry[-1].header.frame_id, odometry[-1].child_frame_id) == ("odom", "base_footprint")
        server.advance(SECOND_NS)
        await graph.settle()
        assert odometry[-1].twist.twist.linear.x == pytest.approx(0.0, abs=0.01)
        assert not log


async def test_heading_is_that_of_the_gyroscope_and_can_be_reset():
    async with running_server(GROUND, kobuki()) as (server, graph, _):
        odometry, imu = (Recording(graph, server.node, name) for name in ("/odom", "/mobile_base/sensors/imu_data"))
        await graph.settle()
        await drive(graph, 0.0, 0.8)
        server.advance(SECOND_NS // 2)
        await graph.settle()
        rotation = odometry[-1].pose.pose.orientation
        *_, z, w = server.simulation.model_pose("mbot")
        assert 2 * atan2(rotation.z, rotation.w) == pytest.approx(2 * atan2(z, w), abs=0.02)
        assert imu[-1].angular_velocity.z == pytest.approx(0.8, abs=0.05)
        assert imu[-1].linear_acceleration.z == pytest.approx(9.81, abs=0.1)
        await send(graph, "commands/reset_odometry", "std_msgs/msg/Empty")
        server.advance(SECOND_NS // 50)
        await graph.settle()
        assert odometry[-1].pose.pose.orientation.z == pytest.approx(0.0, abs=0.02)


async def test_motors_without_power_do_not_turn():
    async with running_server(GROUND, kobuki()) as (server, graph, _):
        await send(graph, "commands/motor_power", "kobuki_ros_interfaces/msg/MotorPower", state=0)
        await drive(graph, 0.2)
        server.advance(SECOND_NS // 2)
        assert server.simulation.model_pose("mbot")[0] == pytest.approx(0.0, abs=5e-3)
        await send(graph, "commands/motor_power", "kobuki_ros_interfaces/msg/MotorPower", state=1)
        await drive(graph, 0.2)
        server.advance(SECOND_NS // 2)
        assert server.simulation.model_pose("mbot")[0] > 0.05


TABLE = box("table", "-0.5 0 -0.5 0 0 0", "1.5 3 1").replace("<link", "<static>true</static><link", 1)


async def test_cliff_is_reported_when_it_appears_and_when_the_floor_returns():
    robot = kobuki(pose=f"-0.1 0 {HEIGHT} 0 0 0")
    async with running_server(TABLE, robot) as (server, graph, _):
        events = Recording(graph, server.node, "/mobile_base/events/cliff")
        await graph.settle()
        server.advance(SECOND_NS // 5)
        await graph.settle()
        assert list(events) == []
        for _ in range(4):
            await drive(graph, 0.25)
            server.advance(SECOND_NS // 5)
        await graph.settle()
        assert [(event.sensor, event.state) for event in events][:1] == [(1, 1)]
        assert events[0].bottom == int(76123.0 * atan2(0.995, float("inf")))
        count = len(events)
        for _ in range(10):
            await drive(graph, -0.25)
            server.advance(SECOND_NS // 5)
        await graph.settle()
        back = [(event.sensor, event.state) for event in events][count:]
        assert (1, 0) in back
        floor = next(event for event in events if event.state == 0)
        assert floor.bottom == pytest.approx(76123.0 * atan2(0.995, HEIGHT) % 65536, abs=500)


@pytest.mark.parametrize(("y", "zone"), [(0.0, 1), (0.25, 0), (-0.25, 2)])
async def test_bump_is_reported_in_its_zone(y: float, zone: int):
    post = (
        f'<model name="post"><static>true</static><pose>0.45 {y} 0.1 0 0 0</pose><link name="l"><collision name="c">'
        "<geometry><cylinder><radius>0.1</radius><length>0.2</length></cylinder></geometry></collision></link></model>"
    )
    async with running_server(GROUND, post, kobuki()) as (server, graph, _):
        events = Recording(graph, server.node, "/mobile_base/events/bumper")
        await graph.settle()
        for _ in range(8):
            await drive(graph, 0.25)
            server.advance(SECOND_NS // 4)
        await graph.settle()
        assert (events[0].bumper, events[0].state) == (zone, 1)
        for _ in range(4):
            await drive(graph, -0.25)
            server.advance(SECOND_NS // 4)
        await graph.settle()
        assert (events[-1].bumper, events[-1].state) == (zone, 0)


async def test_joint_states_name_both_wheels():
    async with running_server(GROUND, kobuki()) as (server, graph, _):
        states = Recording(graph, server.node, "/joint_states")
        await graph.settle()
        await drive(graph, 0.3)
        server.advance(SECOND_NS // 2)
        await graph.settle()
        assert list(states[-1].name) == ["left_joint", "right_joint"]
        assert list(states[-1].velocity) == pytest.approx([0.3 / RADIUS] * 2, rel=0.05)


async def test_missing_sensor_is_reported():
    parameters = PARAMETERS.replace("<bumper_name>bumpers", "<bumper_name>skirt")
    async with running_server(GROUND, kobuki(parameters)) as (_, __, log):
        assert [record.text for record in log if record.text.endswith("there is no sensor 'skirt'")]
