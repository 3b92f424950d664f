"""The `<ros2_control>` elements of a description: components, interfaces and parameters."""

from __future__ import annotations

from math import isnan

from tests.control.robots import joint, read_hardware, robot


def test_components_interfaces_and_parameters_are_parsed():
    text = robot(
        joint("hip", "position velocity", initial="0.5")
        + "<sensor name='imu'><state_interface name='orientation.x'/><param name='frame_id'>base</param></sensor>"
        + "<gpio name='flange'><command_interface name='out1'/><state_interface name='in1'/></gpio>",
        parameters="<param name='calculate_dynamics'>true</param>",
    )
    (hardware,), findings = read_hardware(text)
    assert findings == []
    assert (hardware.name, hardware.type, hardware.plugin) == ("arm", "system", "mock_components/GenericSystem")
    assert hardware.is_set("calculate_dynamics")
    assert [command.name for command in hardware.joints[0].commands] == ["position", "velocity"]
    assert hardware.joints[0].states[0].initial_value == 0.5
    assert isnan(hardware.joints[0].states[1].initial_value)
    assert hardware.sensors[0].parameters == {"frame_id": "base"}
    assert [component.kind for component in hardware.components] == ["joint", "sensor", "gpio"]


def test_command_limits_are_parsed():
    limits = "<param name='min'>-1</param><param name='max'>2.5</param>"
    text = robot(f"<joint name='hip'><command_interface name='position'>{limits}</command_interface></joint>")
    (hardware,), _ = read_hardware(text)
    command = hardware.joints[0].commands[0]
    assert (command.minimum, command.maximum) == (-1.0, 2.5)


def test_mimic_is_read_from_joint_or_parameters():
    text = robot(joint("hip") + joint("knee", ""), mimic="<mimic joint='hip' multiplier='-2' offset='0.5'/>")
    (hardware,), _ = read_hardware(text)
    mimic = hardware.joints[1].mimic
    assert mimic is not None
    assert (mimic.joint, mimic.multiplier, mimic.offset) == ("hip", -2.0, 0.5)
    params = "<param name='mimic'>hip</param><param name='multiplier'>3</param>"
    (hardware,), _ = read_hardware(robot(joint("hip") + joint("knee", "", extra=params)))
    mimic = hardware.joints[1].mimic
    assert mimic is not None
    assert (mimic.joint, mimic.multiplier) == ("hip", 3.0)


def test_invalid_elements_are_reported_and_omitted():
    text = robot(joint("hip") + joint("kne") + joint("knee", extra="<param name='mimic'>hipp</param>"))
    text = text.replace(
        "</robot>", "<ros2_control name='b' type='sytem'/><ros2_control name='c' type='system'/></robot>"
    )
    (hardware,), findings = read_hardware(text)
    assert [joint.name for joint in hardware.joints] == ["hip", "knee"]
    assert findings == [
        "CTL113 <ros2_control> names the joint 'kne', which the robot does not have",
        "CTL114 the mimicked joint 'hipp' is not in this <ros2_control>",
        "CTL111 <ros2_control> has no name, or its type 'sytem' is not valid",
        "CTL112 <ros2_control> 'c' does not name a hardware plugin",
    ]
    assert read_hardware("<robot name='r'><link name='a'/></robot>")[1] == [
        "CTL110 the description has no <ros2_control>"
    ]
