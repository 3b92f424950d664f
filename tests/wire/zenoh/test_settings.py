"""Settings of Zenoh sessions: waits, failures and exits."""

from __future__ import annotations

import json
import socket
import threading
import time

import pytest

from linkwright.diagnostics import LinkwrightError, render
from linkwright.wire.zenoh.session import build_config, close_session, open_session
from linkwright.wire.zenoh.settings import OVERRIDES_VARIABLE, read_router_settings, read_settings

DROP_SETTING = "transport/link/tx/queue/congestion_control/drop"


def drop_settings(settings):
    return json.loads(build_config(settings).get_json(DROP_SETTING))


def test_sessions_wait_longer_before_drop_than_routers():
    assert drop_settings(read_settings({})) == {"wait_before_drop": 50_000, "max_wait_before_drop_fragments": 200_000}
    assert drop_settings(read_router_settings({})) == {
        "wait_before_drop": 1_000,
        "max_wait_before_drop_fragments": 50_000,
    }


@pytest.mark.parametrize("wait", [0, 1_000_000])
def test_wait_before_drop_can_be_configured(wait):
    settings = read_settings({OVERRIDES_VARIABLE: f"{DROP_SETTING}/wait_before_drop={wait}"})
    assert drop_settings(settings)["wait_before_drop"] == wait


@pytest.mark.parametrize(
    ("override", "message", "advice"),
    [
        ('listen/endpoints=["tcp/127.0.0.1:{port}"]', "already in use", "port 0"),
        ('mode="client";connect/endpoints=["tcp/127.0.0.1:{free}"]', "Unable to connect", ": start a router there"),
    ],
)
def test_failed_session_opening_is_reported_with_advice(router_port, override, message, advice):
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        listener.listen()
        text = override.format(port=listener.getsockname()[1], free=router_port)
        with pytest.raises(LinkwrightError) as refused:
            open_session(build_config(read_settings({OVERRIDES_VARIABLE: text})))
    (finding,) = refused.value.diagnostics
    assert finding.code == "DDS112"
    assert message in render(finding)
    assert advice in render(finding)
    assert "/src/" not in render(finding)


class BlockedSession:
    """A session whose transport is full, so that closing it blocks."""

    def __init__(self):
        self.free = threading.Event()
        self.closed = threading.Event()

    def close(self):
        self.free.wait()
        self.closed.set()


def test_process_exit_does_not_wait_for_blocked_session(monkeypatch):
    monkeypatch.setattr("linkwright.wire.zenoh.session._CLOSE_TIMEOUT_S", 0.01)
    session = BlockedSession()
    start = time.monotonic()
    close_session(session)
    assert time.monotonic() - start < 60
    assert not session.closed.is_set()
    session.free.set()
    assert session.closed.wait(60)


def test_session_is_closed_at_process_exit():
    session = BlockedSession()
    session.free.set()
    close_session(session)
    assert session.closed.is_set()
