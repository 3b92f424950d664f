"""Commands and states of inputs and outputs."""

from __future__ import annotations

from math import nan

import pytest

from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.gpio_command_controller import GpioCommandController
from linkwright.control.controllers.registry import controller_class
from linkwright.diagnostics import LinkwrightError
from linkwright.messages import get_message

TYPE = "control_msgs/msg/DynamicInterfaceGroupValues"
GPIOS = {"gpios": ["tool", "lamps"]}
SETTINGS = {**GPIOS, "command_interfaces": {"tool": {"interfaces": ["valve", "pump"]}}}
DESCRIPTION = """<robot name="r"><link name="base"/>
<ros2_control name="s" type="system"><hardware><plugin>mock_components/GenericSystem</plugin></hardware>
  <gpio name="lamps"><state_interface name="red"/><state_interface name="green"/></gpio>
  <gpio name="other"><state_interface name="blue"/></gpio>
</ros2_control></robot>"""


@pytest.fixture
def gpio_bench(bench):
    """Return a test bench with a tool with two outputs and lamps with two inputs."""
    bench.joint("tool", commands=("valve", "pump"), valve=0.0)
    bench.joint("lamps", red=1.0, green=0.0)
    return bench


def make_group(**gpios: dict[str, float]):
    value = get_message("control_msgs/msg/InterfaceValue")
    values = [value(interface_names=list(names), values=list(names.values())) for names in gpios.values()]
    return get_message(TYPE)(interface_groups=list(gpios), interface_values=values)


def test_controller_is_found_by_type():
    assert controller_class("gpio_controllers/GpioCommandController") is GpioCommandController


async def test_commands_are_forwarded_and_states_published(gpio_bench):
    states = {"state_interfaces": {"tool": {"interfaces": ["valve"]}}}
    controller = gpio_bench.start(GpioCommandController, **SETTINGS, **states)
    messages = gpio_bench.record(TYPE, "/controller/gpio_states")
    gpio_bench.publish(TYPE, "/controller/commands", make_group(tool={"pump": 1.0}))
    await gpio_bench.step(controller, count=2)
    assert gpio_bench.commands["tool/pump"].value == 1.0
    assert gpio_bench.commands["tool/valve"].value != gpio_bench.commands["tool/valve"].value  # without a command
    assert messages[-1].interface_groups == ["tool", "lamps"]
    assert [list(item.interface_names) for item in messages[-1].interface_values] == [["valve"], []]
    assert list(messages[-1].interface_values[0].values) == [0.0]


async def test_states_of_description_are_published_by_default(gpio_bench):
    controller = gpio_bench.activate(gpio_bench.make(GpioCommandController, description=DESCRIPTION, **GPIOS))
    messages = gpio_bench.record(TYPE, "/controller/gpio_states")
    await gpio_bench.step(controller)
    assert [list(item.interface_names) for item in messages[-1].interface_values] == [[], ["red", "green"]]
    assert list(messages[-1].interface_values[1].values) == [1.0, 0.0]


@pytest.mark.parametrize(
    ("message", "reported"),
    [
        (make_group(tool={"pump": nan}), "a command with NaN is not forwarded"),
        (make_group(tool={"horn": 1.0}), "'tool/horn' is not a command interface of this controller"),
        (get_message(TYPE)(interface_groups=["tool"]), "a command has 1 GPIO, but values for 0"),
        (
            get_message(TYPE)(
                interface_groups=["tool"],
                interface_values=[get_message("control_msgs/msg/InterfaceValue")(interface_names=["pump"])],
            ),
            "For gpio tool interfaces_names do not match values",
        ),
    ],
)
async def test_invalid_commands_are_reported(gpio_bench, message, reported):
    controller = gpio_bench.start(GpioCommandController, **SETTINGS)
    gpio_bench.publish(TYPE, "/controller/commands", message)
    await gpio_bench.step(controller)
    assert reported in [str(record.text) for record in gpio_bench.log]
    assert gpio_bench.commands["tool/pump"].value != gpio_bench.commands["tool/pump"].value


async def test_controller_without_interfaces_is_rejected(gpio_bench):
    with pytest.raises(ControllerError, match="No command or state interfaces are configured"):
        gpio_bench.make(GpioCommandController, **GPIOS).on_configure()
    with pytest.raises(LinkwrightError, match="'gpios' contains 'tool' twice"):
        gpio_bench.make(GpioCommandController, "second", gpios=["tool", "tool"])
