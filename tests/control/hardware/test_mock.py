"""The mock hardware: initial values, following, offsets and mimic joints."""

from __future__ import annotations

import pytest

from linkwright.control.hardware.component import HardwareError
from linkwright.control.hardware.mock import GenericSystem
from linkwright.graph import Graph
from tests.control.robots import joint, read_hardware, robot


@pytest.fixture
def load_hardware(graph: Graph):
    def make(text: str) -> GenericSystem:
        (hardware,), _ = read_hardware(text)
        return GenericSystem(hardware, graph.get_logger("mock"))

    return make


def parameter_element(name: str, value: str) -> str:
    return f"<param name='{name}'>{value}</param>"


def state_values(hardware: GenericSystem) -> dict[str, float]:
    return {state.name: state.value for state in hardware.states}


def set_command(hardware: GenericSystem, name: str, value: float) -> None:
    next(command for command in hardware.commands if command.name == name).value = value


async def test_states_start_at_initial_values_and_follow_commands(load_hardware):
    hardware = load_hardware(robot(joint("hip", "position velocity", initial="0.5") + joint("knee")))
    hardware.read(0, 0.01)
    assert state_values(hardware) == {"hip/position": 0.5, "hip/velocity": 0, "knee/position": 0, "knee/velocity": 0}
    set_command(hardware, "hip/position", 1.0)
    set_command(hardware, "hip/velocity", 2.0)
    hardware.read(0, 0.01)
    assert (state_values(hardware)["hip/position"], state_values(hardware)["hip/velocity"]) == (1.0, 2.0)


async def test_position_following_offset_is_applied(load_hardware):
    hardware = load_hardware(
        robot(joint("hip"), parameters=parameter_element("position_state_following_offset", "-0.1"))
    )
    set_command(hardware, "hip/position", 1.0)
    hardware.read(0, 0.01)
    hardware.read(0, 0.01)
    assert state_values(hardware)["hip/position"] == pytest.approx(0.9)


async def test_following_offset_applies_to_custom_interface(load_hardware):
    parameters = parameter_element("position_state_following_offset", "0.5") + parameter_element(
        "custom_interface_with_following_offset", "actual_position"
    )
    hardware = load_hardware(robot(joint("hip", states="position actual_position"), parameters=parameters))
    set_command(hardware, "hip/position", 1.0)
    hardware.read(0, 0.01)
    assert state_values(hardware) == {"hip/position": 1.0, "hip/actual_position": 1.5}


async def test_mimic_joint_follows(load_hardware):
    text = robot(joint("hip") + joint("knee", ""), mimic="<mimic joint='hip' multiplier='-2' offset='0.5'/>")
    hardware = load_hardware(text)
    set_command(hardware, "hip/position", 1.0)
    hardware.read(0, 0.01)
    assert state_values(hardware)["knee/position"] == -1.5


async def test_disabled_commands_are_ignored(load_hardware):
    hardware = load_hardware(robot(joint("hip"), parameters=parameter_element("disable_commands", "true")))
    set_command(hardware, "hip/position", 1.0)
    hardware.read(0, 0.01)
    assert state_values(hardware)["hip/position"] == 0.0


async def test_dynamics_integrate_velocity_command(load_hardware):
    text = robot(
        joint("hip", "position velocity", "position velocity acceleration"),
        parameters=parameter_element("calculate_dynamics", "true"),
    )
    hardware = load_hardware(text)
    hardware.prepare_switch(["hip/velocity"], [])
    hardware.perform_switch(["hip/velocity"], [])
    set_command(hardware, "hip/velocity", 2.0)
    hardware.read(0, 0.1)
    assert state_values(hardware) == {"hip/position": 0.0, "hip/velocity": 2.0, "hip/acceleration": pytest.approx(20.0)}
    hardware.read(0, 0.1)
    assert state_values(hardware)["hip/position"] == pytest.approx(0.2)
    with pytest.raises(HardwareError, match=r"Got multiple \(2\) starting interfaces for joint 'hip'"):
        hardware.prepare_switch(["hip/velocity", "hip/position"], [])


async def test_sensors_and_gpios_are_mocked(load_hardware):
    control = (
        joint("hip")
        + "<sensor name='ft'><state_interface name='force.x'/></sensor>"
        + "<gpio name='io'><command_interface name='out'/><state_interface name='out'/></gpio>"
    )
    hardware = load_hardware(robot(control, parameters=parameter_element("mock_sensor_commands", "true")))
    set_command(hardware, "ft/force.x", 3.0)
    set_command(hardware, "io/out", 1.0)
    hardware.read(0, 0.01)
    assert (state_values(hardware)["ft/force.x"], state_values(hardware)["io/out"]) == (3.0, 1.0)
