"""Servos: joints that follow moving targets."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.actuators import Servo
from linkwright.simulation.simulation import Simulation
from tests.simulation.worlds import make_simulation, model

_PERIOD_S = 0.01
_ARM = """<model name="arm"><link name="base"/>
  <joint name="fix" type="fixed"><parent>world</parent><child>base</child></joint>
  <link name="bar"><pose>0.3 0 0 0 0 0</pose><inertial><mass>2</mass>
    <inertia><ixx>0.01</ixx><iyy>0.06</iyy><izz>0.06</izz></inertia></inertial></link>
  <joint name="turn" type="revolute"><parent>base</parent><child>bar</child><pose>-0.3 0 0 0 0 0</pose>
    <axis><xyz>0 1 0</xyz><limit><lower>-9</lower><upper>9</upper><velocity>4</velocity></limit></axis></joint>
</model>"""


@pytest.fixture
def simulation() -> Simulation:
    return make_simulation(_ARM)


def follow(simulation: Simulation, servo: Servo, targets: np.ndarray) -> np.ndarray:
    """Return the position of the joint at the end of each period, in which it moves to a target."""
    positions = []
    for target in targets.tolist():
        servo.move(target, _PERIOD_S)
        simulation.advance(int(_PERIOD_S * NANOSECONDS_PER_SECOND))
        positions.append(simulation.joint_state("arm::turn")[0])
    return np.array(positions)


def test_joint_does_not_lag_behind_a_target_that_moves_steadily(simulation) -> None:
    servo = simulation.add_servo("arm::turn", 10.0)
    times = np.arange(1, 101) * _PERIOD_S
    positions = follow(simulation, servo, 2.0 * times)
    assert np.abs(positions - 2.0 * times)[20:].max() < 0.002


def test_joint_follows_a_smooth_motion(simulation) -> None:
    servo = simulation.add_servo("arm::turn", 10.0)
    times = np.arange(1, 201) * _PERIOD_S
    targets = 1.0 - np.cos(np.pi * times)
    errors = np.abs(follow(simulation, servo, targets) - targets)
    assert errors.max() < 0.01
    assert np.abs(follow(simulation, servo, np.full(20, targets[-1])) - targets[-1])[-1] < 0.001


@pytest.mark.parametrize("speed", [10.0, 1.0])
def test_joint_does_not_overshoot_a_target_that_jumps(simulation, speed: float) -> None:
    servo = simulation.add_servo("arm::turn", speed)
    positions = follow(simulation, servo, np.ones(150))
    assert positions.max() < 1.001
    assert positions[-1] == pytest.approx(1.0, abs=0.001)


def test_friction_holds_no_light_joint_beside_its_target() -> None:
    light = _ARM.replace("<iyy>0.06</iyy>", "<iyy>0.001</iyy>").replace("0.3 0 0 0 0 0", "0 0 0 0 0 0")
    simulation = make_simulation(light.replace("</axis>", "<dynamics><friction>1</friction></dynamics></axis>"))
    simulation.keep_awake("arm::bar")
    servo = simulation.add_servo("arm::turn", 10.0)
    positions = follow(simulation, servo, np.minimum(2.0 * np.arange(1, 101) * _PERIOD_S, 1.0))
    assert positions[-1] == pytest.approx(1.0, abs=0.001)
    assert not simulation.model.dof_frictionloss.any()
    servo.release()
    assert simulation.model.dof_frictionloss.tolist() == [1.0]


@pytest.mark.parametrize("change", ["spawn", "delete"])
def test_joints_stay_where_they_are_held_when_the_world_changes(simulation, change: str) -> None:
    servo, motor = simulation.add_servo("arm::turn", 10.0), simulation.add_velocity_motor("arm::turn", 20.0, 10.0)
    other = model("<model name='other'><static>true</static><link name='l'/></model>")
    if change == "delete":
        simulation.spawn(other, "other")
    motor.release()
    follow(simulation, servo, np.minimum(2.0 * np.arange(1, 101) * _PERIOD_S, 1.0))
    revision = simulation.revision
    simulation.spawn(other, "other") if change == "spawn" else simulation.delete("other")
    for _ in range(20):
        simulation.advance(simulation.step)
        assert simulation.joint_state("arm::turn")[0] == pytest.approx(1.0, abs=0.001)
    assert simulation.revision > revision
    servo.release()
    simulation.advance(NANOSECONDS_PER_SECOND // 10)
    assert simulation.joint_state("arm::turn")[1] > 1.0, "the motor is still released, so that the bar falls"
