"""The documentation of controllers: the example runs, and every parameter is documented."""

from __future__ import annotations

import re
import sys
from dataclasses import fields, is_dataclass
from pathlib import Path
from types import ModuleType
from typing import Any, get_type_hints

import pytest

from linkwright.control.controllers.admittance_controller import AdmittanceController
from linkwright.control.controllers.battery_state_broadcaster import BatteryStateBroadcaster
from linkwright.control.controllers.chained_filter_controller import ChainedFilterController
from linkwright.control.controllers.gpio_command_controller import GpioCommandController
from linkwright.control.controllers.gripper_action_controller import EffortGripper, ParallelGripper, PositionGripper
from linkwright.control.controllers.joint_trajectory_controller import JointTrajectoryController
from linkwright.control.controllers.motion_primitives_controller import MotionPrimitivesForwardController
from linkwright.control.controllers.pid_controller import PidController
from linkwright.control.controllers.registry import GROUP, controller_class
from linkwright.control.controllers.sensor_broadcasters import (
    ForceTorqueBroadcaster,
    GpsBroadcaster,
    ImuBroadcaster,
    MagnetometerBroadcaster,
    PoseBroadcaster,
    RangeBroadcaster,
)
from linkwright.control.controllers.state_interfaces_broadcaster import StateInterfacesBroadcaster
from linkwright.control.manager.switching import STRICT
from linkwright.diagnostics import LinkwrightError
from linkwright.loading import extensions
from linkwright.messages import get_message
from linkwright.packages.readers.entry_points import read_pyproject_group
from tests.control.robots import joint, make_manager, robot

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGES = [DOCS / "control.md", DOCS / "zh" / "control.md"]
DOCUMENTED = [
    *(JointTrajectoryController, PidController, PositionGripper, EffortGripper, ParallelGripper),
    *(ImuBroadcaster, ForceTorqueBroadcaster, RangeBroadcaster, PoseBroadcaster, GpsBroadcaster),
    *(MagnetometerBroadcaster, BatteryStateBroadcaster, StateInterfacesBroadcaster, GpioCommandController),
    *(ChainedFilterController, AdmittanceController, MotionPrimitivesForwardController),
]


def code_block(text: str, language: str, text_inside: str) -> str:
    """Return the code block of a page in a language that contains a text."""
    code_blocks: list[str] = re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)
    (block,) = (block for block in code_blocks if text_inside in block)
    return block


def load_example(page: Path) -> Any:
    """Return the example controller of a page."""
    code = code_block(page.read_text("utf-8"), "python", "class Swing(")
    module = ModuleType("my_controllers.swing")
    exec(compile(code, str(page), "exec", dont_inherit=True), module.__dict__)
    return module.__dict__["Swing"]


@pytest.mark.parametrize("page", PAGES, ids=["en", "zh"])
async def test_documented_example_swings_joint(bench, page):
    bench.joint("elbow", commands=("position",), position=1.0)
    controller = bench.start(load_example(page), "swing", joint="elbow", amplitude=0.3, frequency=1.0, speed=2.0)
    angles = bench.record("std_msgs/msg/Float64", "/swing/angle")
    await bench.step(controller, count=25)
    assert bench.commands["elbow/position"].value == pytest.approx(1.3)
    assert angles[-1].data == pytest.approx(0.3)
    bench.publish("std_msgs/msg/Float64", "/swing/amplitude", get_message("std_msgs/msg/Float64")(data=0.1))
    await bench.step(controller, count=50)
    assert bench.commands["elbow/position"].value == pytest.approx(0.9)
    assert "'speed' is not a parameter of this controller" in [str(record.text) for record in bench.log]


@pytest.fixture
def installed_package(tmp_path, monkeypatch):
    """Install the package of the page's example."""
    text = PAGES[0].read_text("utf-8")
    code = code_block(text, "python", "class Swing(")
    entry_point = code_block(text, "toml", '"linkwright.controllers"')
    package, facts = tmp_path / "my_controllers", tmp_path / "my_controllers-1.0.dist-info"
    package.mkdir()
    facts.mkdir()
    (package / "__init__.py").touch()
    (package / "swing.py").write_text(code, encoding="utf-8")
    lines = [f"[{GROUP}]", *read_pyproject_group(entry_point, GROUP), "my/Broken = nowhere:None"]
    (facts / "entry_points.txt").write_text("\n".join(lines))
    monkeypatch.syspath_prepend(str(tmp_path))
    extensions._read_all_groups.cache_clear()
    yield
    monkeypatch.undo()
    extensions._read_all_groups.cache_clear()
    for name in ("my_controllers.swing", "my_controllers"):
        sys.modules.pop(name, None)


@pytest.mark.usefixtures("installed_package")
async def test_manager_runs_controller_of_package(graph):
    text = robot(joint("hip") + joint("knee"))
    controller_manager = make_manager(
        graph, text, {"swing": {"type": "my_controllers/Swing"}}, swing={"joint": "hip", "frequency": 1.0}
    )
    assert controller_manager.load("swing")
    assert controller_manager.configure("swing")
    assert controller_manager.switch(["swing"], [], STRICT)[0]
    for number in range(1, 26):
        controller_manager.cycle(number * 10_000_000, 0.01)
    assert controller_manager.resources.commands(["hip/position"])[0].value == pytest.approx(0.2)


@pytest.mark.usefixtures("installed_package")
def test_package_with_import_error_is_reported_by_name():
    with pytest.raises(LinkwrightError) as error:
        controller_class("my/Broken")
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "CTL104"
    assert "my_controllers" in str(diagnostic.hint)


def parameter_names(table: Any) -> set[str]:
    """Return the parameters of a table and of its nested tables."""
    hints = get_type_hints(table)
    found_names: set[str] = set()
    for field in fields(table):
        nested = field.metadata.get("table") or (hints[field.name] if is_dataclass(hints[field.name]) else None)
        found_names |= {field.name} if nested is None else parameter_names(nested)
    return found_names


@pytest.mark.parametrize("page", PAGES, ids=["en", "zh"])
def test_controller_parameters_are_documented(page):
    documented_names = set(re.findall(r"[a-z_]+", page.read_text("utf-8")))
    for controller in DOCUMENTED:
        assert parameter_names(controller.PARAMETERS) - set("xyzw") <= documented_names, controller
