"""The controller manager: the lifecycle of controllers, and who owns an interface."""

from __future__ import annotations

from math import inf, nan

import pytest

from linkwright.control.controllers import registry
from linkwright.control.controllers.controller import Controller, ControllerError
from linkwright.control.manager.switching import AUTO, BEST_EFFORT, FORCE_AUTO, STRICT
from linkwright.graph.lifecycle.states import ACTIVE, INACTIVE
from tests.control.robots import joint, make_manager, robot

CONTROL = robot(joint("hip", "position velocity") + joint("knee", "position velocity"))
FORWARD = "forward_command_controller/ForwardCommandController"
POSITIONS = {"type": FORWARD, "joints": ["hip", "knee"], "interface_name": "position"}


class LowController(Controller):
    """A controller that moves the hip by its reference."""

    fault: BaseException | None = None
    value = 0.5

    def command_interfaces(self):
        return ["hip/velocity"]

    def reference_interfaces(self):
        return ["speed"]

    def update_references(self, time_ns, period_s):
        self.references[0].value = self.value

    def update(self, time_ns, period_s):
        if self.fault is not None:
            raise self.fault
        self.commands[0].value = self.references[0].value


class HighController(Controller):
    """A controller that commands the reference of ``low``."""

    def command_interfaces(self):
        return ["low/speed"]

    def update(self, time_ns, period_s):
        self.commands[0].value = 2.0


class ReluctantController(Controller):
    def on_configure(self):
        raise ControllerError("it does not like it here")


class BrokenController(Controller):
    def __init__(self, context):
        raise ZeroDivisionError("in the beginning")


@pytest.fixture
def create_manager(graph, monkeypatch):
    """Return a function that creates a manager with the controllers of this file."""
    test_controllers = {
        "t/Low": LowController,
        "t/High": HighController,
        "t/Reluctant": ReluctantController,
        "t/Broken": BrokenController,
    }
    original = registry.controller_class

    def find_class(name):
        return test_controllers.get(name) or original(name)

    monkeypatch.setattr("linkwright.control.manager.manager.controller_class", find_class)

    def make(types=None, text=CONTROL, **parameters):
        types = {"low": "t/Low", "high": "t/High"} if types is None else types
        return make_manager(
            graph, text, {name: {"type": controller_type} for name, controller_type in types.items()}, **parameters
        )

    return make


def start_controllers(manager, *names):
    for name in names:
        assert manager.load(name)
        assert manager.configure(name)


def command_value(manager, name):
    return {command.name: command.value for command in manager.resources.commands([name])}[name]


async def test_controller_lifecycle(create_manager, logged):
    controller_manager = create_manager({"forward": FORWARD}, forward={"joints": ["hip"], "interface_name": "position"})
    start_controllers(controller_manager, "forward")
    assert controller_manager.switch(["forward"], [], STRICT) == (True, "Successfully switched controllers!")
    assert controller_manager.resources.claims == {"hip/position": "forward"}
    controller_manager.controllers["forward"].controller._command = [0.7]
    controller_manager.cycle(10, 0.01)
    controller_manager.cycle(20, 0.01)
    assert controller_manager.resources.states(["hip/position"])[0].value == 0.7
    assert not controller_manager.unload("forward")
    assert logged("ERROR") == ["Could not unload controller with name 'forward' because it is still active"]
    assert controller_manager.switch([], ["forward"], STRICT)[0]
    assert controller_manager.resources.claims == {}
    assert controller_manager.unload("forward")
    assert controller_manager.controllers == {}


async def test_unknown_and_broken_controllers_are_not_loaded(create_manager, logged):
    controller_manager = create_manager({"a": "t/Unknown", "broken": "t/Broken", "low": "t/Low"})
    assert not controller_manager.load("none")
    assert not controller_manager.load("a")
    assert not controller_manager.load("broken")
    assert controller_manager.load("low")
    assert not controller_manager.load("low")
    errors = logged("ERROR")
    assert errors[0] == "The 'type' param was not defined for 'none'."
    assert errors[1] == "Loader for controller 'a' (type 't/Unknown') not found."
    assert "ZeroDivisionError: in the beginning" in errors[3]
    assert errors[4] == "Could not initialize the controller named 'broken'"
    assert errors[5] == "A controller named 'low' was already loaded inside the controller manager"


async def test_controller_can_refuse_transitions(create_manager, logged):
    controller_manager = create_manager({"reluctant": "t/Reluctant"})
    controller_manager.load("reluctant")
    assert not controller_manager.configure("reluctant")
    assert logged("ERROR") == [
        "it does not like it here",
        "After configuring, controller 'reluctant' is in state 'unconfigured' , expected inactive.",
    ]


async def test_command_interface_has_one_owner(create_manager, logged):
    controller_manager = create_manager({"one": FORWARD, "two": FORWARD}, one=POSITIONS, two=POSITIONS)
    start_controllers(controller_manager, "one", "two")
    assert controller_manager.switch(["one"], [], STRICT)[0]
    text = "Resource conflict for controller 'two'. Command interface 'hip/position' is already claimed."
    assert controller_manager.switch(["two"], [], STRICT) == (False, text)
    assert controller_manager.controllers["two"].controller.state is INACTIVE
    assert controller_manager.switch(["two"], ["one"], STRICT)[0]
    assert controller_manager.switch(["one"], [], FORCE_AUTO)[0]
    assert set(controller_manager.resources.claims.values()) == {"one"}
    assert logged("ERROR") == [text]


async def test_unknown_interface_is_reported(create_manager, logged):
    controller_manager = create_manager({"one": FORWARD}, one={**POSITIONS, "interface_name": "effort"})
    start_controllers(controller_manager, "one")
    text = "Can't activate controller 'one': Command interface with key 'hip/effort' does not exist"
    assert controller_manager.switch(["one"], [], STRICT) == (False, text)


async def test_strict_switch_fails_where_best_effort_continues(create_manager, logged):
    controller_manager = create_manager()
    start_controllers(controller_manager, "low")
    assert not controller_manager.switch(["low", "nobody"], [], STRICT)[0]
    assert controller_manager.controllers["low"].is_inactive
    assert controller_manager.switch(["low", "nobody"], [], BEST_EFFORT)[0]
    assert controller_manager.controllers["low"].is_active
    assert controller_manager.switch([], ["nobody"], BEST_EFFORT) == (
        True,
        "Empty activate and deactivate list, not requesting switch",
    )
    assert logged("ERROR") == ["Aborting, no controller is switched! ('STRICT' switch)"]


async def test_chained_controllers_are_ordered_and_activated(create_manager):
    controller_manager = create_manager()
    start_controllers(controller_manager, "low", "high")
    assert list(controller_manager.controllers) == ["high", "low"]
    assert not controller_manager.switch(["high"], [], STRICT)[0]
    assert controller_manager.switch(["low"], [], STRICT)[0]
    controller_manager.cycle(1, 0.01)
    assert command_value(controller_manager, "hip/velocity") == 0.5
    assert controller_manager.switch(["high"], [], STRICT)[0]
    assert controller_manager.controllers["low"].controller.is_chained
    controller_manager.cycle(2, 0.01)
    assert command_value(controller_manager, "hip/velocity") == 2.0
    assert not controller_manager.switch([], ["low"], STRICT)[0]
    assert controller_manager.switch([], ["high"], STRICT)[0]
    assert not controller_manager.controllers["low"].controller.is_chained
    controller_manager.cycle(3, 0.01)
    assert command_value(controller_manager, "hip/velocity") == 0.5


async def test_chain_is_activated_together_or_separately(create_manager):
    controller_manager = create_manager()
    start_controllers(controller_manager, "low", "high")
    assert controller_manager.switch(["high", "low"], [], STRICT)[0]
    assert controller_manager.controllers["low"].controller.is_chained
    assert controller_manager.switch([], ["high", "low"], STRICT)[0]
    assert controller_manager.switch(["high"], [], AUTO)[0]
    assert all(controller.controller.state is ACTIVE for controller in controller_manager.controllers.values())


async def test_controller_that_raises_is_deactivated_and_joints_stop(create_manager, logged):
    controller_manager = create_manager()
    start_controllers(controller_manager, "low", "high")
    controller_manager.switch(["high", "low"], [], STRICT)
    controller_manager.cycle(1, 0.01)
    controller_manager.controllers["low"].controller.fault = RuntimeError("out of luck")
    command = controller_manager.resources.commands(["hip/velocity"])[0]
    controller_manager.cycle(2, 0.01)
    assert command.value == 0.0
    assert [controller.is_active for controller in controller_manager.controllers.values()] == [False, False]
    errors = logged("ERROR")
    assert errors[0].startswith("Caught exception while updating: RuntimeError: out of luck\nTraceback")
    assert errors[1] == "Deactivating controllers : [ low high ] as their update resulted in an error!"


@pytest.mark.parametrize("invalid_value", [nan, inf])
async def test_nan_commands_do_not_reach_hardware(create_manager, logged, invalid_value):
    controller_manager = create_manager()
    start_controllers(controller_manager, "low")
    controller_manager.switch(["low"], [], STRICT)
    controller_manager.cycle(1, 0.01)
    controller_manager.controllers["low"].controller.value = invalid_value
    controller_manager.cycle(2, 0.01)
    assert command_value(controller_manager, "hip/velocity") == 0.0
    assert "'hip/velocity' is not a number" in logged("ERROR")[0]


async def test_commands_with_overflowing_sum_reach_hardware(create_manager, logged):
    controller_manager = create_manager()
    start_controllers(controller_manager, "low")
    controller_manager.switch(["low"], [], STRICT)
    loaded = controller_manager.controllers["low"]
    loaded.controller.commands *= 2  # two commands, whose sum overflows
    loaded.controller.value = 1.5e308
    controller_manager.cycle(1, 0.01)
    assert command_value(controller_manager, "hip/velocity") == 1.5e308
    assert logged("ERROR") == []


async def test_failing_hardware_stops_its_controllers(create_manager, logged):
    controller_manager = create_manager()
    start_controllers(controller_manager, "low", "high")
    controller_manager.switch(["high", "low"], [], STRICT)
    command = controller_manager.resources.commands(["hip/velocity"])[0]
    controller_manager.cycle(1, 0.01)

    def fail(time_ns, period_s):
        raise OSError("the cable is out")

    controller_manager.resources.components["arm"].write = fail
    controller_manager.cycle(2, 0.01)
    assert command.value == 0.0
    assert controller_manager.resources.components["arm"].state.label == "unconfigured"
    assert logged("ERROR") == [
        "Error while writing hardware 'arm': OSError: the cable is out",
        "Deactivating controllers : [ low high ] as their hardware components failed: [ arm ]",
    ]


async def test_hardware_lifecycle(create_manager):
    controller_manager = create_manager()
    start_controllers(controller_manager, "low")
    controller_manager.switch(["low"], [], STRICT)
    assert controller_manager.set_hardware_state("arm", INACTIVE)
    assert controller_manager.controllers["low"].is_inactive
    assert controller_manager.set_hardware_state("arm", ACTIVE)
    assert controller_manager.switch(["low"], [], STRICT)[0]


async def test_slower_controller_is_updated_at_its_own_rate(create_manager):
    controller_manager = create_manager({"low": "t/Low"}, low={"update_rate": 50})
    start_controllers(controller_manager, "low")
    times = []
    controller_manager.controllers["low"].controller.update = lambda time_ns, period_s: times.append(
        (time_ns, period_s)
    )
    controller_manager.switch(["low"], [], STRICT)
    for tick in range(1, 6):
        controller_manager.cycle(tick * 10_000_000, 0.01)
    assert times == [(10_000_000, 0.02), (30_000_000, 0.02), (50_000_000, 0.02)]


async def test_hardware_initial_states_are_applied(graph, logged):
    states = {"hardware_components_initial_state": {"inactive": ["arm"], "unconfigured": ["leg"]}}
    controller_manager = make_manager(graph, CONTROL, states)
    assert controller_manager.resources.components["arm"].state is INACTIVE
    assert logged("WARN") == ["Hardware component 'leg' is unknown, therefore not set in 'unconfigured' state."]


async def test_unsupported_hardware_is_replaced_by_mock(graph, logged):
    controller_manager = make_manager(graph, CONTROL.replace("mock_components/GenericSystem", "acme/Driver"))
    assert controller_manager.resources.components["arm"].state is ACTIVE
    assert logged("WARN")[0].startswith("hardware 'arm': Linkwright does not support 'acme/Driver', so a mock replaces")


@pytest.mark.parametrize("distribution", ["humble", "jazzy"])
async def test_async_controllers_and_hardware_run_synchronously_with_notice(
    create_manager, logged, monkeypatch, distribution
):
    monkeypatch.setenv("ROS_DISTRO", distribution)
    text = CONTROL.replace("type='system'", "type='system' is_async='true'")
    controller_manager = create_manager({"low": "t/Low"}, text, low={"is_async": True})
    start_controllers(controller_manager, "low")
    assert controller_manager.switch(["low"], [], STRICT)[0]
    controller_manager.cycle(1, 0.01)
    assert command_value(controller_manager, "hip/velocity") == 0.5
    lines = [line for line in logged("INFO") if "is_async" in line]
    assert (
        lines[0] == "hardware 'arm': is_async is not supported, so the hardware is read and written in the control loop"
    )
    assert len(lines) == (1 if distribution == "humble" else 2)
