"""The number of other processes in a domain, counted by the ports on which they listen."""

from __future__ import annotations

import os
import socket
import sys

import pytest

from linkwright.wire.dds.local_sockets import compute_multicast_port, count_other_processes, count_waiting_bytes

DOMAIN_ID = 7
FIRST = compute_multicast_port(DOMAIN_ID)

on_linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the test reads /proc")


@pytest.fixture
def write_tables(tmp_path):
    """Return a function that writes the system's tables with sockets at these ports."""

    def write(*ports: int, **inodes: int) -> object:
        lines = ["  sl  local_address rem_address   st ..."]
        for number, port in enumerate(ports):
            inode = inodes.get(f"p{port}", 1_000_000_000 + number)
            lines.append(f" {number}: 00000000:{port:04X} 00000000:0000 07 0:0 00:0 0 0 0 {inode} 2 0000 0")
        (tmp_path / "udp").write_text("\n".join(lines) + "\n")
        (tmp_path / "udp6").write_text(lines[0] + "\n")
        return tmp_path

    return write


@on_linux
@pytest.mark.parametrize(
    ("ports", "count"),
    [
        ((), 0),
        ((FIRST, FIRST + 1, FIRST + 10, FIRST + 11), 1),  # as Cyclone and Fast DDS listen
        ((FIRST, FIRST + 10, FIRST, FIRST + 12, FIRST, FIRST + 14), 3),
        ((FIRST + 10, FIRST + 11, FIRST + 30), 2),  # only unicast
        ((FIRST, FIRST), 2),  # only multicast, with unicast ports that the system chose
        ((FIRST + 10, FIRST, FIRST), 2),
        ((FIRST - 250, FIRST + 250, 53, 5353), 0),  # other domains, and sockets without DDS
    ],
)
def test_processes_are_counted_by_their_ports(write_tables, ports, count):
    assert count_other_processes(DOMAIN_ID, write_tables(*ports)) == count


@on_linux
def test_sockets_of_this_process_are_not_counted(write_tables):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as own_socket:
        inode = os.fstat(own_socket.fileno()).st_ino
        assert count_other_processes(DOMAIN_ID, write_tables(FIRST, **{f"p{FIRST}": inode})) == 0


def test_count_is_unknown_without_socket_tables(tmp_path):
    assert count_other_processes(DOMAIN_ID, tmp_path) is None


@on_linux
def test_malformed_socket_table_gives_no_count(tmp_path):
    (tmp_path / "udp").write_text("sl\nsomething else\n")
    (tmp_path / "udp6").write_text("sl\n")
    assert count_other_processes(DOMAIN_ID, tmp_path) is None


@on_linux
def test_other_process_is_counted_by_system_tables(processes, programs, domain):
    assert count_other_processes(domain) == 0
    programs("linkwright_program", "one")
    assert count_other_processes(domain) == 1
    processes("ours")  # this process has sockets too
    assert count_other_processes(domain) == 1


@on_linux
def test_waiting_bytes_are_reported_until_received():
    sending = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    receiving = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    with sending, receiving:
        receiving.bind(("127.0.0.1", 0))
        port = receiving.getsockname()[1]
        assert count_waiting_bytes(port) == 0
        sending.sendto(bytes(50_000), ("127.0.0.1", port))
        waiting = count_waiting_bytes(port)
        assert waiting is not None
        assert waiting >= 50_000
        receiving.recv(50_000)
        assert count_waiting_bytes(port) == 0
    assert count_waiting_bytes(port) == 0


def test_waiting_bytes_are_unknown_without_socket_tables(tmp_path):
    assert count_waiting_bytes(7411, tmp_path) is None
