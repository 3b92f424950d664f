"""Wheels whose slip grows with the force on them."""

from __future__ import annotations

import pytest

from linkwright.messages import get_message
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import GROUND

WHEEL_RADIUS, SPIN_RAD_S, PUSHING_FORCE_N, NORMAL_FORCE_N = 0.2, 10.0, 20.0, 98.1
"""A wheel in m and rad/s, and forces in N."""


def _slide(name: str, parent: str, axis: str) -> str:
    """Return a light link that slides along an axis."""
    return (
        f'<link name="{name}"><pose>0 0 {WHEEL_RADIUS} 0 0 0</pose><inertial><mass>0.01</mass></inertial></link>'
        f'<joint name="{name}_joint" type="prismatic"><parent>{parent}</parent><child>{name}</child><axis>'
        f"<xyz>{axis}</xyz></axis></joint>"
    )


def unicycle_model(
    lateral: float, longitudinal: float, filename: str = "gz-sim-wheel-slip-system", extra: str = ""
) -> str:
    """Return a wheel of 10 kg that stays upright, with a motor."""
    parts = _slide("along", "world", "1 0 0") + _slide("across", "along", "0 1 0") + _slide("up", "across", "0 0 1")
    slip = (
        f'<plugin name="slip" filename="{filename}"><wheel link_name="wheel"><slip_compliance_lateral>{lateral}'
        f"</slip_compliance_lateral><slip_compliance_longitudinal>{longitudinal}</slip_compliance_longitudinal>"
        f"<wheel_normal_force>{NORMAL_FORCE_N}</wheel_normal_force><wheel_radius>{WHEEL_RADIUS}</wheel_radius></wheel>{extra}"
        "</plugin>"
    )
    motor = (
        '<plugin name="motor" filename="gz-sim-joint-controller-system"><joint_name>hub</joint_name>'
        f"<initial_velocity>{SPIN_RAD_S}</initial_velocity></plugin>"
    )
    return (
        f'<model name="unicycle">{parts}<link name="wheel"><pose>0 0 {WHEEL_RADIUS} 0 0 0</pose>'
        "<inertial><mass>9.97</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>"
        f"<collision name='c'><geometry><sphere><radius>{WHEEL_RADIUS}</radius></sphere></geometry></collision></link>"
        "<joint name='hub' type='revolute'><parent>up</parent><child>wheel</child><axis><xyz>0 1 0</xyz></axis></joint>"
        f"{slip}{motor}</model>"
    )


def pushing_plugin(force: str) -> str:
    return (
        '<plugin name="push" filename="gz-sim-apply-link-wrench-system"><persistent>'
        f"<entity_name>unicycle::up</entity_name><entity_type>link</entity_type><force>{force}</force></persistent></plugin>"
    )


async def measure_velocity(*parts: str, seconds: float = 2.0) -> tuple[float, float]:
    """Return the velocity of the wheel forward and to the left.

    It is relative to the speed of the wheel's surface.
    """
    async with running_server(GROUND, *parts) as (server, _, log):
        server.advance(round(seconds * SECOND_NS))
        x, y, _ = server.simulation.link_velocity("unicycle::up")[0]
        assert not log
        speed = WHEEL_RADIUS * server.simulation.joint_state("unicycle::hub")[1]
        return x / speed, y / speed


@pytest.mark.parametrize("filename", ["gz-sim-wheel-slip-system", "libWheelSlipPlugin.so"])
async def test_slip_ratio_is_compliance_times_force_ratio(filename):
    ratio = PUSHING_FORCE_N / NORMAL_FORCE_N
    for compliance in (0.0, 0.5, 1.0):
        forward, left = await measure_velocity(
            unicycle_model(0.0, compliance, filename), pushing_plugin(f"-{PUSHING_FORCE_N} 0 0")
        )
        assert forward == pytest.approx(1.0 - compliance * ratio, rel=0.01)
        assert left == pytest.approx(0.0, abs=0.01)
        forward, left = await measure_velocity(
            unicycle_model(compliance, 0.0, filename), pushing_plugin(f"0 {PUSHING_FORCE_N} 0")
        )
        assert left == pytest.approx(compliance * ratio, rel=0.02, abs=0.01)
        assert forward == pytest.approx(1.0, rel=0.01)


async def test_wheel_that_does_not_turn_does_not_slip():
    text = unicycle_model(1.0, 1.0).replace(f"<initial_velocity>{SPIN_RAD_S}", "<initial_velocity>0")
    async with running_server(GROUND, text, pushing_plugin(f"0 {PUSHING_FORCE_N} 0")) as (server, _, __):
        server.advance(SECOND_NS)
        assert server.simulation.link_velocity("unicycle::up")[0] == pytest.approx((0.0, 0.0, 0.0), abs=0.01)


async def test_slips_are_published_and_parameters_change_compliances():
    text = unicycle_model(0.0, 0.5, "libgazebo_ros_wheel_slip.so")
    async with running_server(GROUND, text, pushing_plugin(f"-{PUSHING_FORCE_N} 0 0")) as (server, graph, log):
        recording = Recording(graph, server.node, "/wheel_slip")
        server.advance(2 * SECOND_NS)
        await graph.settle()
        message = recording.last
        assert len(recording) == 200
        assert list(message.name) == ["wheel"]
        assert message.longitudinal_slip[0] == pytest.approx(0.5 * PUSHING_FORCE_N / NORMAL_FORCE_N, rel=0.05)
        assert message.lateral_slip[0] == pytest.approx(0.0, abs=0.01)
        client = graph.create_node("operator").create_client("rcl_interfaces/srv/SetParameters", "/slip/set_parameters")
        for name, value in (
            ("slip_compliance_unitless_longitudinal", 1.0),
            ("slip_compliance_unitless_longitudinal/wheel", 0.25),
        ):
            parameter = get_message("rcl_interfaces/msg/Parameter")(name=name)
            parameter.value.type, parameter.value.double_value = 3, value
            client.call_async(client.srv_type.Request(parameters=[parameter]))
            await graph.settle()
            server.advance(2 * SECOND_NS)
            await graph.settle()
            assert recording.last.longitudinal_slip[0] == pytest.approx(
                value * PUSHING_FORCE_N / NORMAL_FORCE_N, rel=0.05
            )
        assert not log


async def test_wheel_without_normal_force_and_missing_wheel_are_reported():
    text = unicycle_model(0.0, 0.5).replace(f"<wheel_normal_force>{NORMAL_FORCE_N}</wheel_normal_force>", "")
    async with running_server(GROUND, text) as (_, __, log):
        assert any("the wheel 'wheel' needs a joint, and a <wheel_radius>" in record.text for record in log)
    text = unicycle_model(0.0, 0.5).replace('<wheel link_name="wheel">', "<tire>").replace("</wheel>", "</tire>")
    async with running_server(GROUND, text) as (_, __, log):
        assert any("<wheel> is missing" in record.text for record in log)
