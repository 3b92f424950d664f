"""``linkwright control``: the output of ros2 about controllers and hardware."""

from __future__ import annotations

import asyncio

import pytest

from linkwright.cli import calls, control, main
from linkwright.control.nodes.ros2_control_node import Ros2ControlNode
from linkwright.graph import Graph
from linkwright.nodes import NodeOptions
from tests.control.robots import joint, robot

POSITIONS = {"joints": ["hip"], "interface_name": "position"}


@pytest.fixture
def run_manager(add_to_graph, tmp_path):
    """Run a manager whose controllers have these states."""
    path = tmp_path / "c.yaml"
    path.write_text("positions: {ros__parameters: {joints: [hip], interface_name: position}}")

    def use(state: str = "") -> None:
        def make(graph: Graph) -> None:
            parameters = {
                "robot_description": robot(joint("hip")),
                "broadcaster": {"type": "joint_state_broadcaster/JointStateBroadcaster"},
                "positions": {"type": "forward_command_controller/ForwardCommandController"},
            }
            words = ["--ros-args", "--params-file", str(path)]
            running = Ros2ControlNode(graph, NodeOptions(parameters=parameters, arguments=words))
            if state:
                for name in ("positions", "broadcaster"):
                    assert running._manager.load(name)
                    assert state == "unconfigured" or running._manager.configure(name)
                assert state != "active" or running._manager.switch(["positions", "broadcaster"], [])[0]

        add_to_graph(make)

    return use


def run_command(capsys, *words: str, status: int = 0) -> str:
    assert main(["control", *words]) == status
    captured = capsys.readouterr()
    return captured.err if status else captured.out


def test_list_controllers_prints_states(run_manager, capsys):
    run_manager()
    assert run_command(capsys, "list_controllers") == "No controllers are currently loaded!\n"
    run_manager("active")
    assert run_command(capsys, "list_controllers").splitlines() == [
        "positions   forward_command_controller/ForwardCommandController  active",
        "broadcaster joint_state_broadcaster/JointStateBroadcaster        active",
    ]
    lines = run_command(capsys, "list_controllers", "--claimed-interfaces").splitlines()
    assert lines[1:3] == ["\tclaimed interfaces:", "\t\thip/position"]
    assert "\texported reference interfaces:" in run_command(capsys, "list_controllers", "-v").splitlines()


def test_controller_types_and_hardware_are_listed(run_manager, capsys):
    run_manager("active")
    types = run_command(capsys, "list_controller_types")
    name = "joint_state_broadcaster/JointStateBroadcaster"
    assert f"{name:70s} controller_interface::ControllerInterface" in types.splitlines()
    assert run_command(capsys, "list_hardware_components").splitlines() == [
        "Hardware Component 1",
        "\tname: arm",
        "\ttype: system",
        "\tplugin name: mock_components/GenericSystem",
        "\tstate: id=3 label=active",
        "\tcommand interfaces",
        "\t\thip/position [available] [claimed]",
    ]
    assert run_command(capsys, "list_hardware_interfaces").splitlines() == [
        "command interfaces",
        "\thip/position [available] [claimed]",
        "state interfaces",
        "\thip/position",
        "\thip/velocity",
    ]


def test_load_and_unload_controller_report_result(run_manager, capsys):
    run_manager()
    assert run_command(capsys, "load_controller", "positions") == "Successfully loaded controller positions\n"
    assert run_command(capsys, "load_controller", "positions", "--set-state", "active").endswith("into state active\n")
    assert run_command(capsys, "load_controller", "nobody", status=1).endswith("check controller_manager logs\n")
    run_manager("inactive")
    assert run_command(capsys, "unload_controller", "positions") == "Successfully unloaded controller positions\n"
    assert run_command(capsys, "reload_controller_libraries") == "Reload successful\n"
    run_manager("active")
    assert "Error unloading controller positions" in run_command(capsys, "unload_controller", "positions", status=1)
    assert "Error reloading" in run_command(capsys, "reload_controller_libraries", status=1)


def test_controller_of_parameter_file_is_loaded(run_manager, capsys, tmp_path):
    run_manager()
    path = tmp_path / "extra.yaml"
    kind = "forward_command_controller/ForwardCommandController"
    path.write_text(f"extra: {{ros__parameters: {{type: {kind}, joints: [hip], interface_name: position}}}}")
    output = run_command(capsys, "load_controller", "extra", str(path), "--set-state", "inactive")
    assert output == "Successfully loaded controller extra into state inactive\n"
    assert "no.yaml" in run_command(capsys, "load_controller", "other", str(tmp_path / "no.yaml"), status=1)


def test_controller_state_names_before_humble_are_accepted(run_manager, capsys):
    run_manager()
    assert run_command(capsys, "load_controller", "positions", "--set-state", "start").endswith("into state active\n")
    run_manager("active")
    assert run_command(capsys, "set_controller_state", "positions", "stop") == "Successfully deactivated positions\n"


def test_set_controller_state_changes_state(run_manager, capsys):
    run_manager("unconfigured")
    assert run_command(capsys, "set_controller_state", "positions", "inactive") == "Successfully configured positions\n"
    output = run_command(capsys, "set_controller_state", "positions", "active", status=1)
    assert output.endswith("cannot activate positions from its current state unconfigured\n")
    run_manager("inactive")
    assert run_command(capsys, "set_controller_state", "positions", "active") == "Successfully activated positions\n"
    assert run_command(capsys, "cleanup_controller", "positions") == "Successfully cleaned up positions\n"
    run_manager("active")
    assert (
        run_command(capsys, "set_controller_state", "positions", "inactive") == "Successfully deactivated positions\n"
    )
    output = run_command(capsys, "set_controller_state", "nobody", "inactive", status=1)
    assert output.endswith("controller nobody does not seem to be loaded\n")


def test_switch_controllers_reports_result(run_manager, capsys):
    run_manager("active")
    words = ("switch_controllers", "--deactivate", "positions", "--strict")
    assert run_command(capsys, *words) == "Successfully switched controllers\n"
    output = run_command(capsys, "switch_controllers", "--activate", "nobody", "--strict", status=1)
    assert output.endswith("Error switching controllers, check controller_manager logs\n")


def test_set_hardware_component_state_changes_state(run_manager, capsys):
    run_manager("active")
    output = run_command(capsys, "set_hardware_component_state", "arm", "inactive")
    assert output.startswith("Successfully set arm to state lifecycle_msgs.msg.State(id=2, label='inactive')")
    output = run_command(capsys, "set_hardware_component_state", "leg", "inactive", status=1)
    assert output.endswith("component leg does not seem to be loaded\n")


def test_view_controller_chains_writes_diagram(run_manager, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run_manager("active")
    assert run_command(capsys, "view_controller_chains").startswith("Saved controller diagram to")
    text = (tmp_path / "controller_diagram.gv").read_text()
    assert '"positions" -> "hw command_interfaces" [label="hip/position"];' in text


def test_list_controllers_waits_for_late_controller_manager(add_to_graph, capsys, monkeypatch):
    monkeypatch.setattr(calls, "SERVICE_TIMEOUT_S", 0.0)

    def later(graph: Graph) -> None:
        parameters = {"robot_description": robot(joint("hip"))}
        asyncio.get_running_loop().call_later(0.2, lambda: Ros2ControlNode(graph, NodeOptions(parameters=parameters)))

    add_to_graph(later)
    assert run_command(capsys, "list_controllers") == "No controllers are currently loaded!\n"


def test_controller_manager_option_selects_manager(run_manager, capsys, monkeypatch):
    monkeypatch.setattr(calls, "SERVICE_TIMEOUT_S", 0.3)
    monkeypatch.setattr(control, "MANAGER_EXTRA_WAIT_S", 0.2)
    run_manager()
    output = run_command(capsys, "list_controllers", "-c", "/robot/controller_manager", status=1)
    service = "/robot/controller_manager/list_controllers"
    waiting, found = f"waiting for service '{service}' to become available...", f"there is no service '{service}'"
    assert 0 <= output.find(waiting) < output.find(found)
