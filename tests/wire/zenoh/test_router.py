"""Our router serves nodes that search for a router where rmw_zenoh_cpp does."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable

import pytest

from linkwright.messages import String, get_interface
from linkwright.wire.zenoh.settings import ATTEMPTS_VARIABLE, OVERRIDES_VARIABLE
from tests.wire.test_topics import KEEP_ALL, TRANSIENT_LOCAL
from tests.wire.zenoh.conftest import ROUTER

AddTwoInts = get_interface("example_interfaces/srv/AddTwoInts")


@pytest.fixture
def by_router_alone(monkeypatch, router_port) -> None:
    """Turn multicast discovery off."""
    settings = f'connect/endpoints=["tcp/localhost:{router_port}"];scouting/multicast/enabled=false'
    monkeypatch.setenv(OVERRIDES_VARIABLE, settings)


def test_processes_discover_by_router_and_continue_without_it(processes, start_router, by_router_alone):
    router = start_router()
    a, b = processes("a"), processes("b")
    texts: list[str] = []
    b.node.create_subscription(String, "chatter", lambda message: texts.append(message.data), 10)
    publisher = a.node.create_publisher(String, "chatter", 10)
    a.spin_until(lambda: publisher.get_subscription_count() == 1)
    publisher.publish(String(data="with"))
    b.spin_until(lambda: texts == ["with"])
    router.terminate()
    assert router.wait(60) == 0
    publisher.publish(String(data="without"))
    b.spin_until(lambda: texts == ["with", "without"])


def test_graph_is_restored_after_router_restart(processes, start_router, monkeypatch, router_port):
    """The graph is restored after a restart of the router.

    Clients are connected only to their router, so they lose the graph with it, and regain it later.
    """
    monkeypatch.setenv(OVERRIDES_VARIABLE, f'mode="client";connect/endpoints=["tcp/localhost:{router_port}"]')
    router = start_router()
    a, b = processes("a"), processes("b")
    chatter_texts: list[str] = []
    described: list[str] = []
    chatter = a.node.create_publisher(String, "chatter", KEEP_ALL)
    a.node.create_publisher(String, "described", TRANSIENT_LOCAL).publish(String(data="robot"))
    b.node.create_subscription(String, "chatter", lambda message: chatter_texts.append(message.data), KEEP_ALL)
    b.node.create_subscription(String, "described", lambda message: described.append(message.data), TRANSIENT_LOCAL)

    def add(request, response):
        response.sum = request.a + request.b
        return response

    a.node.create_service(AddTwoInts, "add", add)
    client = b.node.create_client(AddTwoInts, "add")

    def sees_all() -> bool:
        return (
            "b" in a.node.get_node_names()
            and "a" in b.node.get_node_names()
            and chatter.get_subscription_count() == 1
            and client.service_is_ready()
        )

    def spin_both(condition: Callable[[], object]) -> None:
        a.spin_until(lambda: condition() or b.executor.spin_once(timeout_sec=0.01) or condition())

    for number, (word, first) in enumerate((("before", 1), ("after", 2), ("and again", 3))):
        if number:
            router.kill()
            router.wait()
            spin_both(lambda: "a" not in b.node.get_node_names() and "b" not in a.node.get_node_names())
            spin_both(lambda: not client.service_is_ready() and chatter.get_subscription_count() == 0)
            router = start_router()
        spin_both(sees_all)
        chatter.publish(String(data=word))
        spin_both(lambda word=word: word in chatter_texts)
        future = client.call_async(AddTwoInts.Request(a=first, b=10))
        spin_both(future.done)
        assert future.result().sum == first + 10
        late_process = processes(f"late{number}")
        texts: list[str] = []
        late_process.node.create_subscription(
            String, "described", lambda message, texts=texts: texts.append(message.data), TRANSIENT_LOCAL
        )
        late_process.spin_until(lambda texts=texts: texts)
        assert texts == ["robot"]
        late_process.close()
    assert chatter_texts == ["before", "after", "and again"]
    assert described == ["robot"]


def test_late_router_is_found(processes, start_router, by_router_alone, monkeypatch):
    monkeypatch.setenv(ATTEMPTS_VARIABLE, "0")
    a, b = processes("a", join_now=False), processes("b", join_now=False)
    start_router()
    a.join(), b.join()
    a.spin_until(lambda: "b" in a.node.get_node_names())
    assert not a.warnings()


def test_missing_router_is_reported(processes, by_router_alone, monkeypatch):
    monkeypatch.setenv(ATTEMPTS_VARIABLE, "1")
    process = processes("ours")
    process.spin_until(process.warnings)
    (text,) = process.warnings()
    assert "There is no Zenoh router" in text
    assert "linkwright run rmw_zenoh_cpp rmw_zenohd" in text


@pytest.mark.parametrize("verb", [["topic", "list"], ["topic", "echo", "/chatter", "std_msgs/msg/String"], ["doctor"]])
def test_verb_without_router_fails_with_one_error(monkeypatch, router_port, verb):
    settings = f'mode="client";connect/endpoints=["tcp/localhost:{router_port}"];connect/timeout_ms=0'
    monkeypatch.setenv(OVERRIDES_VARIABLE, settings)
    result = subprocess.run(
        [sys.executable, "-m", "linkwright", *verb], check=False, capture_output=True, text=True, timeout=60
    )
    assert result.returncode == 1
    assert not result.stdout
    assert result.stderr.startswith("error[DDS112]: a Zenoh session cannot be opened")
    assert result.stderr.count("DDS112") == 1


def test_second_router_reports_port_conflict(start_router, router_port):
    start_router()
    settings = f'listen/endpoints=["tcp/localhost:{router_port}"]'
    second = subprocess.run(
        ROUTER,
        check=False,
        env={**os.environ, OVERRIDES_VARIABLE: settings},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert second.returncode == 1
    assert "error[DDS112]: a Zenoh session cannot be opened" in second.stderr
    assert "Address already in use" in second.stderr


@pytest.mark.parametrize(
    ("settings", "message"),
    [("mode", "'mode' in ZENOH_CONFIG_OVERRIDE is not a Zenoh setting"), ("mode=17", "Zenoh refuses 'mode=17'")],
)
def test_rejected_setting_is_reported_by_name(monkeypatch, settings, message):
    result = subprocess.run(
        ROUTER,
        check=False,
        env={**os.environ, OVERRIDES_VARIABLE: settings},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert result.returncode == 1
    assert f"error[DDS111]: {message}" in result.stderr
