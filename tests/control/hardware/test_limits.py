"""Limits of joints, applied to their commands."""

from __future__ import annotations

from math import inf, nan

import pytest

from linkwright.control.hardware.interfaces import (
    ACCELERATION,
    EFFORT,
    POSITION,
    VELOCITY,
    CommandInterface,
    StateInterface,
)
from linkwright.control.hardware.limits import JointLimiter, JointLimits
from linkwright.control.manager.switching import STRICT
from linkwright.urdf.model import Safety
from tests.control.robots import joint, make_manager, robot

KINDS = frozenset((POSITION, VELOCITY, EFFORT, ACCELERATION))
FORWARD = "forward_command_controller/ForwardCommandController"


class LimitedJoint:
    """A joint with one command; its states do not follow the command."""

    def __init__(self, kind: str, states: dict[str, float] | None = None, **limits) -> None:
        self.command = CommandInterface("hip", kind)
        self.states = {
            interface: StateInterface("hip", interface, value) for interface, value in (states or {}).items()
        }
        self.limiter = JointLimiter("hip", JointLimits(kinds=KINDS, **limits), {kind: self.command}, self.states)

    def send(self, value: float, period_s: float = 0.1) -> float:
        """Return the limited command."""
        self.command.value = value
        self.limiter.enforce(period_s, {self.command.name})
        return self.command.value


def test_position_commands_respect_position_and_velocity_limits():
    hip = LimitedJoint(POSITION, {POSITION: 0.0}, position=(-1.0, 0.35), velocity=2.0)
    assert [hip.send(5.0) for _ in range(3)] == pytest.approx([0.2, 0.35, 0.35])
    assert [hip.send(-5.0) for _ in range(2)] == pytest.approx([0.15, -0.05])
    assert hip.send(-0.1) == -0.1


def test_joint_beyond_limit_returns_at_velocity_limit():
    hip = LimitedJoint(POSITION, {POSITION: 1.0}, position=(-0.5, 0.5), velocity=1.0)
    assert [hip.send(3.0) for _ in range(6)] == pytest.approx([0.9, 0.8, 0.7, 0.6, 0.5, 0.5])


def test_velocity_commands_respect_all_limits():
    wheel = LimitedJoint(VELOCITY, velocity=1.0, acceleration=4.0, deceleration=8.0)
    wheel.send(0.0)
    assert [wheel.send(5.0) for _ in range(4)] == pytest.approx([0.4, 0.8, 1.0, 1.0])
    assert [wheel.send(-5.0) for _ in range(4)] == pytest.approx([0.2, -0.6, -1.0, -1.0])
    hip = LimitedJoint(VELOCITY, {POSITION: 0.95}, position=(-1.0, 1.0), velocity=1.0)
    assert hip.send(1.0) == pytest.approx(0.5)
    hip.states[POSITION].value = 1.1
    assert (hip.send(1.0), hip.send(-1.0)) == (0.0, -1.0)


def test_effort_commands_do_not_push_beyond_limits():
    hip = LimitedJoint(EFFORT, {POSITION: 0.0, VELOCITY: 0.0}, position=(-1.0, 1.0), velocity=2.0, effort=10.0)
    assert (hip.send(50.0), hip.send(-50.0), hip.send(3.0)) == (10.0, -10.0, 3.0)
    hip.states[POSITION].value = 1.0
    assert (hip.send(5.0), hip.send(-5.0)) == (0.0, -5.0)
    hip.states[POSITION].value, hip.states[VELOCITY].value = 0.0, -2.5
    assert (hip.send(5.0), hip.send(-5.0)) == (5.0, 0.0)


def test_acceleration_and_deceleration_have_separate_limits():
    hip = LimitedJoint(ACCELERATION, {VELOCITY: 1.0}, acceleration=2.0, deceleration=5.0)
    assert (hip.send(9.0), hip.send(-9.0)) == (2.0, -5.0)


def test_soft_limits_reduce_velocity():
    safety = Safety(k_velocity=10.0, k_position=5.0, soft_lower_limit=-0.8, soft_upper_limit=0.8)
    hip = LimitedJoint(VELOCITY, {POSITION: 0.7}, position=(-1.0, 1.0), velocity=2.0, safety=safety)
    assert hip.send(2.0) == pytest.approx(0.5)
    hip.states[POSITION].value = 0.9
    assert hip.send(2.0) == pytest.approx(-0.5)
    joint_near_limit = LimitedJoint(EFFORT, {POSITION: 0.7, VELOCITY: 0.4}, effort=10.0, velocity=2.0, safety=safety)
    assert joint_near_limit.send(9.0) == pytest.approx(1.0)


def test_nan_and_unclaimed_commands_are_not_limited():
    hip = LimitedJoint(POSITION, {POSITION: 0.0}, position=(-1.0, 1.0), velocity=1.0)
    assert hip.send(nan) != hip.send(nan)
    hip.command.value = 7.0
    assert hip.limiter.enforce(0.1, ()) == []
    assert hip.command.value == 7.0
    assert LimitedJoint(VELOCITY).send(inf) == inf


DESCRIPTION = robot(
    joint("hip", "position") + "<joint name='knee'><limits enable='false'/><command_interface name='position'/>"
    "<state_interface name='position'/></joint>"
)


@pytest.mark.parametrize(
    ("distribution", "message", "limited"),
    [("jazzy", None, False), ("jazzy", True, True), ("kilted", None, True), ("kilted", False, False)],
)
async def test_manager_enforces_command_limits_if_enabled(graph, log, monkeypatch, distribution, message, limited):
    monkeypatch.setenv("ROS_DISTRO", distribution)
    parameters = {} if message is None else {"enforce_command_limits": message}
    controller_manager = make_manager(
        graph,
        DESCRIPTION,
        {**parameters, "positions": {"type": FORWARD}},
        positions={"joints": ["hip", "knee"], "interface_name": "position"},
    )
    assert controller_manager.load("positions")
    assert controller_manager.configure("positions")
    assert controller_manager.switch(["positions"], [], STRICT)[0]
    controller_manager.controllers["positions"].controller._command = [9.0, 9.0]
    for cycle in range(1, 301):
        controller_manager.cycle(cycle * 10_000_000, 0.01)
    hip, knee = controller_manager.resources.commands(["hip/position", "knee/position"])
    assert (hip.value, knee.value) == ((3.0 if limited else 9.0), 9.0)
    texts = [record.text for record in log if "is outside its limits" in record.text]
    assert len(texts) == limited
