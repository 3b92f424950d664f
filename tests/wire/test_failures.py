"""Errors of users' code in a thread of the transport.

They are reported, and the thread continues.
"""

from __future__ import annotations

import threading

from linkwright.graph.qos.profile import DurabilityPolicy, QoSProfile
from linkwright.messages import String, get_service
from linkwright.wire.guarded_calls import call_guarded
from tests.waiting import wait_until
from tests.wire.conftest import both_wires

SetBool = get_service("std_srvs/srv/SetBool")
TRANSIENT_LOCAL = QoSProfile(5, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class FailsOnce:
    """A callable that raises an error the first time."""

    def __init__(self, call=lambda: None):
        self.call, self.calls = call, 0

    def __call__(self, *arguments):
        self.calls += 1
        if self.calls == 1:
            raise ValueError("the user's own mistake")
        return self.call(*arguments)


def warnings_of(process, prefix):
    return [
        text
        for text in process.warnings()
        if text.startswith(prefix) and text.endswith("ValueError: the user's own mistake")
    ]


def flip(request, response):
    response.success = not request.data
    return response


@both_wires
def test_failing_message_does_not_affect_others(processes):
    a, b = processes("a"), processes("b")
    texts = []
    subscription = b.node.create_subscription(String, "chatter", lambda message: texts.append(message.data), 10)
    subscription.receive = FailsOnce(subscription.receive)
    publisher = a.node.create_publisher(String, "chatter", 10)
    a.spin_until(lambda: publisher.get_subscription_count() == 1)
    for word in ("one", "two", "three"):
        publisher.publish(String(data=word))
    b.spin_until(lambda: len(texts) == 2)
    assert texts == ["two", "three"]
    assert len(warnings_of(b, "callback of topic '/chatter' failed:")) == 1


@both_wires
def test_failing_graph_watcher_does_not_affect_others(processes):
    a = processes("a")
    failing, succeeding = FailsOnce(), FailsOnce()
    succeeding.calls = 1
    a.graph.watch(failing)
    a.graph.watch(succeeding)
    a.transport.watch(FailsOnce())
    b = processes("b")
    b.node.create_service(SetBool, "flip", flip)
    client = a.node.create_client(SetBool, "flip")
    assert client.wait_for_service(60)
    wait_until(lambda: "b" in a.node.get_node_names())
    wait_until(lambda: warnings_of(a, "a callback for changes to remote nodes failed:"))
    assert len(warnings_of(a, "a callback for changes to the graph failed:")) == 1
    assert succeeding.calls > 1


@both_wires
def test_failing_request_and_response_are_reported(processes):
    a, b = processes("a"), processes("b")
    service = b.node.create_service(SetBool, "flip", flip)
    client = a.node.create_client(SetBool, "flip")
    assert client.wait_for_service(60)
    service.receive = FailsOnce(service.receive)
    client.announce = FailsOnce(client.announce)
    futures = [client.call_async(SetBool.Request(data=data)) for data in (True, True, False)]

    def both_spin():
        a.executor.spin_once(timeout_sec=0.01)
        return futures[2].done()

    b.spin_until(both_spin)
    assert futures[2].result().success
    assert not futures[0].done()
    assert warnings_of(b, "callback of service '/flip' failed:")
    assert warnings_of(a, "client of service '/flip' failed:")


def with_invalid_data(message, value):
    """Return a message with a value of the wrong type that was never checked."""
    message._data = value
    return message


@both_wires
def test_unserializable_latched_message_is_reported_and_others_sent(processes):
    a = processes("a", join_now=False)
    publisher = a.node.create_publisher(String, "described", TRANSIENT_LOCAL)
    publisher._copies_messages = False  # as in Linkwright's own nodes, which do not reuse messages
    for message in (String(data="one"), with_invalid_data(String(), 5), String(data="three")):
        publisher.publish(message)
    a.join()
    b = processes("b")
    texts = []
    b.node.create_subscription(String, "described", lambda message: texts.append(message.data), TRANSIENT_LOCAL)
    b.spin_until(lambda: len(texts) == 2)
    assert texts == ["one", "three"]
    assert [text for text in a.warnings() if text.startswith("sending the messages of topic '/described' failed:")]


@both_wires
def test_unserializable_queued_request_fails_and_next_is_answered(processes):
    a, b = processes("a"), processes("b")
    a.node.handle.copies_messages = False  # as in Linkwright's own nodes
    client = a.node.create_client(SetBool, "flip")
    requests = (with_invalid_data(SetBool.Request(), "neither true nor false"), SetBool.Request(data=False))
    futures = [client.call_async(request) for request in requests]
    b.node.create_service(SetBool, "flip", flip)

    def both_spin():
        b.executor.spin_once(timeout_sec=0.01)
        return all(future.done() for future in futures)

    a.spin_until(both_spin)
    assert "data" in str(futures[0].exception())
    assert futures[1].result().success


def test_thread_continues_when_logging_fails(monkeypatch):
    errors = []
    monkeypatch.setattr(threading, "excepthook", lambda hook: errors.append((hook.exc_type, str(hook.exc_value))))

    def fail():
        raise ValueError("first")

    def report(error):
        raise OSError(f"no log for '{error}'")

    assert call_guarded(lambda: 5) == 5
    assert call_guarded(fail) is None
    assert call_guarded(fail, report) is None
    assert errors == [(ValueError, "first"), (OSError, "no log for 'first'")]
