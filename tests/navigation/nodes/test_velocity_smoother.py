"""velocity_smoother: limits of speed and acceleration, timeouts, and the lifecycle."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.messages import get_message
from linkwright.navigation.nodes.velocity_smoother import VelocitySmoother
from linkwright.navigation.nodes.velocity_smoothing import AxisLimits, smooth_velocities
from linkwright.nodes import NodeOptions
from tests.remote_publishers import RemotePublisher, RemoteTransport

TWIST, STAMPED = get_message("geometry_msgs/msg/Twist"), get_message("geometry_msgs/msg/TwistStamped")
ODOMETRY = get_message("nav_msgs/msg/Odometry")

velocities = st.floats(-3.0, 3.0)
LIMITS = [AxisLimits(-0.5, 0.5, 2.5, -2.0), AxisLimits(-1.0, 1.0, 0.0, 0.0), AxisLimits(-2.5, 2.5, 3.2, -3.0)]


@given(target=st.tuples(*[velocities] * 3), current=st.tuples(*[st.floats(-0.5, 0.5)] * 3), scaled=st.booleans())
def test_velocity_and_acceleration_limits_hold_on_each_axis(target, current, scaled):
    smoothed = smooth_velocities(LIMITS, current, target, 0.05, keep_direction=scaled)
    for limits, old, velocity, goal in zip(LIMITS, current, smoothed, target, strict=True):
        assert abs(velocity - old) <= limits.compute_max_change(old, limits.clamp(goal), 0.05) + 1e-12
        assert min(old, limits.min_velocity) - 1e-12 <= velocity <= max(old, limits.max_velocity) + 1e-12


def test_keep_direction_scales_all_axes():
    limits = [AxisLimits(-1, 1, 1.0, -1.0), AxisLimits(-1, 1, 4.0, -4.0)]
    assert smooth_velocities(limits, (0, 0), (1.0, 1.0), 0.1, keep_direction=True) == pytest.approx([0.1, 0.1])
    assert smooth_velocities(limits, (0, 0), (1.0, 1.0), 0.1, keep_direction=False) == pytest.approx([0.1, 0.4])


class SmootherHarness:
    """A velocity smoother with a publisher of commands, and the velocities that it publishes."""

    def __init__(self, harness, message_type=TWIST, **parameters):
        self.harness, self.message_type, self.published = harness, message_type, []
        harness.node.create_subscription(message_type, "/cmd_vel_smoothed", self.published.append, 100)
        self.publisher = harness.node.create_publisher(message_type, "/cmd_vel", 10)
        self.odometry = harness.node.create_publisher(ODOMETRY, "/odom", 10)
        self.node = VelocitySmoother(harness.graph, NodeOptions(parameters={"autostart_node": True, **parameters}))

    async def send(self, x, yaw=0.0):
        message = self.message_type()
        twist = getattr(message, "twist", message)
        twist.linear.x, twist.angular.z = x, yaw
        self.publisher.publish(message)
        await self.harness.graph.settle()

    def speeds(self):
        return [round(getattr(message, "twist", message).linear.x, 6) for message in self.published]


@pytest.fixture
async def start_smoother(harness):
    harnesses = []

    def start(**arguments):
        harnesses.append(SmootherHarness(harness, **arguments))
        return harnesses[-1]

    yield start
    for smoother in harnesses:
        smoother.node.close()


async def test_step_command_becomes_ramp_within_limits(start_smoother, harness):
    smoother = start_smoother()
    await smoother.send(0.8)
    await harness.clock.advance(0.3)
    assert smoother.speeds() == [0.125, 0.25, 0.375, 0.5, 0.5, 0.5]


async def test_command_ends_after_velocity_timeout(start_smoother, harness, logged):
    smoother = start_smoother(velocity_timeout=0.2)
    await smoother.send(0.25)
    await harness.clock.advance(2.0)
    assert smoother.speeds() == [0.125, 0.25, 0.25, 0.25, 0.125, 0.0]
    assert logged("INFO")[-1:] == [
        "no command was received for 0.2 s (velocity_timeout), and the last one was not a stop, so the robot is stopped"
    ]


async def test_timeout_after_stop_command_is_not_logged(start_smoother, harness, logged):
    smoother = start_smoother(velocity_timeout=0.2)
    await smoother.send(0.25)
    await harness.clock.advance(0.1)
    await smoother.send(0.0)
    await harness.clock.advance(2.0)
    assert not [text for text in logged("INFO") if "velocity_timeout" in text]


async def test_lost_command_publisher_stops_robot_and_is_reported(start_smoother, harness, logged):
    smoother = start_smoother(velocity_timeout=10.0, enable_stamped_cmd_vel=False)
    driver = RemotePublisher(RemoteTransport(harness.graph), "/cmd_vel")
    message = TWIST()
    message.linear.x = 0.25
    driver.send(message)
    await harness.clock.advance(0.2)
    driver.disappear()
    await harness.clock.advance(1.0)
    assert smoother.speeds()[3] == 0.25
    assert smoother.speeds()[-1] == 0.0
    assert logged("WARN") == [
        (
            "'/driver', which sent the commands on '/cmd_vel', was lost (killed, crashed or out of reach); "
            "the robot is stopped"
        )
    ]


async def test_velocities_within_deadband_are_zero(start_smoother, harness):
    smoother = start_smoother(deadband_velocity=[0.2, 0.0, 0.0])
    await smoother.send(0.3)
    await harness.clock.advance(0.15)
    assert smoother.speeds() == [0.0, 0.25, 0.3]


async def test_closed_loop_starts_from_measured_velocity(start_smoother, harness):
    smoother = start_smoother(feedback="CLOSED_LOOP")
    message = ODOMETRY()
    message.twist.twist.linear.x = 0.2
    smoother.odometry.publish(message)
    await smoother.send(0.5)
    await harness.clock.advance(0.06)
    assert smoother.speeds() == [0.325]


async def test_six_axes_may_be_limited(start_smoother, harness):
    axis_parameters = {name: [sign] * 6 for name, sign in (("max_velocity", 1.0), ("min_velocity", -1.0))}
    axis_parameters |= {"max_accel": [2.0] * 6, "max_decel": [-2.0] * 6, "deadband_velocity": [0.0] * 6}
    smoother = start_smoother(**axis_parameters)
    await smoother.send(1.0, 1.0)
    await harness.clock.advance(0.06)
    assert (smoother.published[0].linear.x, smoother.published[0].angular.z) == pytest.approx((0.1, 0.1))


@pytest.mark.parametrize("message_type", [TWIST, STAMPED])
async def test_twist_and_twist_stamped_pass_without_warning(start_smoother, harness, logged, message_type):
    smoother = start_smoother(message_type=message_type)
    await smoother.send(0.5)
    await harness.clock.advance(0.06)
    assert smoother.speeds() == [0.125]
    assert logged("WARN") == []


async def test_nan_commands_are_ignored_with_error(start_smoother, harness, logged):
    smoother = start_smoother()
    await smoother.send(float("nan"))
    await harness.clock.advance(0.5)
    assert smoother.published == []
    assert "NaNs" in logged("ERROR")[0]


async def test_velocity_smoother_is_a_managed_node(start_smoother, harness):
    smoother = start_smoother(autostart_node=False)
    await smoother.send(0.5)
    await harness.clock.advance(0.5)
    assert smoother.published == []
    node = smoother.node.node
    node.trigger_configure()
    node.trigger_activate()
    await smoother.send(0.5)
    await harness.clock.advance(0.21)
    assert smoother.speeds()[-1] == 0.5
    node.trigger_deactivate()
    await harness.clock.advance(1.0)
    assert smoother.speeds()[-1] == 0.0
    node.trigger_cleanup()
    assert "/cmd_vel_smoothed" not in {
        endpoint.name for endpoint in harness.graph.endpoints() if endpoint.node.name != "test_node"
    }


@pytest.mark.parametrize(
    ("invalid_parameters", "text"),
    [
        ({"max_decel": [2.5, 0.0, 3.2]}, "max_decel must not be positive"),
        ({"max_velocity": [0.5]}, "3 entries"),
        ({"feedback": "SOMETIMES"}, "OPEN_LOOP or CLOSED_LOOP, but it is 'SOMETIMES'"),
        ({"smoothing_frequency": 0.0}, "smoothing_frequency must be more than 0"),
    ],
)
async def test_invalid_parameters_are_reported(start_smoother, logged, invalid_parameters, text):
    start_smoother(autostart_node=False, **invalid_parameters).node.node.trigger_configure()
    assert text in logged("ERROR")[0]


async def test_parameters_can_change_at_runtime(start_smoother, harness):
    smoother = start_smoother()
    assert await harness.set(smoother.node, max_velocity=[0.25, 0.0, 1.0]) == [(True, "")]
    await smoother.send(0.5)
    await harness.clock.advance(0.3)
    assert smoother.speeds()[-1] == 0.25
    ((successful, reason),) = await harness.set(smoother.node, max_accel=[-1.0, 0.0, 0.0])
    assert not successful
    assert reason == "max_accel must not be negative"
