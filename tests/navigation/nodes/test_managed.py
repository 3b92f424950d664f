"""Common features of nav2's servers: the lifecycle, and the bond to the lifecycle manager."""

from __future__ import annotations

import pytest

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.graph import Graph, JumpClock, LogLevel, LogRecord
from linkwright.graph.lifecycle.states import ACTIVE, INACTIVE, UNCONFIGURED, TransitionCallbackReturn
from linkwright.messages import get_message
from linkwright.navigation.nodes.bond import Bond
from linkwright.navigation.nodes.managed import ManagedNode, ManagedServer
from linkwright.nodes import NodeOptions


class _Node(ManagedNode):
    did: list[str]

    def declare(self) -> None:
        self.did = []
        self.declare_parameter("fails", "")

    def configure(self) -> None:
        self._do("configure")
        self.register(self.create_publisher(get_message("std_msgs/msg/String"), "kept", 1))

    def activate(self) -> None:
        self._do("activate")

    def deactivate(self) -> None:
        self._do("deactivate")

    def cleanup(self) -> None:
        self.did.append("cleanup")

    def _do(self, transition: str) -> None:
        self.did.append(transition)
        if self.get_parameter("fails").value == transition:
            raise LinkwrightError(Diagnostic("NODE433", phrase("it cannot be")))


class _Server(ManagedServer):
    NODE = _Node
    DEFAULT_NAME = "server"


def _start(graph: Graph, **parameters: object) -> tuple[_Server, _Node]:
    server = _Server(graph, NodeOptions(parameters=parameters))
    node = server.node
    assert isinstance(node, _Node)
    return server, node


async def test_managed_node_follows_transitions(graph: Graph) -> None:
    server, node = _start(graph)
    node.trigger_configure()
    assert graph.topics()["/kept"]
    node.trigger_activate()
    assert node.is_active
    node.trigger_deactivate()
    node.trigger_cleanup()
    assert node.did == ["configure", "activate", "deactivate", "cleanup"]
    assert "/kept" not in graph.topics()
    server.close()


async def test_autostart_node_activates_and_cleans_up_on_close(graph: Graph) -> None:
    server, node = _start(graph, autostart_node=True)
    assert node.lifecycle_state == ACTIVE
    server.close()
    assert node.did == ["configure", "activate", "deactivate", "cleanup"]


@pytest.mark.parametrize(("fails", "remaining"), [("configure", UNCONFIGURED), ("activate", INACTIVE)])
async def test_error_in_transition_is_reported_and_transition_fails(
    graph: Graph, log: list[LogRecord], fails: str, remaining: object
) -> None:
    server, node = _start(graph, fails=fails)
    verdicts = [node.trigger_configure()]
    if verdicts == [TransitionCallbackReturn.SUCCESS]:
        verdicts.append(node.trigger_activate())
    assert verdicts[-1] == TransitionCallbackReturn.FAILURE
    assert node.lifecycle_state == remaining
    errors = [record.text for record in log if record.level is LogLevel.ERROR]
    assert errors == ["error[NODE433]: it cannot be"]
    server.close()


async def test_unknown_parameters_are_reported_on_configure(graph: Graph, log: list[LogRecord]) -> None:
    server, node = _start(graph, failz="x")
    node.trigger_configure()
    assert any("'failz' is not a parameter of this node" in record.text for record in log)
    server.close()


class _BondedPair:
    """The two sides of a bond."""

    def __init__(self, graph: Graph) -> None:
        self.events: list[str] = []
        self.nodes = [graph.create_node("manager"), graph.create_node("server")]
        self.manager = Bond(
            self.nodes[0],
            "server",
            on_formed=lambda: self.events.append("formed"),
            on_broken=lambda: self.events.append("broken"),
        )

    def server(self) -> Bond:
        return Bond(self.nodes[1], "server")


async def test_bond_forms_and_breaks_when_other_side_leaves(graph: Graph, clock: JumpClock) -> None:
    pair = _BondedPair(graph)
    await clock.advance(60.0)
    assert pair.events == []  # the bond waits for the other side
    server = pair.server()
    await clock.advance(0.2)
    assert pair.events == ["formed"]
    server.end()
    await graph.settle()
    assert pair.events == ["formed", "broken"]
    pair.manager.end()


async def test_bond_breaks_after_four_seconds_of_silence(graph: Graph, clock: JumpClock) -> None:
    pair = _BondedPair(graph)
    server = pair.server()
    await clock.advance(0.2)
    server._timer.cancel()  # simulates a dead process
    await clock.advance(3.8)
    assert pair.events == ["formed"]
    await clock.advance(0.4)
    assert pair.events == ["formed", "broken"]
    server.end()
    pair.manager.end()


async def test_ending_own_bond_gives_no_break_event(graph: Graph, clock: JumpClock) -> None:
    pair = _BondedPair(graph)
    server = pair.server()
    await clock.advance(0.2)
    pair.manager.end()
    await graph.settle()
    assert server.is_broken
    assert pair.events == ["formed"]
    server.end()
