"""Lifecycle nodes of launch: transitions, events and sequences."""

from __future__ import annotations

from importlib.metadata import EntryPoint
from typing import Any

import pytest
from launch.actions import EmitEvent, LogInfo, RegisterEventHandler
from launch.events import matches_action
from launch_ros.actions import LifecycleNode, LifecycleTransition, Node
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events import matches_node_name
from launch_ros.events.lifecycle import ChangeState

from launch import LaunchContext
from linkwright.graph import Graph
from linkwright.graph.lifecycle.managed_node import LifecycleNodeMixin
from linkwright.nodes import EXECUTABLES, NodeOptions
from tests.launch.ending import end_when, has_printed

TRANSITION_CONFIGURE, TRANSITION_DEACTIVATE = 1, 4


class ManagedNode(LifecycleNodeMixin):
    """A lifecycle node of this process; a parameter makes its configuration fail."""

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self.node = graph.create_node(options.name or "managed", namespace=options.namespace)
        self.fails = bool(options.parameters.get("fails"))
        for name in ("get_name", "create_publisher", "create_service", "get_clock", "get_logger"):
            setattr(self, name, getattr(self.node, name))
        LifecycleNodeMixin.__init__(self)

    def on_configure(self, state: Any) -> Any:
        return_class = type(super().on_configure(state))
        return return_class.FAILURE if self.fails else return_class.SUCCESS

    def close(self) -> None:
        self.node.destroy_node()


@pytest.fixture(autouse=True)
def _executable(monkeypatch: pytest.MonkeyPatch) -> None:
    entry = EntryPoint("life/node", f"{__name__}:ManagedNode", "linkwright.nodes")
    monkeypatch.setitem(EXECUTABLES.entry_points, ("life", "node"), entry)


def make_managed(name: str = "one", **options: Any) -> LifecycleNode:
    return LifecycleNode(package="life", executable="node", name=name, namespace="", **options)


def log_on_transition(text: str, **filters: Any) -> RegisterEventHandler:
    return RegisterEventHandler(OnStateTransition(entities=[LogInfo(msg=text)], **filters))


async def test_change_state_triggers_transition_and_event(launch) -> None:
    node = make_managed()
    change_state = ChangeState(lifecycle_node_matcher=matches_action(node), transition_id=TRANSITION_CONFIGURE)
    result = await launch(
        node,
        make_managed("two"),
        log_on_transition("configured", target_lifecycle_node=node, transition="transition_success"),
        log_on_transition("inactive", goal_state="inactive", start_state="configuring"),
        EmitEvent(event=change_state),
        end_when(has_printed("[launch.user]: inactive")),
    )
    assert result.messages.count("inactive") == 1
    assert result.messages.count("configured") == 1
    assert node.current_state == "PRIMARY_STATE_INACTIVE"


async def test_autostart_activates_node(launch) -> None:
    node = make_managed(autostart=True)
    active = log_on_transition("active", target_lifecycle_node=node, goal_state="active")
    result = await launch(node, active, end_when(has_printed("[launch.user]: active")))
    assert result.messages == ["active"]


async def test_lifecycle_transition_runs_sequence(launch) -> None:
    nodes = [make_managed("one"), make_managed("two")]
    sequence = LifecycleTransition(
        lifecycle_node_names=["one", "/two"], transition_ids=[TRANSITION_CONFIGURE, "3", TRANSITION_DEACTIVATE]
    )
    off = log_on_transition("off", start_state="deactivating", goal_state="inactive")
    result = await launch(*nodes, sequence, off, end_when(has_printed("[launch.user]: off", times=2)))
    assert result.messages == ["off", "off"]


async def test_failed_transition_is_reported(launch) -> None:
    node = make_managed(parameters=[{"fails": True}])
    change_state = ChangeState(lifecycle_node_matcher=matches_node_name("one"), transition_id=TRANSITION_CONFIGURE)
    result = await launch(node, EmitEvent(event=change_state), end_when(has_printed("Failed to make transition")))
    assert "Failed to make transition 'TRANSITION_CONFIGURE' for LifecycleNode '/one'" in result.err


def test_node_matchers_use_full_names() -> None:
    node = make_managed()
    node._perform_substitutions(LaunchContext())
    assert matches_node_name("one")(node)
    assert matches_node_name("/one")(node)
    assert not matches_node_name("/one/x")(node)
    assert node.is_node_name_fully_specified()


def test_name_and_namespace_are_required() -> None:
    with pytest.raises(TypeError):
        LifecycleNode(package="a", executable="b", name="c")
    with pytest.raises(TypeError):
        LifecycleNode(package="a", executable="b", namespace="c")


@pytest.mark.parametrize(
    "make",
    [
        lambda: ChangeState(lifecycle_node_matcher=lambda _: True, transition_id=42),
        lambda: LifecycleTransition(lifecycle_node_names=[], transition_ids=[1]),
        lambda: LifecycleTransition(lifecycle_node_names=["a"], transition_ids=[]),
        lambda: LifecycleTransition(lifecycle_node_names=["a"], transition_ids=["x"]).execute(LaunchContext()),
    ],
)
def test_invalid_transitions_are_rejected(make: Any) -> None:
    with pytest.raises(ValueError, match=r"transition|lifecycle_node_names"):
        make()


def test_transition_target_must_be_lifecycle_node() -> None:
    with pytest.raises(RuntimeError, match="requires a 'LifecycleNode' action"):
        OnStateTransition(target_lifecycle_node=Node(executable="x"), entities=[])
