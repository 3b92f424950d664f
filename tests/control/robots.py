"""Robots with ros2_control, and managers for them."""

from __future__ import annotations

from typing import Any

from linkwright.control.hardware.description import HardwareDescription, hardware_from_robot
from linkwright.control.hardware.resources import Resources, create_installed_hardware
from linkwright.control.manager.exchange import DirectExchange
from linkwright.control.manager.hardware_loading import load_hardware
from linkwright.control.manager.manager import ControllerManager
from linkwright.control.manager.nodes import ProcessArguments
from linkwright.descriptions import DescriptionLibrary
from linkwright.graph import Graph
from linkwright.graph.parameters.parameter import ParameterRules

JOINT = "<joint name='{name}'>{commands}{states}{extra}</joint>"


def joint(
    name: str, commands: str = "position", states: str = "position velocity", extra: str = "", initial: str = ""
) -> str:
    """Return a joint of ``<ros2_control>``."""
    value = f"<param name='initial_value'>{initial}</param>" if initial else ""
    return JOINT.format(
        name=name,
        extra=extra,
        commands="".join(f"<command_interface name='{interface}'/>" for interface in commands.split()),
        states="".join(
            f"<state_interface name='{interface}'>{value if interface == 'position' else ''}</state_interface>"
            for interface in states.split()
        ),
    )


def robot(control: str, *, parameters: str = "", mimic: str = "", joints: tuple[str, ...] = ("hip", "knee")) -> str:
    """Return a robot with joints in a row, and one system of mock hardware."""
    links = "<link name='base'/>" + "".join(f"<link name='{joint}_link'/>" for joint in joints)
    parent_link = ["base", *(f"{joint}_link" for joint in joints)]
    links_and_joints = "".join(
        f"<joint name='{joint}' type='revolute'><parent link='{parent}'/><child link='{joint}_link'/>"
        "<axis xyz='0 0 1'/>"
        f"<limit lower='-3' upper='3' effort='10' velocity='5'/>{mimic if joint == joints[-1] else ''}</joint>"
        for joint, parent in zip(joints, parent_link, strict=False)
    )
    return (
        f"<robot name='r'>{links}{links_and_joints}<ros2_control name='arm' type='system'><hardware>"
        f"<plugin>mock_components/GenericSystem</plugin>{parameters}</hardware>{control}</ros2_control></robot>"
    )


def read_hardware(text: str) -> tuple[list[HardwareDescription], list[str]]:
    """Return the hardware of a description, and the findings about it."""
    description = DescriptionLibrary().read(text)
    assert description.robot is not None
    hardware, findings = hardware_from_robot(description.robot)
    return hardware, [f"{finding.code} {finding.message}" for finding in findings]


def make_manager(
    graph: Graph, text: str, parameters: dict[str, Any] | None = None, **controller_parameters: dict[str, Any]
) -> Any:
    """Return a manager of a robot.

    The parameters are for the manager's node and the nodes of its controllers.
    """
    rules = ParameterRules()
    for name, values in controller_parameters.items():
        for key, value in values.items():
            rules.set(name, key, value)
    node = graph.create_node(
        "controller_manager",
        parameters=parameters or {},
        allow_undeclared_parameters=True,
        automatically_declare_parameters_from_overrides=True,
    )
    controller_manager = ControllerManager(
        node, DirectExchange(), Resources(node.get_logger()), ProcessArguments(rules)
    )
    load_hardware(controller_manager, text, DescriptionLibrary(), create_installed_hardware)
    return controller_manager
