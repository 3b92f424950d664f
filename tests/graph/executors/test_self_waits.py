"""Callbacks that block for a result that only their own callback group could process."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import pytest

from linkwright.graph import Graph
from linkwright.graph.actions.client import ActionClient
from linkwright.graph.actions.server import ActionServer
from linkwright.graph.executors import (
    Executor,
    MultiThreadedExecutor,
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
    SingleThreadedExecutor,
)
from linkwright.graph.loop import future as self_waits
from linkwright.messages import get_action, get_service
from tests.waiting import TIMEOUT_S

TRIGGER = get_service("std_srvs/srv/Trigger")
FIBONACCI = get_action("example_interfaces/action/Fibonacci")


class CallingScene:
    """A server of a service and an action, and a client of them.

    A callback of the client's timer calls one of them.

    Attributes:
        errors: the texts of logged errors.
        client: the client of the service.
        action: the client of the action.
    """

    def __init__(
        self,
        *,
        client_group: Any = None,
        executor: Callable[[], Executor] = MultiThreadedExecutor,
        parameters: dict[str, Any] | None = None,
    ) -> None:
        self.errors: list[str] = []
        self._graph = Graph(threads=True, on_log=self._heard)
        self._nodes = [
            self._graph.create_node(name, parameters=parameters, start_parameter_services=False, enable_rosout=False)
            for name in ("server", "client")
        ]
        server, client = self._nodes
        server.create_service(TRIGGER, "ask", lambda _, response: response)
        self._server = ActionServer(server, FIBONACCI, "count", self._count)
        self.client = client.create_client(TRIGGER, "ask", callback_group=client_group)
        self.action = ActionClient(client, FIBONACCI, "count", callback_group=client_group)
        self.executor = executor()

    def run(self, ask: Callable[[], Any], *, seconds: float = TIMEOUT_S) -> bool:
        """Run a callback in the client's default group, and return whether it ended in time."""
        ended = threading.Event()

        def callback() -> None:
            timer.cancel()
            ask()
            ended.set()

        timer = self._nodes[1].create_timer(0.0, callback)
        for node in self._nodes:
            self.executor.add_node(node)
        threading.Thread(target=self.executor.spin, daemon=True).start()
        return ended.wait(seconds)

    def close(self) -> None:
        self.executor.shutdown(1.0)
        self._graph.close_threadsafe()

    @staticmethod
    def _count(goal: Any) -> Any:
        goal.succeed()
        return FIBONACCI.Result()

    def _heard(self, record: Any) -> None:
        if record.level.name == "ERROR":
            self.errors.append(record.text)


@pytest.fixture
def make_scene(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return a function that creates a `CallingScene`."""
    monkeypatch.setattr(self_waits, "_reported_waits", set())
    scenes: list[CallingScene] = []

    def make(**options: Any) -> CallingScene:
        scenes.append(CallingScene(**options))
        return scenes[-1]

    yield make
    for scene in scenes:
        scene.close()


def test_call_in_own_callback_group_is_reported_once_with_both_locations(make_scene) -> None:
    asks = make_scene()

    def ask() -> None:
        for _ in range(2):
            asks.client.call(TRIGGER.Request())

    assert asks.run(ask)
    (error,) = asks.errors
    callback = CallingScene.run.__code__.co_firstlineno
    assert f"callback 'callback' ({__file__}:{callback + 4})" in error
    assert f" waits at {__file__}:{ask.__code__.co_firstlineno + 2} for the client of service '/ask'" in error
    assert "mutually exclusive" in error


@pytest.mark.parametrize("kind", [SingleThreadedExecutor, MultiThreadedExecutor])
def test_spin_for_response_in_own_callback_group_is_reported(make_scene, kind) -> None:
    asks = make_scene(executor=kind)
    assert asks.run(lambda: asks.executor.spin_until_future_complete(asks.client.call_async(TRIGGER.Request())))
    assert len(asks.errors) == 1


def test_send_goal_in_own_callback_group_is_reported(make_scene) -> None:
    asks = make_scene()
    assert asks.run(lambda: asks.action.send_goal(FIBONACCI.Goal(order=1)))
    assert "for the client of service '/count" in asks.errors[0]


@pytest.mark.parametrize("group", [ReentrantCallbackGroup, MutuallyExclusiveCallbackGroup])
def test_client_in_another_group_is_not_reported(make_scene, group) -> None:
    asks = make_scene(client_group=group())
    assert asks.run(lambda: (asks.client.call(TRIGGER.Request()), asks.action.send_goal(FIBONACCI.Goal(order=1))))
    assert asks.errors == []


def test_waits_outside_callbacks_and_completed_futures_are_not_reported(make_scene) -> None:
    asks = make_scene()
    future = asks.client.call_async(TRIGGER.Request())
    assert asks.run(lambda: None)
    assert future.wait(TIMEOUT_S)
    asks.executor.spin_until_future_complete(future)
    assert asks.client.call(TRIGGER.Request(), timeout_sec=TIMEOUT_S) is not None
    assert asks.errors == []


def test_strict_parameter_makes_call_block_until_timeout(make_scene) -> None:
    asks = make_scene(parameters={self_waits.STRICT_GROUPS_PARAMETER: True})
    answers: list[Any] = []
    assert asks.run(lambda: answers.append(asks.client.call(TRIGGER.Request(), timeout_sec=0.2)))
    assert answers == [None]
    assert len(asks.errors) == 1
