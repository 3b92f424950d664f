"""Several simultaneous commanders.

The tests cover sequences of contradictory commands, and the report about them.
"""

from __future__ import annotations

from collections.abc import Iterable

import pytest

from linkwright.graph import EndpointKind, MessageInfo, NodeIdentity, QoSProfile
from linkwright.graph.endpoints.base import EndpointInfo
from linkwright.graph.endpoints.command_disputes import DisputeDetector, DisputeMonitor
from linkwright.graph.log.logger import Logger
from linkwright.messages import get_message

Twist, Stamped = get_message("geometry_msgs/msg/Twist"), get_message("geometry_msgs/msg/TwistStamped")
SentCommand = tuple[float, str, float]
"""A command: the time in seconds, the name of the publisher, and the speed."""


def command_stream(sender: str, begin: float, end: float, rate: float, speed: float) -> list[SentCommand]:
    """Return periodic commands."""
    return [(begin + number / rate, sender, speed) for number in range(round((end - begin) * rate))]


def find_disputes(
    *streams: Iterable[SentCommand], dispute: DisputeDetector | None = None
) -> list[tuple[float, set[object]]]:
    """Return the times of reports, and the disputing publishers."""
    dispute = dispute or DisputeDetector()
    reports = []
    for now, sender, speed in sorted(command for stream in streams for command in stream):
        if dispute.record_command(sender, speed, now):
            reports.append((now, set(dispute.parties)))
    return reports


@pytest.mark.parametrize(
    "streams",
    [
        (command_stream("keys", 0, 60, 10, 0.3),),
        (command_stream("keys", 0, 10, 10, 0.3), command_stream("planner", 10, 60, 20, 0.5)),
        (command_stream("keys", 0, 60, 10, 0.3), command_stream("planner", 0.05, 60, 10, 0.3)),
        (command_stream("keys", 0, 60, 10, 0.0), command_stream("planner", 0.05, 60, 10, 0.0)),
        (command_stream("planner", 0, 60, 20, 0.5), [(20.01, "behaviors", 0.0), (40.01, "behaviors", 0.0)]),
        (command_stream("smoother", 0, 11.3, 20, 0.3), command_stream("behaviors", 10, 30, 10, -0.05)),
        (command_stream("planner", 0, 60, 20, 0.5), [(10.0 * tap, "keys", 0.1) for tap in range(1, 6)]),
        (
            command_stream("planner", 0, 5, 20, 0.5),
            command_stream("behaviors", 5, 8, 10, -0.05),
            command_stream("planner", 8, 12, 20, 0.5),
            command_stream("behaviors", 12, 15, 10, 1.0),
        ),
    ],
    ids=["one", "handover", "alike", "both still", "stops", "a smoother that runs out", "taps", "recoveries"],
)
def test_normal_command_patterns_are_not_reported(streams):
    assert find_disputes(*streams) == []


@pytest.mark.parametrize(("first", "second"), [(10.0, 10.0), (1.0, 1.0), (50.0, 1.0), (100.0, 20.0)])
def test_contradicting_publishers_are_reported_once(first, second):
    ((when, senders),) = find_disputes(
        command_stream("keys", 5, 60, first, 0.3), command_stream("planner", 10.003, 60, second, -0.1)
    )
    assert senders == {"keys", "planner"}
    assert 12.9 <= when <= 14.1


def test_publisher_of_zero_commands_counts_as_driver():
    assert find_disputes(command_stream("joystick", 0, 9, 10, 0.0), command_stream("planner", 0.03, 9, 20, 0.5))


def test_third_driver_is_reported_and_all_again_after_a_break():
    reports = find_disputes(
        command_stream("a", 0, 20, 10, 0.1),
        command_stream("b", 0.01, 20, 10, 0.2),
        command_stream("c", 10.02, 20, 10, 0.3),
        command_stream("a", 40, 50, 10, 0.1),
        command_stream("b", 40.01, 50, 10, 0.2),
    )
    assert [senders for _, senders in reports] == [{"a", "b"}, {"a", "b", "c"}, {"a", "b"}]


def test_short_break_is_not_reported_again():
    bursts = [(0, 5), (9, 14), (18, 23)]
    streams = [
        command_stream(sender, begin + shift, end, 10, 0.1 + shift)
        for sender, shift in (("a", 0), ("b", 0.01))
        for begin, end in bursts
    ]
    assert len(find_disputes(*streams)) == 1


def test_time_jump_back_resets_dispute():
    dispute = DisputeDetector()
    assert (
        find_disputes(
            command_stream("a", 100, 102, 10, 0.1), command_stream("b", 100.01, 102, 10, 0.2), dispute=dispute
        )
        == []
    )
    assert (
        find_disputes(command_stream("a", 0, 2, 10, 0.1), command_stream("b", 0.01, 2, 10, 0.2), dispute=dispute) == []
    )
    assert find_disputes(command_stream("a", 2, 4, 10, 0.1), command_stream("b", 2.01, 4, 10, 0.2), dispute=dispute)


class KnownPublishers:
    """A graph with publishers of named nodes."""

    def __init__(self, nodes: dict[bytes, str | None], duplicate_name: str = "") -> None:
        self._nodes = nodes
        self._names = [*{name for name in nodes.values() if name}, *([duplicate_name] if duplicate_name else [])]

    def endpoints(self) -> list[EndpointInfo]:
        kind, qos = EndpointKind.PUBLISHER, QoSProfile(10)
        return [
            EndpointInfo(kind, NodeIdentity(name, "/") if name else None, "/cmd_vel", Twist.TYPE_NAME, qos, gid)
            for gid, name in self._nodes.items()
        ]

    def identities(self) -> list[NodeIdentity]:
        return [NodeIdentity(name, "/") for name in self._names]


def find_warnings(graph: KnownPublishers, message_type: type = Twist) -> list[str]:
    """Return the warnings about publishers that drive for five seconds."""
    log: list[str] = []
    now = 0
    watch = DisputeMonitor(Logger("drive", lambda record: log.append(record.text), lambda: 0), graph, lambda: now)
    for tick in range(50):
        for number, endpoint in enumerate(graph.endpoints()):
            now = tick * 100_000_000 + number
            message = message_type()
            if message_type is Stamped:
                message.header.stamp.sec = number
                message.twist.linear.x = float(number)
            else:
                message.linear.x = float(number)
            watch.record_command(message, MessageInfo(0, 0, endpoint.gid))
    return log


@pytest.mark.parametrize("message_type", [Twist, Stamped])
def test_warning_names_nodes_and_suggests_fixes(message_type):
    (text,) = find_warnings(KnownPublishers({b"1": "keys", b"2": "planner", b"3": "keys"}), message_type)
    assert text == (
        "several nodes drive the robot: '/keys', '/planner' send commands on '/cmd_vel', and the robot jerks because "
        "it follows each message in turn. Stop all but one of them, remap their topics (-r /cmd_vel:=...), or let "
        "twist_mux choose by priority"
    )


def test_dispute_compares_nodes_instead_of_publishers():
    assert find_warnings(KnownPublishers({b"1": "keys", b"2": "keys"})) == []
    (text,) = find_warnings(KnownPublishers({b"1": "keys", b"2": "keys"}, duplicate_name="keys"))
    assert text.startswith("several nodes drive the robot: '/keys', '/keys' send commands on")


def test_unknown_publishers_are_not_reported():
    assert find_warnings(KnownPublishers({b"1": "keys", b"2": None})) == []
