"""The PID controller."""

from __future__ import annotations

from math import isnan, pi
from typing import Any

import pytest

from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.pid_controller import PidController
from linkwright.diagnostics import LinkwrightError
from linkwright.messages import get_message, get_service

COMMAND = "control_msgs/msg/MultiDOFCommand"
WHEEL_PARAMETERS = {
    "dof_names": ["wheel"],
    "command_interface": "effort",
    "reference_and_state_interfaces": ["velocity"],
}
BOTH_PARAMETERS = {**WHEEL_PARAMETERS, "reference_and_state_interfaces": ["position", "velocity"]}


def start_wheel(bench: Any, position: float = 0.0, velocity: float = 0.0, **parameters: Any) -> Any:
    """Return the controller of a wheel."""
    bench.joint("wheel", commands=("effort",), position=position, velocity=velocity)
    return bench.start(PidController, **parameters)


def make_command(names: list[str], values: list[float], rates: list[float]) -> Any:
    return get_message(COMMAND)(dof_names=names, values=values, values_dot=rates)


def publish_reference(
    bench: Any, *values: float, names: tuple[str, ...] = ("wheel",), rates: tuple[float, ...] = ()
) -> None:
    """Publish a reference."""
    bench.publish(COMMAND, "/controller/reference", make_command(list(names), list(values), list(rates)))


async def test_command_follows_error(bench):
    controller = start_wheel(bench, velocity=1.0, **WHEEL_PARAMETERS, gains={"wheel": {"p": 2.0, "i": 1.0}})
    await bench.step(controller)
    assert isnan(bench.commands["wheel/effort"].value)
    publish_reference(bench, 4.0)
    await bench.step(controller)
    assert bench.commands["wheel/effort"].value == pytest.approx(6.03)


async def test_states_are_first_references_if_requested(bench):
    controller = start_wheel(
        bench, velocity=1.0, **WHEEL_PARAMETERS, gains={"wheel": {"p": 2.0}}, set_current_state_as_first_setpoint=True
    )
    await bench.step(controller)
    assert bench.commands["wheel/effort"].value == 0.0
    bench.states["wheel/velocity"].value = 0.5
    await bench.step(controller)
    assert bench.commands["wheel/effort"].value == pytest.approx(1.0)
    publish_reference(bench, 2.5)
    await bench.step(controller)
    assert bench.commands["wheel/effort"].value == pytest.approx(4.0)


async def test_error_derivative_uses_second_interface(bench):
    controller = start_wheel(
        bench, position=1.0, velocity=0.5, **BOTH_PARAMETERS, gains={"wheel": {"p": 10.0, "d": 2.0}}
    )
    publish_reference(bench, 2.0, rates=(1.0,))
    await bench.step(controller)
    assert bench.commands["wheel/effort"].value == pytest.approx(10.0 + 1.0)


async def test_service_enables_feed_forward(bench):
    controller = start_wheel(bench, **WHEEL_PARAMETERS, gains={"wheel": {"p": 1.0, "feedforward_gain": 3.0}})
    publish_reference(bench, 2.0)
    await bench.step(controller)
    assert bench.commands["wheel/effort"].value == pytest.approx(2.0)
    switch = get_service("std_srvs/srv/SetBool")
    future = bench.node.create_client(switch, "/controller/set_feedforward_control").call_async(
        switch.Request(data=True)
    )
    await bench.step(controller)
    assert bench.commands["wheel/effort"].value == pytest.approx(8.0)
    assert future.result().success


async def test_angle_wraparound_uses_shorter_way(bench):
    facts = {**WHEEL_PARAMETERS, "reference_and_state_interfaces": ["position"]}
    controller = start_wheel(bench, position=3.0, **facts, gains={"wheel": {"p": 1.0, "angle_wraparound": True}})
    publish_reference(bench, -3.0)
    await bench.step(controller)
    assert bench.commands["wheel/effort"].value == pytest.approx(2.0 * pi - 6.0)


async def test_measured_states_can_come_from_topic(bench):
    controller = start_wheel(bench, **WHEEL_PARAMETERS, use_external_measured_states=True, gains={"wheel": {"p": 1.0}})
    publish_reference(bench, 4.0)
    bench.publish(COMMAND, "/controller/measured_state", make_command(["wheel"], [1.0], []))
    await bench.step(controller)
    assert bench.commands["wheel/effort"].value == pytest.approx(3.0)


async def test_chained_mode_accepts_reference_interfaces(bench):
    controller = start_wheel(bench, **BOTH_PARAMETERS, gains={"wheel": {"p": 1.0}})
    assert [reference.name for reference in controller.references] == [
        "controller/wheel/position",
        "controller/wheel/velocity",
    ]
    controller.is_chained = True
    controller.references[0].value = 0.5
    publish_reference(bench, 9.0)
    await bench.step(controller)
    assert bench.commands["wheel/effort"].value == pytest.approx(0.5)
    assert [interface.value for interface in controller.exported] == [0.0, 0.0]


async def test_reference_of_wrong_size_or_names_is_reported(bench):
    controller = start_wheel(bench, **WHEEL_PARAMETERS, gains={"wheel": {"p": 1.0}})
    publish_reference(bench, 1.0, 2.0)
    await bench.step(controller)
    publish_reference(bench, 1.0, names=("arm",))
    await bench.step(controller)
    texts = [str(record.text) for record in bench.log]
    assert "Size of input data names (1) and/or values (2) is not matching the expected size (1)." in texts
    assert "DoF name 'wheel' is not in the message: it has arm." in texts
    assert isnan(bench.commands["wheel/effort"].value)


async def test_controller_state_is_published(bench):
    controller = start_wheel(bench, velocity=1.0, **WHEEL_PARAMETERS, gains={"wheel": {"p": 2.0}})
    states = bench.record("control_msgs/msg/MultiDOFStateStamped", "/controller/controller_state")
    publish_reference(bench, 4.0)
    await bench.step(controller)
    (state,) = states[-1].dof_states
    assert (state.name, state.reference, state.feedback, state.error, state.output) == ("wheel", 4.0, 1.0, 3.0, 6.0)
    assert state.time_step == pytest.approx(0.01)


@pytest.mark.parametrize("saves_integral", [True, False])
async def test_save_i_term_keeps_integral_on_reactivation(bench, saves_integral):
    controller = start_wheel(bench, **WHEEL_PARAMETERS, gains={"wheel": {"i": 1.0, "save_i_term": saves_integral}})
    for _ in range(2):
        controller.on_activate()
        publish_reference(bench, 1.0)
        await bench.step(controller)
        controller.on_deactivate()
    controller.on_activate()
    assert controller._pids[0].integral == pytest.approx(0.02 if saves_integral else 0.0)


async def test_deactivation_sets_effort_to_zero(bench):
    controller = start_wheel(bench, **WHEEL_PARAMETERS, gains={"wheel": {"p": 2.0}})
    publish_reference(bench, 4.0)
    await bench.step(controller)
    controller.on_deactivate()
    assert bench.commands["wheel/effort"].value == 0.0
    controller.on_activate()
    assert isnan(controller.references[0].value)


@pytest.mark.parametrize("missing", ["dof_names", "command_interface", "reference_and_state_interfaces"])
async def test_missing_required_parameter_is_rejected(bench, missing):
    with pytest.raises(LinkwrightError, match=missing):
        bench.make(PidController, **{name: value for name, value in WHEEL_PARAMETERS.items() if name != missing})


async def test_state_and_command_counts_must_match(bench):
    with pytest.raises(ControllerError, match="has to be the same"):
        bench.make(PidController, **WHEEL_PARAMETERS, reference_and_state_dof_names=["a", "b"]).on_configure()
