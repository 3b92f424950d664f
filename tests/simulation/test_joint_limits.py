"""Pushes on joints, bounded by the joints' effort and velocity limits."""

from __future__ import annotations

from math import asin, inf

import pytest

from linkwright.messages import get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.simulation import Simulation
from tests.simulation.test_plugins import running_server
from tests.simulation.worlds import make_simulation

COMMAND = "/bob"
CONTROLLER = (
    '<plugin filename="gz-sim-joint-position-controller-system" name="gz::sim::systems::JointPositionController">'
    "<joint_name>turn</joint_name><topic>bob</topic><p_gain>1000</p_gain><i_gain>0</i_gain><d_gain>50</d_gain></plugin>"
)
MOTOR = (
    '<plugin filename="gz-sim-joint-controller-system" name="gz::sim::systems::JointController">'
    "<joint_name>turn</joint_name><initial_velocity>4</initial_velocity></plugin>"
)


def arm_model(limit: str, plugin: str = "", axis: str = "0 1 0", extra: str = "") -> str:
    """Return a link of 1 kg, 1 m from its axis."""
    inertia = "<inertia><ixx>1e-3</ixx><iyy>1e-3</iyy><izz>1e-3</izz></inertia>"
    return (
        '<model name="arm"><pose>0 0 3 0 0 0</pose><link name="base"/>'
        f'<link name="bob"><pose>0 0 -1 0 0 0</pose><inertial><mass>1</mass>{inertia}</inertial></link>'
        '<joint name="post" type="fixed"><parent>world</parent><child>base</child></joint>'
        '<joint name="turn" type="revolute"><pose>0 0 1 0 0 0</pose><parent>base</parent><child>bob</child>'
        f"<axis><xyz>{axis}</xyz><limit><lower>-100</lower><upper>100</upper>{limit}</limit>{extra}</axis></joint>"
        f"{plugin}</model>"
    )


def with_range(lower: float, upper: float) -> str:
    """Return the model with these limits of the position in rad."""
    wide = "<lower>-100</lower><upper>100</upper>"
    return arm_model("").replace(wide, f"<lower>{lower}</lower><upper>{upper}</upper>")


def speed_when_pushed(simulation: Simulation, force: float, seconds: float = 0.5) -> float:
    for _ in range(round(seconds * 1000)):
        simulation.push_joint("arm::turn", force)
        simulation.advance(NANOSECONDS_PER_SECOND // 1000)
    return simulation.joint_state("arm::turn")[1]


async def test_controller_effort_is_limited():
    async with running_server(
        arm_model("<effort>5</effort>", CONTROLLER, extra="<dynamics><damping>5</damping></dynamics>")
    ) as (
        server,
        graph,
        _,
    ):
        node = graph.create_node("operator")
        node.create_publisher(get_message("std_msgs/msg/Float64"), COMMAND, 10).publish(
            get_message("std_msgs/msg/Float64")(data=1.5)
        )
        await graph.settle()
        server.advance(4 * NANOSECONDS_PER_SECOND)
        assert server.simulation.joint_state("arm::turn")[0] == pytest.approx(asin(5 / 9.81), abs=0.02)


@pytest.mark.parametrize("force", [3.0, -3.0])
def test_push_is_limited_by_joint_effort(force: float):
    simulation = make_simulation(arm_model("<effort>2</effort>"), gravity="0 0 0")
    expected = 2.0 * 0.5 / 1.001
    assert abs(speed_when_pushed(simulation, force)) == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("force", [2.0, 100.0, 1e5, -1e5])
def test_push_stops_at_joint_velocity_limit(force: float):
    simulation = make_simulation(arm_model("<velocity>0.8</velocity>"), gravity="0 0 0")
    assert abs(speed_when_pushed(simulation, force)) == pytest.approx(0.8, rel=0.01)


def test_joint_above_velocity_limit_is_not_braked():
    simulation = make_simulation(arm_model("<velocity>0.8</velocity>"), gravity="0 0 0")
    simulation.data.joint("arm::turn").qvel[0] = 3.0
    simulation.mark_moved()
    assert speed_when_pushed(simulation, 5.0, 0.1) == pytest.approx(3.0)
    assert speed_when_pushed(simulation, -5.0, 0.1) == pytest.approx(2.5, rel=0.01)


@pytest.mark.parametrize(
    "limit", ["", "<effort>0</effort><velocity>0</velocity>", "<effort>-1</effort><velocity>-1</velocity>"]
)
def test_nonpositive_limits_are_ignored(limit: str):
    simulation = make_simulation(arm_model(limit), gravity="0 0 0")
    assert speed_when_pushed(simulation, 10.0) == pytest.approx(5.0, rel=0.01)


@pytest.mark.parametrize("gravity", ["0 0 0", "-9.81 0 0"])
def test_joint_with_equal_limits_does_not_move(gravity: str):
    simulation = make_simulation(with_range(0.0, 0.0), gravity=gravity)
    assert speed_when_pushed(simulation, 2.0) == pytest.approx(0.0, abs=1e-6)
    assert simulation.joint_state("arm::turn")[0] == pytest.approx(0.0, abs=1e-3)
    assert speed_when_pushed(simulation, -2.0) == pytest.approx(0.0, abs=1e-6)
    assert simulation.joint_state("arm::turn")[0] == pytest.approx(0.0, abs=1e-3)


def test_joint_with_equal_limits_goes_to_them():
    simulation = make_simulation(with_range(0.3, 0.3), gravity="0 0 0")
    speed_when_pushed(simulation, 0.0, 2.0)
    assert simulation.joint_state("arm::turn") == pytest.approx((0.3, 0.0), abs=1e-3)


def test_limits_in_wrong_order_are_ignored():
    simulation = make_simulation(with_range(0.1, -0.1), gravity="0 0 0")
    assert speed_when_pushed(simulation, 10.0) == pytest.approx(5.0, rel=0.01)


@pytest.mark.parametrize(("velocity", "expected"), [(1.5, 1.5), (inf, 4.0)])
async def test_gz_motor_respects_joint_velocity_limit(velocity: float, expected: float):
    limit = f"<velocity>{velocity}</velocity>"
    async with running_server(arm_model(limit, MOTOR, axis="0 0 1")) as (server, _, _log):
        server.advance(NANOSECONDS_PER_SECOND)
        assert server.simulation.joint_state("arm::turn")[1] == pytest.approx(expected, rel=0.01)
