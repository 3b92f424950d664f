"""Admittance: an arm that yields to forces as masses, springs and dampers do."""

from __future__ import annotations

from math import cos, exp, nan, pi, sin, sqrt
from typing import Any

import pytest

from linkwright.control.controllers.admittance_controller import AdmittanceController
from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.registry import controller_class
from linkwright.diagnostics import LinkwrightError
from linkwright.messages import Header, from_values, get_message

STATUS = "control_msgs/msg/AdmittanceControllerState"
JOINTS = ("x", "y", "z", "roll", "pitch", "yaw")
AXES = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1", "roll": "1 0 0", "pitch": "0 1 0", "yaw": "0 0 1"}
WRENCH = ("force.x", "force.y", "force.z", "torque.x", "torque.y", "torque.z")


def make_description(tool: str = "0 0 0") -> str:
    """Return a robot that moves along three axes and about three axes, with a tool that has another orientation."""
    links = ["base", *(f"{name}_link" for name in JOINTS)]
    joints = "".join(
        f"<link name='{links[index + 1]}'/><joint name='{name}' type='{'prismatic' if len(name) == 1 else 'revolute'}'>"
        f"<parent link='{links[index]}'/><child link='{links[index + 1]}'/><axis xyz='{AXES[name]}'/>"
        "<limit lower='-9' upper='9' effort='1' velocity='1'/></joint>"
        for index, name in enumerate(JOINTS)
    )
    return (
        f"<robot name='r'><link name='base'/>{joints}<link name='tool'/><joint name='mount' type='fixed'>"
        f"<parent link='yaw_link'/><child link='tool'/><origin rpy='{tool}'/></joint></robot>"
    )


def make_parameters(**changes: Any) -> dict[str, Any]:
    """Return the parameters of a controller without damping of the joints, filter or weight."""
    frame = {"frame": {"id": "tool"}}
    axes = {
        "selected_axes": [True] * 6,
        "mass": [2.0] * 6,
        "damping_ratio": [0.5] * 6,
        "stiffness": [50.0] * 6,
        "joint_damping": 0.0,
    }
    return {
        "joints": list(JOINTS),
        "command_interfaces": ["position"],
        "state_interfaces": ["position"],
        "kinematics": {
            "plugin_name": "kinematics_interface_kdl/KinematicsInterfaceKDL",
            "plugin_package": "kinematics_interface",
            "base": "base",
            "tip": "tool",
            "alpha": 1e-9,
        },
        "ft_sensor": {"name": "sensor", **frame, "filter_coefficient": 1.0},
        "control": frame,
        "fixed_world_frame": {"frame": {"id": "base"}},
        "gravity_compensation": {**frame, "CoG": {"pos": [0.0, 0.0, 0.0], "force": 0.0}},
        **{name: value for name, value in changes.items() if name != "admittance"},
        "admittance": axes | changes.get("admittance", {}),
    }


class Arm:
    """An arm on a test bench whose joints follow their commands at once."""

    def __init__(self, bench: Any, *, tool: str = "0 0 0", **changes: Any) -> None:
        self.bench = bench
        for name in JOINTS:
            bench.joint(name, commands=("position", "velocity"), position=0.0)
        bench.joint("sensor", **dict.fromkeys(WRENCH, 0.0))
        self.controller = bench.make(
            AdmittanceController, description=make_description(tool), **make_parameters(**changes)
        )
        bench.activate(self.controller)

    def push(self, **components: float) -> None:
        """Set components of the measured wrench, such as ``fx`` or ``tz``."""
        for name, value in components.items():
            kind = {"f": "force", "t": "torque"}[name[0]]
            self.bench.states[f"sensor/{kind}.{name[1]}"].value = value

    async def run(self, seconds: float, period_s: float = 0.001) -> None:
        for _ in range(round(seconds / period_s)):
            await self.bench.step(self.controller, period_s)
            for name in JOINTS:
                value = self.bench.commands[f"{name}/position"].value
                if value == value:
                    self.bench.states[f"{name}/position"].value = value

    def positions(self) -> list[float]:
        return [self.bench.commands[f"{name}/position"].value for name in JOINTS]


def step_response(force: float, mass: float, stiffness: float, ratio: float, seconds: float) -> float:
    """Return the displacement of a mass with a spring and a damper some time after a force begins."""
    natural = sqrt(stiffness / mass)
    damped = natural * sqrt(1 - ratio**2)
    envelope = exp(-ratio * natural * seconds)
    return (
        force / stiffness * (1 - envelope * (cos(damped * seconds) + ratio * natural / damped * sin(damped * seconds)))
    )


def test_controller_is_found_by_type():
    assert controller_class("admittance_controller/AdmittanceController") is AdmittanceController


@pytest.mark.parametrize(("push", "joint"), [({"fx": 10.0}, "x"), ({"fz": 10.0}, "z"), ({"tz": 10.0}, "yaw")])
async def test_arm_moves_as_mass_with_spring_and_damper(bench, push, joint):
    arm = Arm(bench)
    arm.push(**push)
    await arm.run(0.4)
    expected = step_response(10.0, 2.0, 50.0, 0.5, 0.4)
    assert arm.positions() == pytest.approx([expected if name == joint else 0.0 for name in JOINTS], abs=1e-3)
    await arm.run(2.5, 0.004)
    assert arm.positions()[JOINTS.index(joint)] == pytest.approx(0.2, abs=1e-3)
    arm.push(**dict.fromkeys(push, 0.0))
    await arm.run(2.5, 0.004)
    assert arm.positions() == pytest.approx([0.0] * 6, abs=1e-3)


async def test_constants_and_axes_belong_to_control_frame(bench):
    arm = Arm(
        bench,
        tool=f"0 0 {pi / 2}",
        admittance={
            "selected_axes": [True, False, True, True, True, True],
            "stiffness": [100.0, 50.0, 50.0, 50.0, 50.0, 50.0],
        },
    )
    arm.push(fx=10.0, fy=10.0)
    await arm.run(2.5, 0.004)
    assert arm.positions()[:3] == pytest.approx([0.0, 0.1, 0.0], abs=1e-3)


async def test_weight_of_tool_does_not_move_arm(bench):
    gravity = {"frame": {"id": "tool"}, "CoG": {"pos": [0.1, 0.0, 0.0], "force": 20.0}}
    arm = Arm(bench, tool=f"{pi} 0 0", gravity_compensation=gravity)
    arm.push(fz=20.0, ty=-2.0)
    await arm.run(0.5)
    assert arm.positions() == pytest.approx([0.0] * 6, abs=1e-9)


async def test_unknown_wrench_counts_as_zero(bench):
    arm = Arm(bench)
    arm.push(fx=nan, fy=50.0)
    await arm.run(0.1)
    assert arm.positions() == pytest.approx([0.0] * 6)


async def test_references_of_topic_are_displaced_by_force(bench):
    arm = Arm(bench)
    bench.publish(
        "trajectory_msgs/msg/JointTrajectoryPoint",
        "/controller/joint_references",
        get_message("trajectory_msgs/msg/JointTrajectoryPoint")(positions=[0.5, 0.0, 0.0, 0.0, 0.0, 0.25]),
    )
    await arm.run(0.01)
    assert arm.positions() == pytest.approx([0.5, 0.0, 0.0, 0.0, 0.0, 0.25], abs=1e-3)
    arm.push(fy=5.0)
    await arm.run(2.5, 0.004)
    expected = [0.5 - 0.1 * sin(0.25), 0.1 * cos(0.25), 0.0, 0.0, 0.0, 0.25]
    assert arm.positions() == pytest.approx(expected, abs=1e-3)


async def test_references_of_another_controller_are_commanded(bench):
    arm = Arm(bench)
    assert [reference.name for reference in arm.controller.references][:2] == [
        "controller/x/position",
        "controller/y/position",
    ]
    arm.controller.is_chained = True
    arm.controller.references[0].value = 0.75
    await arm.run(0.01)
    assert arm.positions()[0] == pytest.approx(0.75, abs=1e-3)


async def test_wrench_reference_in_other_frame_is_refused(bench):
    arm = Arm(bench)
    wrench = get_message("geometry_msgs/msg/WrenchStamped")(header=Header(frame_id="base"))
    wrench.wrench.force = from_values(type(wrench.wrench.force), [10.0, 0.0, 0.0])
    bench.publish("geometry_msgs/msg/WrenchStamped", "/controller/wrench_reference", wrench)
    await arm.run(0.01)
    assert "Ignoring wrench reference as it is on the wrong frame: base" in str(bench.log[-1].text)
    assert arm.positions() == pytest.approx([0.0] * 6)
    wrench.header.frame_id = "tool"
    bench.publish("geometry_msgs/msg/WrenchStamped", "/controller/wrench_reference", wrench)
    await arm.run(2.5, 0.004)
    assert arm.positions()[0] == pytest.approx(0.2, abs=1e-3)


async def test_status_has_settings_and_displacement(bench):
    arm = Arm(bench)
    messages = bench.record(STATUS, "/controller/status")
    arm.push(fx=10.0)
    await arm.run(2.5, 0.004)
    status = messages[-1]
    assert list(status.damping.data) == pytest.approx([10.0] * 6)
    assert list(status.selected_axes.data) == [1] * 6
    assert status.wrench_base.header.frame_id == "base"
    assert status.wrench_base.wrench.force.x == pytest.approx(10.0)
    assert status.admittance_position.transform.translation.x == pytest.approx(0.2, abs=1e-3)
    assert list(status.joint_state.name) == list(JOINTS)


async def test_changed_stiffness_applies_at_once_or_after_activation(bench):
    arm = Arm(bench, enable_parameter_update_without_reactivation=False)
    arm.push(fx=10.0)
    node = arm.controller.node.graph_node
    node.set_parameters([type(node.get_parameter("admittance.stiffness"))("admittance.stiffness", value=[100.0] * 6)])
    await arm.run(2.5, 0.004)
    assert arm.positions()[0] == pytest.approx(0.2, abs=1e-3)
    arm.controller.on_activate()
    for name in JOINTS:
        bench.states[f"{name}/position"].value = 0.0
    arm.controller.on_activate()
    await arm.run(2.5, 0.004)
    assert arm.positions()[0] == pytest.approx(0.1, abs=1e-3)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"state_interfaces": ["velocity"]}, "Position state interface is required"),
        ({"command_joints": ["x"]}, "'command_joints' parameter has to have the same size"),
        ({"joints": ["x", "y"]}, "the joints from 'base' to 'tool' are x, y, z, roll, pitch, yaw"),
        ({"control": {"frame": {"id": "hand"}}}, r"link 'hand' \(control.frame.id\) is not part of the chain: base, "),
    ],
)
async def test_controller_that_contradicts_description_is_not_configured(bench, changes, message):
    controller = bench.make(AdmittanceController, description=make_description(), **make_parameters(**changes))
    with pytest.raises(ControllerError, match=message):
        controller.on_configure()


async def test_controller_without_description_is_not_configured(bench):
    with pytest.raises(ControllerError, match="there is no valid robot_description"):
        bench.make(AdmittanceController, **make_parameters()).on_configure()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"admittance": {"mass": [1.0]}}, "parameter 'admittance.mass' must have 6 values, but it has 1"),
        ({"admittance": {"mass": [0.0] * 6}}, "'admittance.mass' with the value 0 must be from 0.0001 to 1e"),
        ({"admittance": {"stiffness": [-1.0] * 6}}, "'admittance.stiffness' with the value -1"),
        ({"chainable_command_interfaces": ["acceleration"]}, "is not one of: position, velocity"),
        ({"command_interfaces": ["force"]}, "is not one of: position"),
        ({"joints": []}, "Parameter 'joints' cannot be empty"),
    ],
)
async def test_invalid_parameters_are_rejected(bench, changes, message):
    with pytest.raises(LinkwrightError, match=message):
        bench.make(AdmittanceController, description=make_description(), **make_parameters(**changes))
