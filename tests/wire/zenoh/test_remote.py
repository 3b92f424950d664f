"""The data about other sessions; data about ended sessions is removed."""

from __future__ import annotations

from linkwright.graph.endpoints.base import EndpointKind
from linkwright.graph.names.rules import NodeIdentity
from linkwright.wire.zenoh.remote import RemoteGraph
from linkwright.wire.zenoh.tokens import Token

TOKENS = [
    Token(
        7, f"session{number}", "0", "1", NodeIdentity("robot", f"/r{number}"), kind, f"/r{number}/tf", "tf", "hash", ""
    )
    for number in range(100)
    for kind in (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
]


def test_departed_sessions_leave_no_data(monkeypatch):
    now = 100.0
    monkeypatch.setattr("linkwright.wire.zenoh.remote.time.monotonic", lambda: now)
    remote = RemoteGraph()
    empty = {name: len(value) for name, value in vars(remote).items() if hasattr(value, "__len__")}
    for token in TOKENS:
        assert remote.add(token.key, token)
        assert remote.count(token.kind, token.data_key) == 1
        now += 1.0
        assert remote.remove(token.key) is token
        assert remote.count(token.kind, token.data_key) == 0
    remaining = {name: len(value) for name, value in vars(remote).items() if hasattr(value, "__len__")}
    assert remaining == {**empty, "_removal_times": 1}  # the time of the last departure
