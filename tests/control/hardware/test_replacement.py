"""The mock in place of hardware without a driver: claimed commands move joints, and separate sensors show them."""

from __future__ import annotations

import pytest

from linkwright.control.manager.switching import STRICT
from tests.control.robots import joint, make_manager, robot

PERIOD_S = 0.01
FORWARD = "forward_command_controller/ForwardCommandController"
MULTIPLE = joint("hip", "position velocity acceleration", "position velocity acceleration")


def replace_plugin(text: str) -> str:
    return text.replace("mock_components/GenericSystem", "acme/Driver")


@pytest.fixture
def create_manager(graph):
    """Return a function that creates a manager with a controller for each kind of command of the hip."""
    managers = []

    def create(text: str, *kinds: str):
        manager = make_manager(
            graph,
            text,
            {f"{kind}.type": FORWARD for kind in kinds},
            **{kind: {"type": FORWARD, "joints": ["hip"], "interface_name": kind} for kind in kinds},
        )
        managers.append(manager)
        for kind in kinds:
            assert manager.load(kind)
            assert manager.configure(kind)
        return manager

    yield create
    for manager in managers:
        manager.close()


def switch(manager, start: str = "", stop: str = "") -> None:
    succeeded, reason = manager.switch(start.split(), stop.split(), STRICT)
    assert succeeded, reason


def run(manager, kind: str, value: float, cycles: int = 50) -> None:
    """Command a value, and read the hardware for some periods."""
    manager.controllers[kind].controller.commands[0].value = value
    read(manager, cycles)


def read(manager, cycles: int = 50) -> None:
    for cycle in range(cycles):
        manager.resources.read(cycle * 10_000_000, PERIOD_S)


def states(manager) -> dict[str, float]:
    return {state.kind: state.value for state in manager.resources.states(manager.resources.state_names)}


@pytest.mark.parametrize(
    ("kind", "value", "expected"),
    [
        ("position", 0.7, {"position": 0.7, "velocity": 0.0, "acceleration": 0.0}),
        ("velocity", 2.0, {"position": 1.0, "velocity": 2.0, "acceleration": 0.0}),
        ("acceleration", 8.0, {"position": 1.02, "velocity": 4.0, "acceleration": 8.0}),
    ],
)
async def test_claimed_interface_moves_joint_with_several_commands(create_manager, kind, value, expected):
    manager = create_manager(replace_plugin(robot(MULTIPLE)), kind)
    switch(manager, kind)
    run(manager, kind, value)
    assert states(manager) == pytest.approx(expected)


async def test_joint_stands_still_after_its_interface_is_released(create_manager):
    manager = create_manager(replace_plugin(robot(MULTIPLE)), "velocity")
    switch(manager, "velocity")
    run(manager, "velocity", 2.0)
    switch(manager, stop="velocity")
    read(manager)
    assert states(manager) == pytest.approx({"position": 1.0, "velocity": 0.0, "acceleration": 0.0})


async def test_command_of_earlier_controller_moves_nothing(create_manager):
    manager = create_manager(replace_plugin(robot(MULTIPLE)), "position", "velocity")
    switch(manager, "position")
    run(manager, "position", 0.5)
    switch(manager, "velocity", "position")
    run(manager, "velocity", 1.0)
    switch(manager, "position", "velocity")
    read(manager)
    assert states(manager)["position"] == pytest.approx(1.0)


async def test_claimed_position_and_velocity_are_both_followed(create_manager):
    manager = create_manager(replace_plugin(robot(MULTIPLE)), "position", "velocity")
    switch(manager, "position velocity")
    manager.controllers["velocity"].controller.commands[0].value = 0.3
    run(manager, "position", 0.7)
    assert states(manager) == pytest.approx({"position": 0.7, "velocity": 0.3, "acceleration": 0.0})


@pytest.mark.parametrize(
    ("wheel", "kind", "expected_position"),
    [("velocity", "velocity", 1.0), ("velocity effort", "velocity", 1.0), ("velocity effort", "effort", 0.0)],
)
async def test_wheel_beside_steering_joint_turns_only_by_velocity(create_manager, wheel, kind, expected_position):
    manager = create_manager(replace_plugin(robot(joint("hip", wheel) + joint("knee"))), kind)
    switch(manager, kind)
    run(manager, kind, 2.0)
    (position,) = manager.resources.states(["hip/position"])
    assert position.value == pytest.approx(expected_position)


SENSOR = (
    "<ros2_control name='encoder' type='sensor'><hardware><plugin>{plugin}</plugin></hardware>"
    "<joint name='hip'><state_interface name='position'>{initial}</state_interface></joint></ros2_control>"
)


@pytest.mark.parametrize("is_sensor_first", [False, True])
async def test_separate_sensor_shows_joint_that_other_hardware_moves(create_manager, is_sensor_first):
    sensor = SENSOR.format(plugin="acme/Encoder", initial="<param name='initial_value'>0.25</param>")
    text = replace_plugin(robot(joint("hip", "velocity", "")))
    anchor = "<ros2_control name='arm'" if is_sensor_first else "</robot>"
    manager = create_manager(text.replace(anchor, sensor + anchor), "velocity")
    switch(manager, "velocity")
    run(manager, "velocity", 2.0)
    read(manager, 1)
    (position,) = manager.resources.states(["hip/position"])
    assert position.value == pytest.approx(0.25 + 1.02, abs=0.02)
    switch(manager, stop="velocity")
    read(manager, 2)
    assert position.value == pytest.approx(0.25 + 1.02)


async def test_mock_that_file_names_copies_commands_and_shows_no_other_joint(create_manager):
    mock = "mock_components/GenericSystem"
    text = robot(joint("hip", "velocity", "velocity"))
    sensor = SENSOR.format(plugin=mock, initial="")
    manager = create_manager(text.replace("</robot>", sensor + "</robot>"), "velocity")
    switch(manager, "velocity")
    run(manager, "velocity", 2.0)
    assert states(manager) == {"velocity": 2.0, "position": 0.0}
