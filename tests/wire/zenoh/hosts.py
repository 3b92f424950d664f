"""Hosts on one machine: network namespaces, joined by cables of which one goes through a translation of addresses.

    robot 192.168.7.2 -- gateway (translates) -- cloud 10.99.7.1 -- desk 10.99.8.2

Nobody reaches the robot from outside: it has to connect by itself, as behind a router at home or a mobile line.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

ROBOT, GATEWAY, CLOUD, DESK = "robot", "gateway", "cloud", "desk"
CLOUD_ADDRESS = "10.99.7.1"
DESKS_CLOUD_ADDRESS = "10.99.8.1"
"""The cloud's, as the robot calls it and as the desk does."""


def why_not() -> str:
    """Why there can be no hosts here; empty where there can."""
    if sys.platform != "linux":
        return "network namespaces are Linux's"
    for program in ("ip", "iptables", "openssl"):
        if shutil.which(program) is None:
            return f"there is no program '{program}'"
    probe = f"lwp{os.getpid()}"
    if _run("ip", "netns", "add", probe, check=False):
        return "network namespaces cannot be made: that takes root"
    translated = _run(*_within(probe), "iptables", *_MASQUERADE, "lo", check=False)
    _run("ip", "netns", "delete", probe)
    return "iptables cannot translate addresses here" if translated else ""


_MASQUERADE = ("-t", "nat", "-A", "POSTROUTING", "-j", "MASQUERADE", "-o")


class Hosts:
    """The hosts; `close` takes them away."""

    def __init__(self) -> None:
        self._made: list[str] = []
        mark = f"lw{os.getpid()}"
        self.namespaces = {name: f"{mark}{name}" for name in (ROBOT, GATEWAY, CLOUD, DESK)}
        for namespace in self.namespaces.values():
            _run("ip", "netns", "add", namespace)
            self._made.append(namespace)
            _run(*_within(namespace), "ip", "link", "set", "lo", "up")
        self._cable(ROBOT, "192.168.7.2", GATEWAY, "192.168.7.1")
        self._cable(GATEWAY, "10.99.7.2", CLOUD, CLOUD_ADDRESS)
        self._cable(DESK, "10.99.8.2", CLOUD, DESKS_CLOUD_ADDRESS)
        self.run(GATEWAY, "sysctl", "-qw", "net.ipv4.ip_forward=1")
        self.run(GATEWAY, "iptables", *_MASQUERADE, f"to{CLOUD}")
        self.run(ROBOT, "ip", "route", "add", "default", "via", "192.168.7.1")

    def within(self, host: str) -> tuple[str, ...]:
        """What goes before a command that runs on a host."""
        return _within(self.namespaces[host])

    def run(self, host: str, *words: str, check: bool = True) -> int:
        """Run a command on a host; its status."""
        return _run(*self.within(host), *words, check=check)

    def link(self, *, is_up: bool) -> None:
        """Cut the line between gateway and cloud, or mend it. The gateway forgets nothing of what it translates."""
        self.run(CLOUD, "ip", "link", "set", f"to{GATEWAY}", "up" if is_up else "down")

    def received(self, host: str, other: str) -> int:
        """How many bytes have come to a host over its cable to another one."""
        lines = subprocess.check_output([*self.within(host), "cat", "/proc/net/dev"], text=True).splitlines()
        return next(int(line.split()[1]) for line in lines if line.strip().startswith(f"to{other}:"))

    def close(self) -> None:
        """Take all away."""
        while self._made:
            _run("ip", "netns", "delete", self._made.pop(), check=False)

    def _cable(self, a: str, address_a: str, b: str, address_b: str) -> None:
        there = self.namespaces[b]
        self.run(a, "ip", "link", "add", f"to{b}", "type", "veth", "peer", "name", f"to{a}", "netns", there)
        for host, other, address in ((a, b, address_a), (b, a, address_b)):
            self.run(host, "ip", "address", "add", f"{address}/24", "dev", f"to{other}")
            self.run(host, "ip", "link", "set", f"to{other}", "up")


def _within(namespace: str) -> tuple[str, ...]:
    return ("ip", "netns", "exec", namespace)


def _run(*words: str, check: bool = True) -> int:
    return subprocess.run(words, check=check, capture_output=True).returncode
