"""Bytes on the wire that are not messages."""

from __future__ import annotations

import pytest

from tests.reliability.running import Machine
from tests.waiting import wait_until

LISTENER = """
from std_srvs.srv import SetBool

class Program(Node):
    def __init__(self):
        super().__init__("listener")
        self.create_subscription(String, "words", lambda message: say("heard", repr(message.data)[:40]), 10)
        self.create_service(SetBool, "flip", self.flip)
        say("up")

    def flip(self, request, response):
        response.success = not request.data
        return response
"""


@pytest.mark.slow
def test_malformed_packets_are_dropped_and_reported_once(machine: Machine) -> None:
    listener = machine.program(LISTENER)
    listener.wait_for("up")
    garbage = machine.python("-m", "tests.reliability.garbage", machine.variables["ROS_DOMAIN_ID"])
    garbage.wait_for("last")
    listed = machine.verb("node", "list")
    assert "/listener" in listed.split()
    assert "\x1b" not in listed
    listener.wait_for("heard 'fine'")
    (machine.folder / "leave").touch()
    garbage.wait_for("done")
    for topic in ("rt/words", "rq/flipRequest", "ros_discovery_info"):
        assert topic in next(line for line in garbage.lines if line.startswith("matched")), garbage.text
    assert listener.process.poll() is None
    assert "Traceback" not in listener.text, listener.text
    assert listener.count("Dropped a malformed message of topic '/words'") == 1
    assert listener.count("alformed request") <= 1
    response = machine.verb("service", "call", "/flip", "std_srvs/srv/SetBool", "{data: false}")
    assert "success=True" in response
    assert "/listener" in machine.verb("node", "list").split()
    garbage.wait()
    wait_until(lambda: machine.verb("node", "list").split() == ["/listener"])
    assert listener.interrupt() == 0
