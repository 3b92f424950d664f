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
def outputs(bench):
    """Return a test bench with a tool with two outputs and lamps with two inputs."""
    bench.joint("tool", commands=("valve", "pump"), valve=0.0)
    bench.joint("lamps", red=1.0, green=0.0)
    return bench


def group(**gpios: dict[str, float]):
    value = get_message("control_msgs/msg/InterfaceValue")
    values = [value(interface_names=list(names), values=list(names.values())) for names in gpios.values()]
    return get_message(TYPE)(interface_groups=list(gpios), interface_values=values)


def test_controller_is_found_by_type():
    assert controller_class("gpio_controllers/GpioCommandController") is GpioCommandController


async def test_commands_are_forwarded_and_states_published(outputs):
    states = {"state_interfaces": {"tool": {"interfaces": ["valve"]}}}
    controller = outputs.start(GpioCommandController, **SETTINGS, **states)
    messages = outputs.record(TYPE, "/controller/gpio_states")
    outputs.publish(TYPE, "/controller/commands", group(tool={"pump": 1.0}))
    await outputs.step(controller, count=2)
    assert outputs.commands["tool/pump"].value == 1.0
    assert outputs.commands["tool/valve"].value != outputs.commands["tool/valve"].value  # without a command
    assert messages[-1].interface_groups == ["tool", "lamps"]
    assert [list(item.interface_names) for item in messages[-1].interface_values] == [["valve"], []]
    assert list(messages[-1].interface_values[0].values) == [0.0]


async def test_states_of_description_are_published_by_default(outputs):
    controller = outputs.activate(outputs.make(GpioCommandController, description=DESCRIPTION, **GPIOS))
    messages = outputs.record(TYPE, "/controller/gpio_states")
    await outputs.step(controller)
    assert [list(item.interface_names) for item in messages[-1].interface_values] == [[], ["red", "green"]]
    assert list(messages[-1].interface_values[1].values) == [1.0, 0.0]


@pytest.mark.parametrize(
    ("message", "reported"),
    [
        (group(tool={"pump": nan}), "a command with NaN is not forwarded"),
        (group(tool={"horn": 1.0}), "'tool/horn' is not a command interface of this controller"),
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
async def test_invalid_commands_are_reported(outputs, message, reported):
    controller = outputs.start(GpioCommandController, **SETTINGS)
    outputs.publish(TYPE, "/controller/commands", message)
    await outputs.step(controller)
    assert reported in [str(record.text) for record in outputs.log]
    assert outputs.commands["tool/pump"].value != outputs.commands["tool/pump"].value


async def test_controller_without_interfaces_is_rejected(outputs):
    with pytest.raises(ControllerError, match="No command or state interfaces are configured"):
        outputs.make(GpioCommandController, **GPIOS).on_configure()
    with pytest.raises(LinkwrightError, match="'gpios' contains 'tool' twice"):
        outputs.make(GpioCommandController, "second", gpios=["tool", "tool"])
