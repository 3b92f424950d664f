"""The user at the other end of a connection, according to the tables of Linux."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from asyncio import Transport
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from linkwright.page import peers
from linkwright.page.access import is_local_connection
from linkwright.page.peers import may_be_own_user
from tests.waiting import TIMEOUT_S

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the tables of connections are Linux's")
FAMILIES = ("127.0.0.1", "127.0.0.1"), ("127.0.0.1", "::ffff:127.0.0.1"), ("::1", "::1"), ("::", "127.0.0.1")
NOBODY_UID = 65534

CONNECTING_PROGRAM = """
import encodings.idna, os, socket, sys  # all imports first, as the other user may not be able to read Python's files
os.setgid({user}); os.setuid({user})
connection = socket.create_connection(("127.0.0.1", {port}))
sys.stdin.read()
"""


class Connection(Transport):
    """The properties of an accepted connection in asyncio."""

    def __init__(self, peer: Any, own_address: Any) -> None:
        super().__init__({"peername": peer, "sockname": own_address})


def accept_connection(listener: socket.socket) -> tuple[socket.socket, Connection]:
    listener.settimeout(TIMEOUT_S)
    accepted_socket, _ = listener.accept()
    return accepted_socket, Connection(accepted_socket.getpeername(), accepted_socket.getsockname())


def open_listener(host: str) -> socket.socket:
    try:
        is_ipv6 = ":" in host
        return socket.create_server(
            (host, 0), family=socket.AF_INET6 if is_ipv6 else socket.AF_INET, dualstack_ipv6=host == "::"
        )
    except (OSError, ValueError):
        pytest.skip(f"this machine cannot listen at {host}")


@contextmanager
def connect_pair(
    listening: str = "127.0.0.1", connecting: str = "127.0.0.1"
) -> Iterator[tuple[socket.socket, Connection]]:
    """Return a socket of this process that is connected to a server in this process."""
    family = socket.AF_INET6 if ":" in connecting else socket.AF_INET
    with open_listener(listening) as listener, socket.socket(family) as theirs:
        theirs.connect((connecting, listener.getsockname()[1]))
        accepted_socket, connection = accept_connection(listener)
        with accepted_socket:
            yield theirs, connection


@pytest.mark.parametrize(("listening", "connecting"), FAMILIES)
def test_program_of_same_user_is_accepted(listening: str, connecting: str) -> None:
    with connect_pair(listening, connecting) as (_, connection):
        assert is_local_connection(connection)
        assert may_be_own_user(connection)


@linux
@pytest.mark.parametrize(("listening", "connecting"), FAMILIES)
def test_other_user_is_rejected(monkeypatch: pytest.MonkeyPatch, listening: str, connecting: str) -> None:
    with connect_pair(listening, connecting) as (_, connection):
        monkeypatch.setattr(os, "geteuid", lambda: NOBODY_UID - 1)
        monkeypatch.setattr(peers, "_ROOT", None)
        assert is_local_connection(connection)
        assert not may_be_own_user(connection)


@linux
@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root can become another user")
@pytest.mark.parametrize(("user", "is_accepted"), [(NOBODY_UID, False), (0, True)])
def test_user_of_other_process_is_recognized(user: int, is_accepted: bool) -> None:
    with open_listener("127.0.0.1") as listener:
        program = CONNECTING_PROGRAM.format(user=user, port=listener.getsockname()[1])
        with subprocess.Popen([sys.executable, "-I", "-c", program], stdin=subprocess.PIPE) as process:
            accepted_socket, connection = accept_connection(listener)
            with accepted_socket:
                assert may_be_own_user(connection) is is_accepted
                process.communicate()
                assert not may_be_own_user(connection), "a closed socket has no owner, and is listed as root's"


@linux
def test_root_is_accepted(monkeypatch: pytest.MonkeyPatch) -> None:
    with connect_pair() as (_, connection):
        monkeypatch.setattr(os, "geteuid", lambda: NOBODY_UID - 1)
        monkeypatch.setattr(peers, "_ROOT", os.getuid())
        assert may_be_own_user(connection)


@linux
def test_closed_socket_is_rejected() -> None:
    with connect_pair() as (theirs, connection):
        theirs.close()
        assert not may_be_own_user(connection)


@linux
def test_socket_omitted_once_by_system_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    read = peers._read_tables
    answers = iter(["  sl  local_address\n", "  sl  local_address\n"])
    monkeypatch.setattr(peers, "_read_tables", lambda: next(answers, None) or read())
    with connect_pair() as (_, connection):
        assert may_be_own_user(connection)


def test_all_local_users_are_accepted_without_socket_tables(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    connection = Connection(("127.0.0.1", 1), ("127.0.0.1", 2))
    monkeypatch.setattr(peers, "_TABLES", (tmp_path / "tcp", tmp_path / "tcp6"))
    assert may_be_own_user(connection)
    monkeypatch.setattr(sys, "platform", "darwin")
    assert may_be_own_user(connection)


@pytest.mark.parametrize("transport", [None, Connection(None, None), Connection(("127.0.0.1", 1), None)])
def test_lost_connection_is_rejected(transport: Connection | None) -> None:
    assert not is_local_connection(transport)
    assert not may_be_own_user(transport)


@pytest.mark.parametrize(
    ("peer", "own_address", "is_local"),
    [
        (("127.0.0.2", 1), ("127.0.0.1", 2), True),
        (("192.0.2.1", 1), ("192.0.2.1", 2), True),
        (("192.0.2.1", 1), ("192.0.2.2", 2), False),
        (("::1", 1, 0, 0), ("::1", 2, 0, 0), True),
        (("::ffff:127.0.0.1", 1, 0, 0), ("::ffff:127.0.0.1", 2, 0, 0), True),
        (("fe80::1%eth0", 1, 0, 2), ("fe80::2%eth0", 2, 0, 2), False),
    ],
)
def test_loopback_and_own_addresses_are_local(peer: Any, own_address: Any, is_local: bool) -> None:
    assert is_local_connection(Connection(peer, own_address)) is is_local
