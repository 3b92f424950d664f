"""``linkwright multicast`` and ``linkwright doctor hello``, on one machine."""

from __future__ import annotations

import random
import subprocess
import sys

import pytest

from linkwright.cli import main
from linkwright.diagnostics import LinkwrightError
from linkwright.doctor.hello import Greetings, make_greeting
from linkwright.wire import multicast
from tests.domains import own_domain
from tests.waiting import TIMEOUT_S


def can_multicast() -> bool:
    port = random.SystemRandom().randrange(16_000, 18_000)
    try:
        with multicast.open_receiver(port=port) as receiver, multicast.open_sender() as sender:
            receiver.settimeout(1.0)
            multicast.send(sender, b"", port=port)
            receiver.recv(1)
    except (LinkwrightError, TimeoutError):
        return False
    return True


with_multicast = pytest.mark.skipif(not can_multicast(), reason="this machine has no interface with multicast")


@pytest.fixture
def address() -> list[str]:
    """Return options for a group and a port of this test only."""
    chosen = random.SystemRandom()
    group = f"234.{chosen.randrange(255)}.{chosen.randrange(255)}.{chosen.randrange(1, 255)}"
    return ["--group", group, "--port", str(chosen.randrange(16_000, 18_000))]


@with_multicast
def test_multicast_receive_gets_sent_datagram(address):
    words = [sys.executable, "-m", "linkwright", "multicast", "receive", *address]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as receiving:
        assert receiving.stdout.readline() == "Waiting for UDP multicast datagram...\n"
        assert main(["multicast", "send", *address, "--ttl", "1"]) == 0
        output, _ = receiving.communicate(timeout=TIMEOUT_S)
    assert output.startswith("Received from ")
    assert output.endswith(": 'Hello World!'\n")
    assert receiving.returncode == 0


@pytest.mark.parametrize(
    "words", [["--group", "10.0.0.1"], ["--group", "all"], ["--port", "0"], ["--port", "70000"], ["--ttl", "256"]]
)
def test_invalid_address_options_are_usage_errors(words, capsys):
    assert main(["multicast", "send", *words]) == 2
    assert "value must be" in capsys.readouterr().err


def test_unreachable_network_is_reported(monkeypatch, capsys):
    def refuse(*_):
        raise OSError(101, "Network is unreachable")

    monkeypatch.setattr("linkwright.wire.multicast.socket.socket.sendto", refuse, raising=False)
    assert main(["multicast", "send"]) == 1
    err = capsys.readouterr().err
    assert "error[CLI461]: multicast to 225.0.0.1:49150 is not possible here" in err
    assert "Network is unreachable" in err


def test_greetings_are_counted_by_host_until_table_is_taken():
    counts = Greetings("desk", published_count=2, sent_count=1)
    for host in ("robot", "desk", "robot", "laptop"):
        counts.count_topic_greeting(make_greeting(host))
    counts.count_multicast_greeting("hello, it's me robot")
    counts.count_multicast_greeting("")
    assert counts.pop_table("/t", 0.5).splitlines() == [
        "MULTIMACHINE COMMUNICATION SUMMARY",
        "Topic: /t, Published Msg Count: 2",
        "Subscribed from:",
        f"{'':16}{'Hostname':21}Msg Count /0.5s",
        f"{'':16}{'robot':21}{'2':10}",
        f"{'':16}{'laptop':21}{'1':10}",
        "Multicast Group/Port: 225.0.0.1/49150, Sent Msg Count: 1",
        "Received from:",
        f"{'':16}{'Hostname':21}Msg Count /0.5s",
        f"{'':16}{'robot':21}{'1':10}",
        "-" * 60,
    ]
    assert counts.pop_table("/t", 0.5).count("robot") == 0


@with_multicast
@pytest.mark.parametrize("name", ["doctor", "wtf"])
def test_doctor_hello_once_prints_one_table(name, monkeypatch, capsys):
    monkeypatch.setenv("ROS_DOMAIN_ID", str(own_domain()))
    monkeypatch.delenv("LINKWRIGHT_DDS", raising=False)
    assert main([name, "hello", "--once", "--topic", "/greetings"]) == 0
    out = capsys.readouterr().out
    assert out.count("MULTIMACHINE COMMUNICATION SUMMARY") == 1
    assert "Topic: /greetings, Published Msg Count: 1" in out
    assert "Sent Msg Count: 1" in out
