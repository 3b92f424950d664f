"""Hosts in several networks, joined as `docs/beyond-one-machine.md` says.

They use the files on that page.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.docs.pages import DOCS
from tests.wire.programs import Program
from tests.wire.zenoh.hosts import (
    CLOUD,
    CLOUD_ADDRESS,
    DESK,
    DESKS_CLOUD_ADDRESS,
    GATEWAY,
    ROBOT,
    Hosts,
    unsupported_reason,
)

NAME = "cloud.example.com"
MESSAGE_COUNT = 400

pytestmark = pytest.mark.slow


class Site:
    """A robot behind a gateway, a cloud and a desk, each with its program.

    Certificates and files are in a folder.
    """

    def __init__(self, folder: Path) -> None:
        page = (DOCS / "beyond-one-machine.md").read_text(encoding="utf-8")
        certificates = next(iter(re.findall(r"```bash\n(openssl .*?)```", page, re.DOTALL)))
        names = f"DNS:{NAME},IP:{CLOUD_ADDRESS},IP:{DESKS_CLOUD_ADDRESS}"
        certificates = certificates.replace(f"DNS:{NAME}", names)
        subprocess.run(["bash", "-ec", certificates], cwd=folder, check=True, capture_output=True)
        for name, text in re.findall(r"```json5\n// (\S+)\n(.*?)```", page, re.DOTALL):
            address = DESKS_CLOUD_ADDRESS if name == "desk.json5" else CLOUD_ADDRESS
            (folder / name).write_text(text.replace(NAME, address))
        self._folder = folder
        self.hosts = Hosts()
        self._started: list[Program | subprocess.Popen[str]] = []

    def router(self, host: str, file: str) -> None:
        """Start a router, and return when it listens."""
        command = [sys.executable, "-m", "linkwright.node_program", "rmw_zenoh_cpp", "rmw_zenohd"]
        router = subprocess.Popen(
            [*self.hosts.within(host), *command],
            cwd=self._folder,
            env={**os.environ, "ZENOH_ROUTER_CONFIG_URI": file},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self._started.append(router)
        assert router.stdout is not None
        assert "Zenoh router at" in router.stdout.readline()

    def program(self, host: str, name: str, **environment: str) -> Program:
        """Start a program with a graph."""
        program = Program("far_program", name, prefix_words=self.hosts.within(host), folder=self._folder, **environment)
        self._started.append(program)
        return program

    def close(self) -> None:
        """End all programs, and remove the hosts."""
        for process in self._started:
            if isinstance(process, Program):
                process.end()
            else:
                process.kill()
                process.communicate()
        self.hosts.close()


@pytest.fixture
def site(tmp_path, monkeypatch) -> Iterator[Site]:
    reason = unsupported_reason()
    if reason:
        pytest.skip(reason)
    monkeypatch.delenv("ZENOH_CONFIG_OVERRIDE")
    site = Site(tmp_path)
    try:
        site.router(CLOUD, "cloud.json5")
        site.router(ROBOT, "robot.json5")
        yield site
    finally:
        site.close()


@pytest.fixture
def robot(site) -> Program:
    return site.program(ROBOT, "robot")


@pytest.fixture
def desk(site, robot) -> Program:
    desk: Program = site.program(DESK, "desk", ZENOH_SESSION_CONFIG_URI="desk.json5")
    desk.ask_until(lambda nodes: "robot" in nodes, "nodes")
    robot.ask_until(lambda nodes: "desk" in nodes, "nodes")
    return desk


def start_publishing(robot: Program, desk: Program, topic: str, qos: str, **options: Any) -> None:
    """Let the robot publish numbers that the desk records."""
    robot.ask("advertise", topic, qos)
    desk.ask("subscribe", topic, qos)
    robot.ask_until(bool, "subscription_count", topic)
    robot.ask("publish_numbers", topic, options["count"], options["rate"], options["size"])


def test_reliable_topics_survive_link_failure_and_packet_loss(site, robot, desk):
    topics = {"/robot1/everything": "everything", "/robot1/lasting": "lasting"}
    for topic, qos in topics.items():
        start_publishing(robot, desk, topic, qos, count=MESSAGE_COUNT, rate=40.0, size=100)
    desk.ask_until(lambda numbers: len(numbers) > MESSAGE_COUNT // 10, "received", "/robot1/everything")
    site.hosts.link(is_up=False)
    count = robot.ask_until(lambda count: count > MESSAGE_COUNT // 2, "published_count", "/robot1/lasting")
    assert len(desk.ask("received", "/robot1/lasting")) < count
    site.hosts.link(is_up=True)
    lossy = ("-m", "statistic", "--mode", "random", "--probability", "0.05", "-j", "DROP")
    site.hosts.run(GATEWAY, "iptables", "-A", "FORWARD", *lossy)
    for topic in topics:
        numbers = desk.ask_until(lambda numbers: len(numbers) >= MESSAGE_COUNT, "received", topic, seconds=180)
        assert numbers == list(range(MESSAGE_COUNT))


def test_latched_topic_catches_up_after_reconnect(site, robot, desk):
    start_publishing(robot, desk, "/robot1/lasting", "lasting", count=MESSAGE_COUNT, rate=40.0, size=100)
    desk.ask_until(lambda numbers: len(numbers) > MESSAGE_COUNT // 10, "received", "/robot1/lasting")
    site.hosts.run(GATEWAY, "ip", "link", "set", f"to{CLOUD}", "down")  # the gateway then drops its NAT table
    robot.ask_until(lambda count: count > MESSAGE_COUNT // 2, "published_count", "/robot1/lasting")
    site.hosts.run(GATEWAY, "ip", "link", "set", f"to{CLOUD}", "up")
    numbers = desk.ask_until(
        lambda numbers: len(set(numbers)) >= MESSAGE_COUNT, "received", "/robot1/lasting", seconds=180
    )
    assert sorted(set(numbers)) == list(range(MESSAGE_COUNT))


def test_desk_receives_only_subscribed_and_publishes_only_allowed_topics(site, robot, desk):
    for topic in ("/robot1/cmd_vel", "/robot1/secret"):
        desk.ask("advertise", topic, "everything")
        robot.ask("subscribe", topic, "everything")
    desk.ask_until(bool, "subscription_count", "/robot1/cmd_vel")
    for topic in ("/robot1/secret", "/robot1/cmd_vel"):
        desk.ask("publish_numbers", topic, 20, 100.0, 10)
    robot.ask_until(lambda numbers: len(numbers) == 20, "received", "/robot1/cmd_vel")
    assert robot.ask("received", "/robot1/secret") == []

    image = 200_000
    robot.ask("advertise", "/robot1/camera", "last")
    robot.ask("publish_numbers", "/robot1/camera", 1_000_000, 20.0, image)
    bytes_before = site.hosts.received(DESK, CLOUD)
    first = robot.ask_until(lambda count: count > 20, "published_count", "/robot1/camera")
    bytes_without_subscription = site.hosts.received(DESK, CLOUD) - bytes_before
    assert bytes_without_subscription < image * first / 20, "images were sent without a subscription"
    desk.ask("subscribe", "/robot1/camera", "last")
    numbers = len(desk.ask_until(lambda numbers: len(numbers) > 5, "received", "/robot1/camera"))
    assert site.hosts.received(DESK, CLOUD) - bytes_before > image * numbers


def test_host_without_valid_certificate_is_rejected(site, robot, tmp_path):
    certificate_command = (
        "openssl req -x509 -newkey rsa:2048 -nodes -keyout desk-key.pem -out desk.pem -days 1 -subj /CN=desk"
    )
    subprocess.run(certificate_command.split(), cwd=tmp_path, check=True, capture_output=True)
    outsider = site.program(DESK, "outsider", ZENOH_SESSION_CONFIG_URI="desk.json5")
    assert outsider.ask("nodes") == ["outsider"]
    assert "outsider" not in robot.ask("nodes")
