"""Quadrotors without rotors: states, forces and torques against the formulas, and the commanded motion."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest

from linkwright.geometry.arrays import rotation_matrix
from linkwright.messages import get_message
from linkwright.simulation.server.server import ServerOptions
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import GROUND, box

GAINS = {
    "rollpitchProportionalGain": 10.0,
    "rollpitchDifferentialGain": 5.0,
    "rollpitchLimit": 0.5,
    "yawProportionalGain": 2.0,
    "yawDifferentialGain": 1.0,
    "yawLimit": 1.5,
    "velocityXYProportionalGain": 5.0,
    "velocityXYDifferentialGain": 1.0,
    "velocityXYLimit": 2.0,
    "velocityZProportionalGain": 5.0,
    "velocityZDifferentialGain": 0.5,
}
MASS, GRAVITY = 1.5, 9.81
HECTOR, DRONE = "libhector_gazebo_quadrotor_simple_controller.so", "libplugin_drone.so"
TWIST, EMPTY, BOOL = "geometry_msgs/msg/Twist", "std_msgs/msg/Empty", "std_msgs/msg/Bool"


def quadrotor(filename: str, parameters: str = "", pose: str = "0 0 0.1 0 0 0") -> str:
    gains = "".join(f"<{name}>{gain}</{name}>" for name, gain in GAINS.items())
    plugin = f'<plugin name="pilot" filename="{filename}"><bodyName>link</bodyName>{gains}{parameters}</plugin>'
    return box("uav", pose, size="0.4 0.4 0.2", mass=MASS).replace("</model>", f"{plugin}</model>")


class Pilot:
    """Publishes commands of a quadrotor."""

    def __init__(self, server, graph) -> None:
        self.server, self.graph, self.node = server, graph, graph.create_node("pilot")
        self._publishers: dict = {}

    async def send(self, topic: str, message) -> None:
        if topic not in self._publishers:
            self._publishers[topic] = self.node.create_publisher(type(message), topic, 1)
            await self.graph.settle()
        self._publishers[topic].publish(message)
        await self.graph.settle()

    async def fly(self, linear=(0.0, 0.0, 0.0), angular=(0.0, 0.0, 0.0), seconds: float = 0.0) -> None:
        twist = get_message(TWIST)()
        twist.linear.x, twist.linear.y, twist.linear.z = linear
        twist.angular.x, twist.angular.y, twist.angular.z = angular
        await self.send("cmd_vel", twist)
        self.server.advance(int(seconds * SECOND_NS))

    async def signal(self, topic: str, *, value: bool | None = None) -> None:
        await self.send(topic, get_message(EMPTY)() if value is None else get_message(BOOL)(data=value))

    @property
    def velocity(self) -> np.ndarray:
        return self.server.simulation.link_velocity("uav::link")[0]

    @property
    def wrench(self) -> np.ndarray:
        return self.server.simulation.data.body("uav::link").xfrc_applied.copy()


@pytest.mark.parametrize("filename", [HECTOR, DRONE])
async def test_quadrotor_reaches_commanded_velocity_and_turning_rate(filename):
    async with running_server(GROUND, quadrotor(filename)) as (server, graph, log):
        pilot = Pilot(server, graph)
        if filename == DRONE:
            await pilot.signal("takeoff")
        await pilot.fly((0.0, 0.0, 1.0), seconds=2.0)
        await pilot.fly((0.8, -0.5, 0.3), seconds=6.0)
        assert pilot.velocity == pytest.approx((0.8, -0.5, 0.3), abs=0.05)
        await pilot.fly((0.0, 0.0, 0.0), (0.0, 0.0, 0.5), seconds=6.0)
        assert server.simulation.link_velocity("uav::link")[1] == pytest.approx((0.0, 0.0, 0.5), abs=0.02)
        assert pilot.velocity == pytest.approx((0.0, 0.0, 0.0), abs=0.05)
        assert not [record for record in log if record.node == "gazebo"]


async def test_motors_of_hector_start_with_a_climb_and_by_services():
    async with running_server(GROUND, quadrotor(HECTOR)) as (server, graph, _):
        pilot = Pilot(server, graph)
        await pilot.fly((0.5, 0.0, 0.05), seconds=0.5)
        assert not pilot.wrench.any()
        client = pilot.node.create_client("std_srvs/srv/Empty", "engage")
        request = client.call_async(get_message("std_srvs/srv/Empty_Request")())
        await graph.settle()
        server.advance(SECOND_NS // 10)
        await graph.settle()
        assert request.done()
        assert pilot.wrench[2] == pytest.approx(MASS * GRAVITY, rel=0.1)


async def test_motors_of_hector_stop_on_the_ground():
    async with running_server(GROUND, quadrotor(HECTOR)) as (server, graph, _):
        pilot = Pilot(server, graph)
        await pilot.fly((0.0, 0.0, 0.5), seconds=1.0)
        await pilot.fly((0.0, 0.0, -0.5), seconds=1.0)
        assert pilot.wrench[2] > 0.0
        await pilot.fly((0.0, 0.0, -0.5), seconds=5.0)
        assert not pilot.wrench.any()
        assert server.simulation.link_pose("uav::link")[2] == pytest.approx(0.1, abs=0.01)


async def test_drone_pushes_more_while_it_takes_off_and_less_while_it_lands():
    async with running_server(quadrotor(DRONE, pose="0 0 5 0 0 0"), gravity=f"0 0 -{GRAVITY}") as (server, graph, _):
        pilot = Pilot(server, graph)
        states = Recording(graph, pilot.node, "/state")
        await graph.settle()
        server.advance(SECOND_NS // 100)
        assert not pilot.wrench.any()
        await pilot.signal("takeoff")
        server.advance(SECOND_NS // 10)
        error = -pilot.velocity[2]
        lift = GRAVITY + GAINS["velocityZProportionalGain"] * error
        gain = GAINS["velocityZDifferentialGain"]  # the acceleration, (1.5 lift - g) / (1 + 1.5 gain), reduces the lift
        assert pilot.wrench[2] == pytest.approx(MASS * 1.5 * (lift + gain * GRAVITY) / (1 + 1.5 * gain), rel=0.05)
        await pilot.fly(seconds=3.0)
        assert pilot.wrench[2] == pytest.approx(MASS * GRAVITY, rel=0.02)
        await pilot.signal("land")
        server.advance(SECOND_NS // 1000)
        assert pilot.wrench[2] == pytest.approx(0.8 * MASS * GRAVITY, rel=0.05)
        server.advance(2 * SECOND_NS)
        assert not pilot.wrench.any()
        await graph.settle()
        values = [state.data for state in states]
        assert [value for index, value in enumerate(values) if index == 0 or values[index - 1] != value] == [
            0,
            2,
            1,
            3,
            0,
        ]


async def test_drone_flies_to_a_position():
    gains = (
        "<positionXYProportionalGain>1.1</positionXYProportionalGain>"
        "<positionZProportionalGain>1</positionZProportionalGain>"
    )
    async with running_server(GROUND, quadrotor(DRONE, gains)) as (server, graph, _):
        pilot = Pilot(server, graph)
        await pilot.signal("takeoff")
        await pilot.fly((0.0, 0.0, 0.5), seconds=1.5)
        await pilot.signal("posctrl", value=True)
        await pilot.fly((1.0, -2.0, 3.0), seconds=20.0)
        assert server.simulation.link_pose("uav::link")[:3] == pytest.approx((1.0, -2.0, 3.0), abs=0.1)


@pytest.mark.parametrize("filename", [HECTOR, DRONE])
async def test_force_is_limited(filename):
    limited = quadrotor(filename, "<maxForce>16</maxForce>", pose="0 0 5 0 0 0")
    async with running_server(limited) as (server, graph, _):
        pilot = Pilot(server, graph)
        if filename == DRONE:
            await pilot.signal("takeoff")
        await pilot.fly((0.0, 0.0, 5.0), seconds=1.0)
        assert pilot.wrench[2] == pytest.approx(16.0, rel=0.02)


async def test_true_velocity_is_in_the_axes_of_the_body_and_odometry_in_its_frame():
    yaw = pi / 3
    text = quadrotor(DRONE, "<pub_odom>true</pub_odom>", pose=f"0 0 5 0 0 {yaw}")
    async with running_server(text, gravity="0 0 0") as (server, graph, _):
        node = graph.create_node("listener")
        velocities, odometry = Recording(graph, node, "/gt_vel"), Recording(graph, node, "/odom")
        await graph.settle()
        server.simulation.set_model_velocity("uav", (1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        server.advance(SECOND_NS)
        await graph.settle()
        for twist in (velocities.last, odometry.last.twist.twist):
            assert (twist.linear.x, twist.linear.y) == pytest.approx((cos(yaw), -sin(yaw)), abs=1e-6)
        assert len(odometry) == 30
        assert (odometry.last.header.frame_id, odometry.last.child_frame_id) == ("odom", "base_footprint")


@pytest.mark.parametrize("mistakes", [False, True])
@pytest.mark.parametrize("attitude", ["0 0 0", "0.5 0 0", "0.3 -0.4 1.1"])
async def test_air_resists_the_velocity_of_the_body(attitude, mistakes):
    """The original is right for a level quadrotor alone, and turns velocities the wrong way for others."""
    plugin = '<plugin name="air" filename="libhector_gazebo_quadrotor_aerodynamics.so"/>'
    uav = box("uav", f"0 0 5 {attitude}", mass=MASS).replace("</model>", f"{plugin}</model>")
    options = ServerOptions(gazebo_mistakes=mistakes)
    async with running_server(uav, options=options, gravity="0 0 0") as (server, graph, log):
        wrenches = Recording(graph, server.node, "/aerodynamics/wrench")
        wind = server.node.create_publisher("geometry_msgs/msg/Vector3", "/wind", 1)
        await graph.settle()
        wind.publish(get_message("geometry_msgs/msg/Vector3")(x=1.0, y=-2.0, z=0.5))
        await graph.settle()
        rotation = rotation_matrix(np.array(server.simulation.link_pose("uav::link")[3:]))
        velocity, rates = np.array((4.0, 1.0, -2.0)), np.array((0.3, -0.2, 0.4))
        server.simulation.set_model_velocity("uav", tuple(velocity), tuple(rates))
        server.advance(1_000_000)
        await graph.settle()
        message = wrenches.last
        airspeed = velocity - (1.0, -2.0, 0.5)
        mirror = np.diag((1.0, -1.0, -1.0))
        turn = mirror @ rotation @ mirror if mistakes else rotation.T
        force = -np.array((0.12, 0.12, 0.1)) * np.linalg.norm(airspeed) * (turn @ airspeed)
        torque = -np.array((0.074156208, 0.074156208, 0.050643264)) * np.linalg.norm(rates) * (turn @ rates)
        vectors = (message.wrench.force, message.wrench.torque)
        measured = [(vector.x, vector.y, vector.z) for vector in vectors]
        assert measured == [pytest.approx(force, rel=0.01, abs=2e-3), pytest.approx(torque, rel=0.01, abs=2e-3)]
        assert message.header.frame_id == "link"
        assert not log


async def test_air_slows_a_quadrotor_by_the_square_of_its_speed():
    plugin = '<plugin name="air" filename="libhector_gazebo_quadrotor_aerodynamics.so"/>'
    uav = box("uav", "0 0 5 0 0 0", mass=MASS).replace("</model>", f"{plugin}</model>")
    async with running_server(uav, gravity="0 0 0") as (server, _, __):
        server.simulation.set_model_velocity("uav", (10.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        server.advance(2 * SECOND_NS)
        velocity = server.simulation.link_velocity("uav::link")[0][0]
        assert velocity == pytest.approx(10.0 / (1.0 + 0.12 * 10.0 * 2.0 / MASS), rel=1e-3)
