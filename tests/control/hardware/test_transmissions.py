"""Hardware of ROS 1, which ``<transmission>`` elements describe."""

from __future__ import annotations

import pytest

from linkwright.control.hardware.transmissions import hardware_from_transmissions
from linkwright.descriptions import DescriptionLibrary
from tests.control.robots import robot

SIMPLE_TYPE = "transmission_interface/SimpleTransmission"
EFFORT_INTERFACE = "<hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface>"


def transmission(joints: str, actuator: str = "", kind: str = SIMPLE_TYPE, name: str = "drive") -> str:
    return (
        f"<transmission name='{name}'><type>{kind}</type>{joints}<actuator name='motor'>{actuator}"
        "<mechanicalReduction>50</mechanicalReduction></actuator></transmission>"
    )


def read_transmissions(*transmissions: str, mimic: str = ""):
    """Return the joints of the hardware, and the findings."""
    text = robot("", mimic=mimic).replace("</robot>", "".join(transmissions) + "</robot>")
    description = DescriptionLibrary().read(text).robot
    assert description is not None
    hardware, findings = hardware_from_transmissions(description)
    texts = [f"{finding.code} {finding.message} ({finding.hint})" for finding in findings]
    return [joint for system in hardware for joint in system.joints], texts


@pytest.mark.parametrize("prefix", ["", "hardware_interface/", "transmission_interface/"])
@pytest.mark.parametrize("kind", ["Effort", "Position", "Velocity"])
@pytest.mark.parametrize("place", ["joint", "actuator"])
def test_interface_of_joint_or_actuator_is_the_command_interface(prefix, kind, place):
    interface = f"<hardwareInterface>{prefix}{kind}JointInterface</hardwareInterface>"
    in_joint, in_actuator = (interface, "") if place == "joint" else ("", interface)
    (joint,), findings = read_transmissions(transmission(f"<joint name='hip'>{in_joint}</joint>", in_actuator))
    assert findings == []
    assert [command.name for command in joint.commands] == [kind.lower()]
    assert [state.name for state in joint.states] == ["position", "velocity", "effort"]


def test_joints_keep_the_order_of_the_file_and_their_first_transmission():
    knee, hip = (f"<joint name='{name}'>{EFFORT_INTERFACE}</joint>" for name in ("knee", "hip"))
    velocity = "<joint name='knee'><hardwareInterface>VelocityJointInterface</hardwareInterface></joint>"
    joints, _ = read_transmissions(transmission(knee), transmission(hip), transmission(velocity))
    assert [(joint.name, joint.commands[0].name) for joint in joints] == [("knee", "effort"), ("hip", "effort")]


def test_mimic_joint_follows_its_leader():
    mimic = "<mimic joint='hip' multiplier='-2' offset='0.5'/>"
    (joint,), _ = read_transmissions(transmission(f"<joint name='knee'>{EFFORT_INTERFACE}</joint>"), mimic=mimic)
    assert joint.mimic is not None
    assert (joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset) == ("hip", -2.0, 0.5)


@pytest.mark.parametrize("kind", ["DifferentialTransmission", "FourBarLinkageTransmission"])
def test_transmission_of_several_joints_is_left_out_with_a_replacement(kind):
    joints, findings = read_transmissions(
        transmission(f"<joint name='hip'>{EFFORT_INTERFACE}</joint>", kind=f"transmission_interface/{kind}")
    )
    assert joints == []
    (finding,) = findings
    assert finding.startswith("CTL117 transmission 'drive' is left out: gazebo_ros_control drives one joint")
    assert finding.endswith("(write a SimpleTransmission for each of its joints)")
    two_joints = f"<joint name='hip'>{EFFORT_INTERFACE}</joint><joint name='knee'>{EFFORT_INTERFACE}</joint>"
    assert read_transmissions(transmission(two_joints)) == ([], findings)


def test_first_of_several_interfaces_is_used():
    two_interfaces = f"{EFFORT_INTERFACE}<hardwareInterface>PositionJointInterface</hardwareInterface>"
    (joint,), (finding,) = read_transmissions(transmission(f"<joint name='hip'>{two_interfaces}</joint>"))
    assert [command.name for command in joint.commands] == ["effort"]
    assert finding.startswith("CTL119 joint 'hip' has several hardware interfaces")
    assert "EffortJointInterface is used" in finding


def test_transmissions_without_a_joint_or_an_interface_are_left_out():
    imu = "<hardwareInterface>ImuSensorInterface</hardwareInterface>"
    joints, findings = read_transmissions(
        transmission(""),
        transmission(f"<joint name='hop'>{EFFORT_INTERFACE}</joint>"),
        transmission("<joint name='hip'/>"),
        transmission(f"<joint name='hip'>{imu}</joint>"),
    )
    assert joints == []
    names = [f"hardware_interface/{kind}JointInterface" for kind in ("Effort", "Position", "Velocity")]
    hint = f"write one of {', '.join(names)}"
    assert findings == [
        "CTL118 transmission 'drive' is left out: it has no <joint> (name the joint that the transmission drives)",
        "CTL118 transmission 'drive' names the joint 'hop', which the robot does not have (did you mean 'hip'?)",
        f"CTL118 joint 'hip' is left out: it has no <hardwareInterface> ({hint})",
        f"CTL118 joint 'hip' is left out: the hardware interface 'ImuSensorInterface' is unknown ({hint})",
    ]


def test_robot_without_transmissions_is_reported():
    joints, (finding,) = read_transmissions()
    assert joints == []
    assert finding.startswith("CTL116 the description has no <transmission>")
