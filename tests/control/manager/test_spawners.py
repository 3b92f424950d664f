"""The spawner and the unspawner of controllers."""

from __future__ import annotations

import pytest

from linkwright.control.nodes.hardware_spawner import HardwareSpawner
from linkwright.control.nodes.spawner import Spawner, Unspawner
from linkwright.diagnostics import LinkwrightError
from linkwright.nodes.options import NodeOptions
from tests.control.manager.test_ros2_control_node import CONTROL, start_manager_node

CONTROLLER_FILE = """
positions:
  ros__parameters:
    type: forward_command_controller/ForwardCommandController
    joints: [knee]
    interface_name: position
"""


async def run_program(graph, program, *words):
    """Run a program, and return its exit status."""
    program_node = program(graph, NodeOptions(arguments=list(words)))
    await graph.settle()
    status = program_node.finished.result() if program_node.finished.done() else None
    program_node.close()
    return status


def controller_states(manager_node):
    return {name: loaded.controller.state.label for name, loaded in manager_node._manager.controllers.items()}


async def test_controllers_are_spawned_and_unspawned(graph, tmp_path, logged):
    manager_node = start_manager_node(graph, tmp_path, CONTROL)
    assert await run_program(graph, Spawner, "broadcaster", "positions", "-c", "controller_manager") == 0
    assert controller_states(manager_node) == {"broadcaster": "active", "positions": "active"}
    lines = [line for line in logged("INFO") if line.startswith(("Loaded", "Configured and"))]
    assert lines == [
        "Loaded broadcaster",
        "Configured and activated broadcaster",
        "Loaded positions",
        "Configured and activated positions",
    ]
    assert await run_program(graph, Unspawner, "positions") == 0
    assert controller_states(manager_node) == {"broadcaster": "active"}
    assert await run_program(graph, Unspawner, "positions") == 1
    manager_node.close()


@pytest.mark.parametrize(
    ("option", "state"),
    [("--load-only", "unconfigured"), ("--inactive", "inactive"), ("--activate-as-group", "active")],
)
async def test_spawner_options_select_final_state(graph, tmp_path, option, state):
    manager_node = start_manager_node(graph, tmp_path, CONTROL)
    assert await run_program(graph, Spawner, "broadcaster", option) == 0
    assert controller_states(manager_node) == {"broadcaster": state}
    manager_node.close()


async def test_spawner_accepts_parameter_file_and_remappings(graph, tmp_path, logged):
    manager_node = start_manager_node(graph, tmp_path, CONTROL)
    path = tmp_path / "own.yaml"
    path.write_text(CONTROLLER_FILE)
    arguments = ("--param-file", str(path), "--controller-ros-args", "-r ~/commands:=/other")
    assert await run_program(graph, Spawner, "positions", *arguments) == 0
    assert manager_node._manager.resources.claims == {"knee/position": "positions"}
    assert "/other" in graph.topics()
    manager_node.close()


@pytest.mark.parametrize(
    "arguments", [("", "broadcaster"), ("broadcaster", "--namespace", "", "-c", "controller_manager")]
)
async def test_spawner_ignores_empty_arguments(graph, tmp_path, arguments):
    manager_node = start_manager_node(graph, tmp_path, CONTROL)
    assert await run_program(graph, Spawner, *arguments) == 0
    assert controller_states(manager_node) == {"broadcaster": "active"}
    manager_node.close()


async def test_spawner_failures_are_reported(graph, tmp_path, logged):
    manager_node = start_manager_node(graph, tmp_path, CONTROL)
    assert await run_program(graph, Spawner, "nobody") == 1
    assert logged("FATAL") == ["Failed loading controller nobody"]
    with pytest.raises(LinkwrightError, match=r"'/no/file\.yaml' does not exist"):
        Spawner(graph, NodeOptions(arguments=["broadcaster", "-p", "/no/file.yaml"]))
    with pytest.raises(LinkwrightError, match="--no-option"):
        Spawner(graph, NodeOptions(arguments=["broadcaster", "--no-option"]))
    manager_node.close()


async def test_spawner_waits_for_controller_manager(graph, clock, tmp_path, logged):
    spawner = Spawner(graph, NodeOptions(arguments=["broadcaster"]))
    await graph.settle()
    assert logged("INFO") == ["waiting for service /controller_manager/list_controllers to become available..."]
    await clock.advance(11.0)
    assert logged("WARN") == ["Could not contact service /controller_manager/list_controllers"]
    manager_node = start_manager_node(graph, tmp_path, CONTROL)
    await graph.settle()
    assert spawner.finished.result() == 0
    spawner.close()
    manager_node.close()


async def test_controller_manager_timeout_ends_waiting(graph, clock, logged):
    spawner = Spawner(graph, NodeOptions(arguments=["broadcaster", "--controller-manager-timeout", "5"]))
    await graph.settle()
    await clock.advance(5.1)
    assert spawner.finished.result() == 1
    assert logged("FATAL") == ["Could not contact service /controller_manager/list_controllers"]
    spawner.close()


async def test_unload_on_kill_removes_controllers(graph, tmp_path):
    manager_node = start_manager_node(graph, tmp_path, CONTROL)
    spawner = Spawner(graph, NodeOptions(arguments=["broadcaster", "-u"]))
    await graph.settle()
    assert controller_states(manager_node) == {"broadcaster": "active"}
    spawner.close()
    await graph.settle()
    assert controller_states(manager_node) == {}
    manager_node.close()


async def test_hardware_is_spawned(graph, tmp_path, logged):
    manager_node = start_manager_node(
        graph, tmp_path, CONTROL, hardware_components_initial_state={"unconfigured": ["arm"]}
    )
    assert await run_program(graph, HardwareSpawner, "arm", "--configure") == 0
    assert manager_node._manager.resources.components["arm"].state.label == "inactive"
    assert await run_program(graph, HardwareSpawner, "arm", "leg", "--activate") == 1
    assert manager_node._manager.resources.components["arm"].state.label == "active"
    assert logged("WARN")[1:] == ["Hardware Component is not loaded - state can not be changed."]
    manager_node.close()
