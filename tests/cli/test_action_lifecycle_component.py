"""``linkwright action``, ``lifecycle`` and ``component``: the output of ros2, and errors."""

from __future__ import annotations

import asyncio
import re
import signal
from typing import Any

import pytest

from linkwright.cli import main
from linkwright.graph import ActionServer, Graph
from linkwright.graph.actions.goal import GoalResponse
from linkwright.graph.lifecycle.managed_node import LifecycleNodeMixin
from linkwright.messages import get_action
from linkwright.nodes import NodeOptions
from linkwright.nodes.component_container import ComponentContainer


def run_command(capsys, *words: str, status: int = 0) -> tuple[str, str]:
    assert main(list(words)) == status
    captured = capsys.readouterr()
    return captured.out, captured.err


# action


def serve_fibonacci(graph: Graph) -> None:
    node = graph.create_node("fibonacci_action_server")
    kind = get_action("example_interfaces/action/Fibonacci")

    async def execute(goal: Any) -> Any:
        feedback = kind.Feedback()
        sequence = [0, 1]
        for _ in range(goal.request.order - 1):
            sequence.append(sequence[-1] + sequence[-2])
            feedback.sequence = sequence
            goal.publish_feedback(feedback)
            await asyncio.sleep(0.01)
        goal.succeed()
        return kind.Result(sequence=sequence)

    ActionServer(node, kind, "fibonacci", execute, goal_callback=lambda goal: _accept_positive_orders(goal.order))


def _accept_positive_orders(order: int) -> GoalResponse:
    return GoalResponse.ACCEPT if order < 20 else GoalResponse.REJECT


GOAL = ["action", "send_goal", "/fibonacci", "example_interfaces/action/Fibonacci"]


def test_action_list_info_and_type_print_action(add_to_graph, capsys):
    add_to_graph(serve_fibonacci)
    assert run_command(capsys, "action", "list")[0] == "/fibonacci\n"
    assert run_command(capsys, "action", "list", "-t")[0] == "/fibonacci [example_interfaces/action/Fibonacci]\n"
    assert run_command(capsys, "action", "list", "-c")[0] == "1\n"
    assert run_command(capsys, "action", "type", "/fibonacci")[0] == "example_interfaces/action/Fibonacci\n"
    assert "did you mean '/fibonacci'?" in run_command(capsys, "action", "type", "/fibonaci", status=1)[1]
    assert run_command(capsys, "action", "info", "/fibonacci")[0] == (
        "Action: /fibonacci\nAction clients: 0\nAction servers: 1\n    /fibonacci_action_server\n"
    )
    assert run_command(capsys, "action", "info", "-t", "/fibonacci")[0].splitlines()[-1] == (
        "    /fibonacci_action_server [example_interfaces/action/Fibonacci]"
    )
    assert run_command(capsys, "action", "info", "-c", "/nothing")[0] == (
        "Action: /nothing\nAction clients: 0\nAction servers: 0\n"
    )


def test_action_topics_and_services_are_hidden(add_to_graph, capsys):
    add_to_graph(serve_fibonacci)
    assert "/_action/" not in run_command(capsys, "topic", "list")[0]
    assert "/_action/" not in run_command(capsys, "service", "list")[0]
    assert (
        "    /fibonacci: example_interfaces/action/Fibonacci"
        in run_command(capsys, "node", "info", "/fibonacci_action_server")[0]
    )


def test_send_goal_prints_goal_and_result(add_to_graph, capsys):
    add_to_graph(serve_fibonacci)
    out, _ = run_command(capsys, *GOAL, "{order: 3}")
    assert re.fullmatch(
        r"Waiting for an action server to become available\.\.\.\n"
        r"Sending goal:\n     order: 3\n\n"
        r"Goal accepted with ID: [0-9a-f]{32}\n\n"
        r"Result:\n    sequence:\n- 0\n- 1\n- 1\n- 2\n\n"
        r"Goal finished with status: SUCCEEDED\n",
        out,
    ), out


def test_send_goal_prints_feedback(add_to_graph, capsys):
    add_to_graph(serve_fibonacci)
    out, _ = run_command(capsys, *GOAL, "{order: 3}", "--feedback")
    assert "Feedback:\n    sequence:\n- 0\n- 1\n- 1\n\n" in out


def test_send_goal_reports_rejected_goal(add_to_graph, capsys):
    add_to_graph(serve_fibonacci)
    assert run_command(capsys, *GOAL, "{order: 30}", status=1)[0].endswith("Goal was rejected.\n")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["/fibonacci", "example_interfaces/action/Fibonaci"], "did you mean"),
        (["/fibonacci", "example_interfaces/action/Fibonacci", "{ordr: 1}"], "did you mean 'order'?"),
        (["/no", "example_interfaces/action/Fibonacci", "{}", "--timeout", "0.1"], "no server of action '/no'"),
    ],
)
def test_send_goal_reports_invalid_arguments(add_to_graph, capsys, words, message):
    add_to_graph(serve_fibonacci)
    assert message in run_command(capsys, "action", "send_goal", *words, status=1)[1]


# lifecycle


class ManagedNode(LifecycleNodeMixin):
    """A managed node in the graph."""

    def __init__(self, graph: Graph, name: str) -> None:
        self._node = graph.create_node(name)
        LifecycleNodeMixin.__init__(self)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._node, name)


def create_camera_node(graph: Graph) -> None:
    ManagedNode(graph, "camera")
    graph.create_node("other")


def test_lifecycle_nodes_prints_managed_nodes(add_to_graph, capsys):
    add_to_graph(create_camera_node)
    assert run_command(capsys, "lifecycle", "nodes")[0] == "/camera\n"
    assert run_command(capsys, "lifecycle", "nodes", "-c")[0] == "1\n"


def test_lifecycle_get_prints_state(add_to_graph, capsys):
    add_to_graph(create_camera_node)
    assert run_command(capsys, "lifecycle", "get", "/camera")[0] == "unconfigured [1]\n"
    assert run_command(capsys, "lifecycle", "get")[0] == "/camera: unconfigured [1]\n"
    assert "Node not found" in run_command(capsys, "lifecycle", "get", "/nothing", status=1)[1]


def test_lifecycle_list_prints_transitions(add_to_graph, capsys):
    add_to_graph(create_camera_node)
    assert run_command(capsys, "lifecycle", "list", "camera")[0].splitlines() == [
        "- configure [1]",
        "\tStart: unconfigured",
        "\tGoal: configuring",
        "- shutdown [5]",
        "\tStart: unconfigured",
        "\tGoal: shuttingdown",
    ]
    all_transitions = run_command(capsys, "lifecycle", "list", "-a", "camera")[0].splitlines()
    assert len(all_transitions) == 3 * 25


def test_lifecycle_set_changes_state(add_to_graph, capsys):
    add_to_graph(create_camera_node)
    assert run_command(capsys, "lifecycle", "set", "/camera", "configure")[0] == "Transitioning successful\n"
    _, err = run_command(capsys, "lifecycle", "set", "/camera", "configur", status=1)
    assert "Unknown transition requested" in err
    assert "- shutdown [5]" in err
    assert "did you mean 'configure'?" in err


# component


def create_container(graph: Graph) -> None:
    loaded = ComponentContainer(graph, NodeOptions(name="box"))
    loaded.load("demo_nodes_cpp", "demo_nodes_cpp::Talker", NodeOptions(name="talker"))


def test_component_types_prints_registered_types(capsys):
    out, _ = run_command(capsys, "component", "types")
    assert "demo_nodes_cpp\n  demo_nodes_cpp::Listener\n  demo_nodes_cpp::Talker" in out
    assert "did you mean" in run_command(capsys, "component", "types", "demo_nodes_cp", status=1)[1]


def test_component_list_prints_containers_and_components(add_to_graph, capsys):
    add_to_graph(create_container)
    assert run_command(capsys, "component", "list")[0] == "/box\n  1  /talker\n"
    assert run_command(capsys, "component", "list", "--containers-only")[0] == "/box\n"
    assert run_command(capsys, "component", "list", "/box")[0] == "1  /talker\n"
    _, err = run_command(capsys, "component", "list", "/bx", status=1)
    assert "Unable to find container node '/bx'" in err
    assert "did you mean '/box'?" in err


def test_component_load_and_unload_change_container(add_to_graph, capsys):
    add_to_graph(create_container)
    words = ["demo_nodes_cpp", "demo_nodes_cpp::Listener", "-n", "ear", "--node-namespace", "/head", "-r", "chatter:=c"]
    assert run_command(capsys, "component", "load", "/box", *words)[0] == (
        "Loaded component 2 into '/box' container node as '/head/ear'\n"
    )
    assert run_command(capsys, "component", "load", "-q", "/box", *words)[0] == "2  /head/ear\n"
    assert (
        run_command(capsys, "component", "unload", "/box", "1")[0]
        == "Unloaded component 1 from '/box' container node\n"
    )
    assert run_command(capsys, "component", "unload", "-q", "/box", "1")[0] == "1\n"


class _ContainerProcess:
    """A substitute for the process that `component standalone` starts.

    Its node is in the graph.
    """

    def __init__(self, deaf_to: set[int], status: int | None) -> None:
        self.returncode: int | None = None
        self.told: list[int] = []
        self._deaf_to = deaf_to
        self._status = status
        self._ended = asyncio.Event()

    def send_signal(self, number: int) -> None:
        self.told.append(number)
        if number not in self._deaf_to:
            self._end(-number)

    def terminate(self) -> None:
        self.send_signal(signal.SIGTERM)

    def kill(self) -> None:
        self.send_signal(signal.SIGKILL)

    async def wait(self) -> int:
        if self._status is not None:
            self._end(self._status)
        await self._ended.wait()
        assert self.returncode is not None
        return self.returncode

    def _end(self, status: int) -> None:
        self.returncode = status
        self._ended.set()


def replace_standalone_process(monkeypatch, deaf_to: set[int], status: int | None) -> list[_ContainerProcess]:
    started: list[_ContainerProcess] = []

    async def start(*_words: str) -> _ContainerProcess:
        started.append(_ContainerProcess(deaf_to, status))
        return started[0]

    monkeypatch.setattr(asyncio, "create_subprocess_exec", start)
    monkeypatch.setattr("linkwright.cli.component._EXIT_TIMEOUT_S", 0.01)
    return started


STANDALONE = ["component", "standalone", "-c", "box", "demo_nodes_cpp"]


def test_standalone_component_runs_until_container_ends(add_to_graph, capsys, monkeypatch):
    add_to_graph(create_container)
    started = replace_standalone_process(monkeypatch, set(), 3)
    run_command(capsys, *STANDALONE, "demo_nodes_cpp::Listener", status=3)
    assert started[0].told == []


@pytest.mark.parametrize(
    ("deaf_to", "message"),
    [
        (set(), [signal.SIGINT]),
        ({signal.SIGINT}, [signal.SIGINT, signal.SIGTERM]),
        ({signal.SIGINT, signal.SIGTERM}, [signal.SIGINT, signal.SIGTERM, signal.SIGKILL]),
    ],
)
def test_standalone_component_ends_container_if_loading_fails(add_to_graph, capsys, monkeypatch, deaf_to, message):
    add_to_graph(create_container)
    started = replace_standalone_process(monkeypatch, deaf_to, None)
    run_command(capsys, *STANDALONE, "demo_nodes_cpp::Nobody", status=1)
    assert started[0].told == message


def test_component_commands_report_invalid_arguments(add_to_graph, capsys):
    add_to_graph(create_container)
    _, err = run_command(capsys, "component", "load", "/box", "demo_nodes_cpp", "demo_nodes_cpp::Talkr", status=1)
    assert "Failed to load component" in err
    _, err = run_command(capsys, "component", "unload", "/box", "7", status=1)
    assert "Failed to unload component 7" in err
    assert "the container's nodes are 1 /talker" in err
    words = ["load", "/box", "demo_nodes_cpp", "demo_nodes_cpp::Talker", "--log-level", "loud"]
    assert "there is no log level 'loud'" in run_command(capsys, "component", *words, status=1)[1]
