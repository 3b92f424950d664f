"""Plugins of RotorS: commands, speeds, IMU, odometry and wind."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server

ACTUATORS = "actuator_msgs/msg/Actuators"
CONSTANT = 8.54858e-06


def plugin(library: str, parameters: str = "", name: str = "p") -> str:
    return f'<plugin name="{name}" filename="librotors_gazebo_{library}.so">{parameters}</plugin>'


def firefly(*plugins: str, pose: str = "0 0 2 0 0 0", mass: float = 1e6) -> str:
    """Return a model with a rotor, which does not accelerate much if it is heavy."""
    inertia = f"<ixx>{mass}</ixx><iyy>{mass}</iyy><izz>{mass}</izz>"
    return (
        f'<model name="firefly"><pose>{pose}</pose><link name="base_link"><inertial><mass>{mass}</mass>'
        f'<inertia>{inertia}</inertia></inertial></link><link name="rotor_0"><inertial><mass>0.005</mass>'
        "<inertia><ixx>1e-5</ixx><iyy>1e-5</iyy><izz>1e-5</izz></inertia></inertial></link>"
        '<joint name="rotor_0_joint" type="revolute"><parent>base_link</parent><child>rotor_0</child>'
        f"<axis><xyz>0 0 1</xyz></axis></joint>{''.join(plugins)}</model>"
    )


MOTOR = plugin(
    "motor_model",
    "<jointName>rotor_0_joint</jointName><linkName>rotor_0</linkName><rotorDragCoefficient>1e-4</rotorDragCoefficient>",
    "motor",
)


async def test_commands_pass_through_the_controller_interface_to_the_motors():
    model = firefly(plugin("controller_interface", name="interface"), MOTOR, plugin("multirotor_base_plugin", name="b"))
    async with running_server(model, gravity="0 0 0") as (server, graph, log):
        speeds = Recording(graph, server.node, "/firefly/motor_speed")
        states = Recording(graph, server.node, "/firefly/joint_states")
        publisher = graph.create_node("pilot").create_publisher(ACTUATORS, "/firefly/command/motor_speed", 10)
        publisher.publish(get_message(ACTUATORS)(velocity=[500.0]))
        await graph.settle()
        server.advance(SECOND_NS // 10)
        await graph.settle()
        server.advance(SECOND_NS)
        await graph.settle()
        force = server.simulation.data.xfrc_applied[server.simulation.body("firefly::rotor_0")][2]
        assert force == pytest.approx(CONSTANT * 500.0**2, rel=1e-3)
        assert speeds.last.velocity == pytest.approx([500.0], rel=0.01)
        assert states.last.name == ["rotor_0_joint"]
        assert not log, [record.text for record in log]


async def test_imu_has_the_noise_of_its_defaults():
    model = firefly(plugin("imu_plugin", "<linkName>base_link</linkName>"))
    async with running_server(model, gravity="0 0 0") as (server, graph, log):
        recording = Recording(graph, server.node, "/firefly/imu")
        server.advance(2 * SECOND_NS)
        await graph.settle()
        rates = np.array([message.angular_velocity.x for message in recording])
        assert len(rates) > 1000
        assert rates.std() == pytest.approx(70.0 / 3600 * np.pi / 180 * 1000**0.5, rel=0.1)
        assert not log, [record.text for record in log]


async def test_odometry_is_published_as_five_types_with_noise_and_delay():
    parameters = (
        "<linkName>base_link</linkName><noiseNormalPosition>0.1 0 0</noiseNormalPosition>"
        "<noiseUniformLinearVelocity>0 0.5 0</noiseUniformLinearVelocity><measurementDelay>20</measurementDelay>"
        "<measurementDivisor>10</measurementDivisor>"
    )
    model = firefly(plugin("odometry_plugin", parameters), pose="1 2 3 0 0 1.5707963")
    async with running_server(model, gravity="0 0 0") as (server, graph, log):
        recordings = {
            name: Recording(graph, server.node, f"/firefly/{name}")
            for name in ("odometry", "pose", "pose_with_covariance", "position", "transform")
        }
        server.simulation.set_model_velocity("firefly", (0.0, 0.5, 0.0), (0.0, 0.0, 0.0))
        server.advance(5 * SECOND_NS)
        await graph.settle()
        odometry = list(recordings["odometry"])
        assert len(odometry) == pytest.approx(500, abs=5)
        xs = np.array([message.pose.pose.position.x for message in odometry])
        assert (xs.mean(), xs.std()) == pytest.approx((1.0, 0.1), rel=0.15)
        sides = np.array([message.twist.twist.linear.y for message in odometry])
        assert abs(sides).max() == pytest.approx(0.5, abs=0.02)
        last = odometry[-1]
        assert last.twist.twist.linear.x == pytest.approx(0.5, abs=1e-3)
        assert (last.header.frame_id, last.child_frame_id) == ("world", "odometry_sensor")
        assert last.pose.covariance[0] == pytest.approx(0.01)
        assert 5.0 - (last.header.stamp.sec + last.header.stamp.nanosec / 1e9) >= 0.02 - 1e-9
        assert recordings["pose"].last.pose == last.pose.pose
        assert recordings["pose_with_covariance"].last.pose == last.pose
        assert recordings["position"].last.point == last.pose.pose.position
        assert recordings["transform"].last.transform.translation.z == pytest.approx(3.0, abs=1e-3)
        assert not log, [record.text for record in log]


async def test_wind_and_gust_push_the_link_and_move_the_air():
    parameters = (
        "<linkName>base_link</linkName><xyzOffset>0 0 1</xyzOffset><windForceMean>2</windForceMean>"
        "<windDirection>0 3 0</windDirection><windSpeedMean>4</windSpeedMean><windGustStart>1</windGustStart>"
        "<windGustDuration>1</windGustDuration><windGustForceMean>5</windGustForceMean>"
        "<windGustDirection>1 0 0</windGustDirection><windForceVariance>0</windForceVariance>"
    )
    async with running_server(firefly(plugin("wind_plugin", parameters)), gravity="0 0 0") as (server, graph, log):
        forces = Recording(graph, server.node, "/firefly/external_force")
        speeds = Recording(graph, server.node, "/firefly/wind_speed")
        server.advance(SECOND_NS // 2)
        body = server.simulation.body("firefly::base_link")
        assert server.simulation.data.xfrc_applied[body] == pytest.approx((0, 2, 0, -2, 0, 0), abs=1e-3)
        assert server.simulation.wind == pytest.approx((0.0, 4.0, 0.0))
        server.advance(SECOND_NS)
        await graph.settle()
        assert server.simulation.data.xfrc_applied[body][:3] == pytest.approx((5, 2, 0))
        assert forces.last.wrench.force.x == pytest.approx(5.0)
        assert speeds.last.vector.y == pytest.approx(4.0)
        assert not log, [record.text for record in log]


async def test_wind_slows_a_rotor_of_rotors():
    wind = plugin("wind_plugin", "<windSpeedMean>6</windSpeedMean>", "wind")
    async with running_server(firefly(wind, MOTOR), gravity="0 0 0") as (server, graph, _):
        publisher = graph.create_node("pilot").create_publisher(ACTUATORS, "/firefly/gazebo/command/motor_speed", 10)
        publisher.publish(get_message(ACTUATORS)(velocity=[500.0]))
        await graph.settle()
        server.advance(SECOND_NS)
        force = server.simulation.data.xfrc_applied[server.simulation.body("firefly::rotor_0")]
        assert force[0] == pytest.approx(1e-4 * 500.0 * 6.0, rel=1e-2)


async def test_wind_field_in_a_file_is_refused_with_what_to_do():
    parameters = "<useCustomStaticWindField>true</useCustomStaticWindField>"
    async with running_server(firefly(plugin("wind_plugin", parameters))) as (_, __, log):
        assert "set <useCustomStaticWindField> to false" in log[0].text
