"""Hosts on one machine.

They are network namespaces, connected by virtual cables, one of them through NAT.

    robot 192.168.7.2 -- gateway (NAT) -- cloud 10.99.7.1 -- desk 10.99.8.2

The robot cannot be reached from outside: it has to connect itself, as behind a home router or a mobile network.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

ROBOT, GATEWAY, CLOUD, DESK = "robot", "gateway", "cloud", "desk"
CLOUD_ADDRESS = "10.99.7.1"
DESKS_CLOUD_ADDRESS = "10.99.8.1"
"""The cloud's address for the robot, and for the desk."""


def unsupported_reason() -> str:
    """Return why this machine cannot have such hosts, or ""."""
    if sys.platform != "linux":
        return "network namespaces exist only on Linux"
    for program in ("ip", "iptables", "openssl"):
        if shutil.which(program) is None:
            return f"the program '{program}' is not installed"
    probe = f"lwp{os.getpid()}"
    if _run("ip", "netns", "add", probe, check=False):
        return "creating network namespaces requires root"
    translated = _run(*_namespace_prefix(probe), "iptables", *_MASQUERADE, "lo", check=False)
    _run("ip", "netns", "delete", probe)
    return "iptables cannot do NAT here" if translated else ""


_MASQUERADE = ("-t", "nat", "-A", "POSTROUTING", "-j", "MASQUERADE", "-o")


class Hosts:
    """The four hosts, until `close` removes them."""

    def __init__(self) -> None:
        self._namespaces_to_delete: list[str] = []
        prefix = f"lw{os.getpid()}"
        self.namespaces = {name: f"{prefix}{name}" for name in (ROBOT, GATEWAY, CLOUD, DESK)}
        for namespace in self.namespaces.values():
            _run("ip", "netns", "add", namespace)
            self._namespaces_to_delete.append(namespace)
            _run(*_namespace_prefix(namespace), "ip", "link", "set", "lo", "up")
        self._cable(ROBOT, "192.168.7.2", GATEWAY, "192.168.7.1")
        self._cable(GATEWAY, "10.99.7.2", CLOUD, CLOUD_ADDRESS)
        self._cable(DESK, "10.99.8.2", CLOUD, DESKS_CLOUD_ADDRESS)
        self.run(GATEWAY, "sysctl", "-qw", "net.ipv4.ip_forward=1")
        self.run(GATEWAY, "iptables", *_MASQUERADE, f"to{CLOUD}")
        self.run(ROBOT, "ip", "route", "add", "default", "via", "192.168.7.1")

    def within(self, host: str) -> tuple[str, ...]:
        """Return the words before a command that run it on a host."""
        return _namespace_prefix(self.namespaces[host])

    def run(self, host: str, *command: str, check: bool = True) -> int:
        """Run a command on a host, and return its exit status."""
        return _run(*self.within(host), *command, check=check)

    def link(self, *, is_up: bool) -> None:
        """Cut or restore the link between gateway and cloud. The gateway keeps its NAT table."""
        self.run(CLOUD, "ip", "link", "set", f"to{GATEWAY}", "up" if is_up else "down")

    def received(self, host: str, other: str) -> int:
        """Return the number of bytes that a host has received over its cable to another one."""
        lines = subprocess.check_output([*self.within(host), "cat", "/proc/net/dev"], text=True).splitlines()
        return next(int(line.split()[1]) for line in lines if line.strip().startswith(f"to{other}:"))

    def close(self) -> None:
        """Remove all namespaces."""
        while self._namespaces_to_delete:
            _run("ip", "netns", "delete", self._namespaces_to_delete.pop(), check=False)

    def _cable(self, a: str, address_a: str, b: str, address_b: str) -> None:
        namespace = self.namespaces[b]
        self.run(a, "ip", "link", "add", f"to{b}", "type", "veth", "peer", "name", f"to{a}", "netns", namespace)
        for host, other, address in ((a, b, address_a), (b, a, address_b)):
            self.run(host, "ip", "address", "add", f"{address}/24", "dev", f"to{other}")
            self.run(host, "ip", "link", "set", f"to{other}", "up")


def _namespace_prefix(namespace: str) -> tuple[str, ...]:
    return ("ip", "netns", "exec", namespace)


def _run(*command: str, check: bool = True) -> int:
    return subprocess.run(command, check=check, capture_output=True).returncode
