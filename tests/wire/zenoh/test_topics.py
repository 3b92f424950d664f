"""Topics between processes over Zenoh: discovery, domains and QoS."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
import time

import zenoh

from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind
from linkwright.graph.names.rules import NodeIdentity
from linkwright.graph.qos.profile import (
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from linkwright.graph.time.values import Duration
from linkwright.messages import String, serialize, type_hash
from linkwright.wire.zenoh import transport
from linkwright.wire.zenoh.session import build_config, open_session
from linkwright.wire.zenoh.settings import read_settings
from linkwright.wire.zenoh.tokens import Token
from linkwright.wire.zenoh.topics import OutgoingTopic
from tests.waiting import TIMEOUT_S, wait_until
from tests.wire.programs import linkwright
from tests.wire.test_topics import TRANSIENT_LOCAL


def test_qos_of_remote_endpoints_is_available_and_always_matches(processes):
    a, b = processes("a"), processes("b")
    offered = QoSProfile(
        7,
        reliability=ReliabilityPolicy.BEST_EFFORT,
        deadline=Duration(seconds=1),
        lifespan=Duration(seconds=3),
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=Duration(seconds=2),
    )
    texts: list[str] = []
    publisher = a.node.create_publisher(String, "chatter", offered)
    b.node.create_subscription(String, "chatter", lambda message: texts.append(message.data), 10)
    a.spin_until(lambda: publisher.get_subscription_count() == 1)
    b.spin_until(lambda: b.node.count_publishers("chatter"))
    (endpoint,) = b.node.get_publishers_info_by_topic("/chatter")
    assert endpoint.qos_profile == offered
    publisher.publish(String(data="hej"))
    b.spin_until(lambda: texts == ["hej"])
    assert not [text for text in (*a.warnings(), *b.warnings()) if "incompatible" in text]


def test_closing_latched_publisher_does_not_wait_for_callbacks(processes):
    """Closing a latched publisher does not wait for callbacks.

    A thread with Python's lock must not wait for a Zenoh callback that needs the lock, which took 10 s.
    """
    node = processes("ours", join_now=False).node
    result = threading.Event()

    def changed() -> None:
        result.set()
        time.sleep(0.3)  # the callback then needs the lock

    with (
        open_session(build_config(read_settings())) as linkwright_session,
        open_session(build_config(read_settings())) as other_session,
    ):

        def announce(name: str, number: str, qos: QoSProfile) -> OutgoingTopic:
            publisher = node.create_publisher(String, name, qos)
            names = (EndpointKind.PUBLISHER, name, "std_msgs::msg::dds_::String_", "RIHS01_00")
            token = Token(0, str(linkwright_session.zid()), "0", number, NodeIdentity("ours", "/"), *names)
            return OutgoingTopic(publisher, token, linkwright_session, changed)

        latched, other = announce("/kept", "1", TRANSIENT_LOCAL), announce("/other", "2", QoSProfile(10))
        history_key = f"{latched.token.data_key}/@adv/**"
        wait_until(lambda: list(other_session.liveliness().get(history_key)))
        listener = other_session.declare_subscriber(other.token.data_key)
        assert result.wait(TIMEOUT_S)
        start = time.monotonic()
        latched.close()
        assert time.monotonic() - start < 5.0
        wait_until(lambda: not list(other_session.liveliness().get(history_key)))
        other.close()
        listener.undeclare()


def test_remote_nodes_and_topics_appear_and_disappear(processes):
    a, b = processes("a"), processes("b")
    b.node.create_publisher(String, "/far/chatter", 10)
    a.spin_until(lambda: "b" in a.node.get_node_names())
    a.spin_until(lambda: ("/far/chatter", ["std_msgs/msg/String"]) in a.node.get_topic_names_and_types())
    (endpoint,) = a.node.get_publishers_info_by_topic("/far/chatter")
    assert endpoint.node_name == "b"
    b.close()
    a.spin_until(lambda: "b" not in a.node.get_node_names())
    assert a.node.count_publishers("/far/chatter") == 0


def test_discovery_does_not_settle_before_first_link(processes, monkeypatch):
    monkeypatch.setattr(transport, "_ALONE_TIMEOUT_S", float("inf"))
    a = processes("a")
    assert not a.transport.wait_for_discovery(2 * transport.SETTLE_TIME_S)
    processes("b")
    assert a.transport.wait_for_discovery(TIMEOUT_S)
    assert "b" in a.node.get_node_names()


def test_domains_are_isolated(processes, monkeypatch, domain):
    a = processes("a")
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain + 100))
    b = processes("b")
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
    c = processes("c")
    a.spin_until(lambda: "c" in a.node.get_node_names())
    assert "b" not in a.node.get_node_names()
    assert b.node.get_node_names() == ["b"]
    assert c.transport.wait_for_discovery(60)


def test_humble_has_no_type_hashes(processes, monkeypatch):
    monkeypatch.setenv("ROS_DISTRO", "humble")
    a, b = processes("a"), processes("b")
    texts: list[str] = []
    b.node.create_subscription(String, "chatter", lambda message: texts.append(message.data), 10)
    publisher = a.node.create_publisher(String, "chatter", 10)
    a.spin_until(lambda: publisher.get_subscription_count() == 1)
    publisher.publish(String(data="hej"))
    b.spin_until(lambda: texts)
    with open_session(build_config(read_settings())) as session:
        key = f"{read_settings().domain_id}/chatter/std_msgs::msg::dds_::String_/TypeHashNotSupported"
        probe = session.declare_publisher(key)
        b.spin_until(lambda: probe.matching_status.matching)


def test_sample_without_attachment_is_dropped_and_reported_once(processes):
    process = processes("ours")
    texts: list[str] = []
    process.node.create_subscription(String, "chatter", lambda message: texts.append(message.data), 10)
    with open_session(build_config(read_settings())) as session:
        key = f"{read_settings().domain_id}/chatter/std_msgs::msg::dds_::String_/{type_hash(String)}"
        raw_publisher = session.declare_publisher(key, congestion_control=zenoh.CongestionControl.BLOCK)
        process.spin_until(lambda: raw_publisher.matching_status.matching)
        for _ in range(3):
            raw_publisher.put(serialize(String(data="who am I")))
        process.spin_until(process.warnings)
    assert not texts
    (text,) = process.warnings()
    assert "it lacks the sender" in text


def test_raw_subscription_accepts_unknown_type(processes):
    process = processes("ours")
    payloads: list[bytes] = []
    process.node.create_subscription("strange_msgs/msg/Odd", "odd", payloads.append, 10, raw=True)
    with open_session(build_config(read_settings())) as session:
        from linkwright.wire.zenoh import attachment

        raw_publisher = session.declare_publisher(
            f"{read_settings().domain_id}/odd/strange_msgs::msg::dds_::Odd_/RIHS01_00"
        )
        process.spin_until(lambda: raw_publisher.matching_status.matching)
        raw_publisher.put(b"\0\1\0\0abcd", attachment=attachment.write(1, 2, bytes(16)))
        process.spin_until(lambda: payloads)
    assert payloads == [b"\0\1\0\0abcd"]


def test_closed_publisher_is_not_lost_and_killed_one_is(processes, programs):
    process = processes("ours")
    lost: list[EndpointInfo] = []
    process.node.create_subscription(String, "/other", lambda _: None, 10).watch_lost(lost.append)
    peer, marker = processes("theirs"), programs("linkwright_program", "marker")
    publisher = peer.node.create_publisher(String, "/other", 10)
    peer.node.create_publisher(String, "/other", 10)
    process.spin_until(lambda: process.node.count_publishers("/other") == 2)
    publisher.destroy()
    process.spin_until(lambda: process.node.count_publishers("/other") == 1)
    peer.close()
    process.spin_until(lambda: process.node.count_publishers("/other") == 0)
    process.node.create_subscription("rcl_interfaces/msg/Log", "/rosout", lambda _: None, 10).watch_lost(lost.append)
    process.spin_until(lambda: "marker" in process.node.get_node_names())
    process.spin_until(lambda: process.node.count_publishers("/rosout") == 2)
    marker.kill()
    process.spin_until(lambda: lost)  # reports about publishers that left would have come first
    assert {endpoint.node.name for endpoint in lost} == {"marker"}, lost
    restarted_program = programs("linkwright_program", "marker")
    process.spin_until(lambda: process.node.get_node_names().count("marker") == 1)
    restarted_program.ask_until(
        lambda nodes: nodes == ["marker", "ours"], "nodes"
    )  # the discovery must work in both directions


LAUNCH_FILE = """
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package='demo_nodes_cpp', executable='talker')])
"""


def test_verb_receives_messages_of_launched_node(tmp_path):
    """The launch sets Humble, whose types have no hash on the wire, for its nodes.

    The verb does not know that.
    """
    (tmp_path / "talk.launch.py").write_text(LAUNCH_FILE)
    words = [sys.executable, "-m", "linkwright", "launch", str(tmp_path / "talk.launch.py")]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=tmp_path) as launch:
        try:
            assert linkwright("topic", "echo", "--once", "/chatter", "std_msgs/msg/String")[0].startswith(
                "data: 'Hello World: "
            )
        finally:
            launch.send_signal(signal.SIGINT)
            launch.communicate(timeout=60)
