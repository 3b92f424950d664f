"""Topics between processes over DDS: delivery, latched messages and QoS."""

from __future__ import annotations

import platform
import time

import pytest

from linkwright.graph.endpoints.event_types import SubscriptionEventCallbacks
from linkwright.graph.qos.profile import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
)
from linkwright.graph.time.values import Duration
from linkwright.messages import String, get_message, serialize
from tests.wire.conftest import both_wires

TRANSIENT_LOCAL = QoSProfile(3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
KEEP_ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL)


@both_wires
def test_message_is_delivered_once_between_processes(processes):
    a, b = processes("a"), processes("b")
    texts: list[str] = []
    for process in (a, b):
        process.node.create_subscription(String, "chatter", lambda message: texts.append(message.data), 10)
    publisher = a.node.create_publisher(String, "chatter", 10)
    b.spin_until(lambda: publisher.get_subscription_count() == 2)
    publisher.publish(String(data="hej"))
    b.spin_until(lambda: len(texts) == 1)
    a.spin_until(lambda: len(texts) == 2)
    publisher.publish(String(data="end"))
    b.spin_until(lambda: texts.count("end") == 1)
    a.spin_until(lambda: texts.count("end") == 2)
    a.executor.spin_once(timeout_sec=0.05)
    b.executor.spin_once(timeout_sec=0.05)
    assert texts == ["hej", "hej", "end", "end"]


@both_wires
def test_messages_are_not_serialized_without_remote_subscribers(processes):
    a, b = processes("a"), processes("b")
    publisher = a.node.create_publisher(String, "chatter", 10)
    assert a.transport.wait_until_ready(60)
    assert publisher.send_remote is None
    subscription = b.node.create_subscription(String, "chatter", print, 10)
    a.spin_until(lambda: publisher.send_remote is not None)
    b.node.destroy_subscription(subscription)
    a.spin_until(lambda: publisher.send_remote is None)
    assert publisher.get_subscription_count() == 0


@both_wires
def test_late_subscriber_gets_messages_latched_before_join(processes):
    a = processes("a", join_now=False)
    publisher = a.node.create_publisher(String, "described", TRANSIENT_LOCAL)
    for word in ("one", "two", "three", "four"):
        publisher.publish(String(data=word))
    a.join()
    publisher.publish(String(data="five"))
    b = processes("b")
    texts: list[str] = []
    b.node.create_subscription(String, "described", lambda message: texts.append(message.data), TRANSIENT_LOCAL)
    b.spin_until(lambda: len(texts) == 3)
    assert texts == ["three", "four", "five"]
    publisher.publish(String(data="six"))
    b.spin_until(lambda: len(texts) == 4)
    assert texts[3:] == ["six"]


@both_wires
def test_latched_message_of_same_process_is_delivered_once(processes):
    a, b = processes("a"), processes("b")
    publisher = a.node.create_publisher(String, "described", TRANSIENT_LOCAL)
    publisher.publish(String(data="one"))
    texts: list[str] = []
    for process in (a, b):
        process.node.create_subscription(
            String, "described", lambda message: texts.append(message.data), TRANSIENT_LOCAL
        )
    a.spin_until(lambda: len(texts) == 1)
    b.spin_until(lambda: len(texts) == 2)
    publisher.publish(String(data="two"))
    a.spin_until(lambda: texts.count("two") == 1)
    b.spin_until(lambda: texts.count("two") == 2)
    assert texts == ["one", "one", "two", "two"]


@both_wires
def test_keep_all_messages_arrive_after_publisher_closes(processes):
    a, b = processes("a"), processes("b")
    texts: list[str] = []
    b.node.create_subscription(String, "chatter", lambda message: texts.append(message.data), KEEP_ALL)
    publisher = a.node.create_publisher(String, "chatter", KEEP_ALL)
    a.spin_until(lambda: publisher.get_subscription_count() == 1)
    for number in range(2000):
        publisher.publish(String(data=str(number)))
    a.close()
    b.spin_until(lambda: len(texts) == 2000)
    assert texts == [str(number) for number in range(2000)]


@both_wires
def test_messages_of_new_publisher_reach_known_subscriber(processes):
    a, b = processes("a"), processes("b")
    texts: list[str] = []
    b.node.create_subscription(String, "chatter", lambda message: texts.append(message.data), 10)
    a.spin_until(lambda: a.node.count_subscribers("chatter") == 1)
    publisher = a.node.create_publisher(String, "chatter", 10)
    for word in ("one", "two", "three"):
        publisher.publish(String(data=word))
    assert publisher.wait_for_all_acked(Duration(seconds=5))
    b.spin_until(lambda: len(texts) == 3)
    assert texts == ["one", "two", "three"]


@both_wires
def test_callbacks_get_message_info(processes, wire):
    a, b = processes("a"), processes("b")
    infos = []
    b.node.create_subscription(String, "chatter", lambda _message, info: infos.append(info), 10)
    publisher = a.node.create_publisher(String, "chatter", 10)
    a.spin_until(lambda: publisher.get_subscription_count() == 1)
    b.spin_until(lambda: b.node.count_publishers("chatter") == 1)
    before = time.time_ns()
    publisher.publish(String())
    b.spin_until(lambda: infos)
    (info,) = infos
    assert info.is_remote
    assert info.publisher_gid == publisher.gid
    assert info.publication_sequence_number == (1 if wire == "zenoh" else None)  # Cyclone does not provide this number
    assert before <= info.source_timestamp <= info.received_timestamp <= time.time_ns()
    (endpoint,) = b.node.get_publishers_info_by_topic("/chatter")
    assert bytes(endpoint.endpoint_gid[:16]) == publisher.gid


def test_raw_subscription_gets_serialized_bytes(processes):
    a, b = processes("a"), processes("b")
    payloads: list[bytes] = []
    b.node.create_subscription(String, "chatter", payloads.append, 10, raw=True)
    publisher = a.node.create_publisher(String, "chatter", 10)
    a.spin_until(lambda: publisher.get_subscription_count() == 1)
    data = serialize(String(data="abcd"))
    publisher.publish(data)
    b.spin_until(lambda: payloads)
    assert payloads[0].rstrip(b"\0") == data.rstrip(b"\0")
    assert len(payloads[0]) % 4 == 0


def test_incompatible_qos_is_reported_on_both_sides(processes):
    a, b = processes("a"), processes("b")
    a.node.create_publisher(String, "chatter", QoSProfile(5, reliability=ReliabilityPolicy.BEST_EFFORT))
    b.node.create_subscription(String, "chatter", print, QoSProfile(5))

    def reported(process):
        """Return the warnings about a mismatch.

        Another one may be about a remaining node of an earlier test.
        """
        return [text for text in process.warnings() if "incompatible QoS" in text]

    b.spin_until(lambda: reported(b))
    a.spin_until(lambda: reported(a))
    (remote_texts,), (local_texts,) = reported(b), reported(a)
    assert "New publisher discovered on topic '/chatter', offering incompatible QoS" in remote_texts
    assert "RELIABILITY" in remote_texts
    assert "'/a'" in remote_texts
    assert "New subscription discovered on topic '/chatter', requesting incompatible QoS" in local_texts
    assert "'/b'" in local_texts


def test_qos_of_remote_endpoints_is_available(processes):
    a, b = processes("a"), processes("b")
    offered = QoSProfile(
        7,
        reliability=ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
        deadline=Duration(seconds=1),
        lifespan=Duration(seconds=3),
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=Duration(seconds=2),
    )
    a.node.create_publisher(String, "chatter", offered)
    a.node.create_publisher(String, "all", KEEP_ALL)
    b.spin_until(lambda: b.node.count_publishers("chatter") and b.node.count_publishers("all"))
    (endpoint,) = b.node.get_publishers_info_by_topic("/chatter")
    assert endpoint.qos_profile == offered
    (endpoint,) = b.node.get_publishers_info_by_topic("/all")
    assert endpoint.qos_profile.history is HistoryPolicy.KEEP_ALL


def test_topic_can_avoid_ros_namespace_conventions(processes):
    a, b = processes("a"), processes("b")
    plain_qos = QoSProfile(10, avoid_ros_namespace_conventions=True)
    texts: list[str] = []
    b.node.create_subscription(String, "/plain", lambda message: texts.append(message.data), plain_qos)
    b.node.create_subscription(String, "/plain", lambda message: texts.append("ros"), 10)
    publisher = a.node.create_publisher(String, "/plain", plain_qos)
    a.spin_until(lambda: publisher.get_subscription_count() == 1)
    publisher.publish(String(data="hej"))
    b.spin_until(lambda: texts)
    assert texts == ["hej"]


def test_malformed_samples_are_dropped_counted_and_reported_once(processes, programs):
    process = processes("ours")
    texts: list[str] = []
    subscription = process.node.create_subscription(String, "/from_ros", lambda message: texts.append(message.data), 10)
    peer = programs("ros_peer", "humble", "real_node", "localhost")
    process.spin_until(lambda: process.node.count_publishers("/from_ros") == 1)
    process.spin_until(lambda: subscription.get_publisher_count() == 1)
    not_utf8 = (b"\0\1\0\0" + b"\2\0\0\0\xff\0\0\0").hex()
    for _ in range(3):
        assert peer.ask("publish_bytes", not_utf8) == "written"
    peer.ask("publish", "fine")
    process.spin_until(lambda: texts)
    assert texts == ["fine"]
    assert subscription.malformed_count == 3
    (warning,) = process.warnings()
    assert "Dropped a malformed message of topic '/from_ros'" in warning


@pytest.mark.parametrize("size", [1, 70_000, 3_000_000])
def test_messages_of_any_size_arrive(processes, size):
    a, b = processes("a"), processes("b")
    sizes: list[int] = []
    b.node.create_subscription(String, "chatter", lambda message: sizes.append(len(message.data)), KEEP_ALL)
    publisher = a.node.create_publisher(String, "chatter", KEEP_ALL)
    a.spin_until(lambda: publisher.get_subscription_count() == 1)
    for _ in range(5):
        publisher.publish(String(data="x" * size))
    b.spin_until(lambda: len(sizes) == 5)
    assert sizes == [size] * 5


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="only glibc has the setting that keeps freed memory")
def test_image_publisher_reuses_memory(processes):
    resource = pytest.importorskip("resource")
    a, b = processes("a"), processes("b")
    image_class = get_message("sensor_msgs/msg/Image")
    b.node.create_subscription(image_class, "images", lambda _: None, 10)
    publisher = a.node.create_publisher(image_class, "images", 10)
    a.spin_until(lambda: publisher.get_subscription_count() == 1)
    image = image_class(data=bytes(1_000_000))

    def new_pages():
        memory_before = resource.getrusage(resource.RUSAGE_THREAD).ru_minflt
        for _ in range(10):
            for _ in range(8):
                publisher.publish(image)
            assert publisher.wait_for_all_acked()
        return resource.getrusage(resource.RUSAGE_THREAD).ru_minflt - memory_before

    new_pages()
    assert new_pages() < 80 * 25  # an image has 245 pages


def test_reliable_flood_loses_no_messages(processes, programs):
    process = processes("ours")
    numbers: list[int] = []
    process.node.create_subscription(
        "std_msgs/msg/Int32", "flood", lambda message: numbers.append(message.data), KEEP_ALL
    )
    sender = programs("linkwright_program", "sender")
    assert sender.ask_until(bool, "subscribers", "/flood")
    count = 20_000
    sender.ask("flood", "/flood", count)
    process.spin_until(lambda: len(numbers) == count)
    assert numbers == list(range(count))


def test_lost_liveliness_of_remote_publisher_is_reported(processes):
    a, b = processes("a"), processes("b")
    manual = QoSProfile(
        5, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC, liveliness_lease_duration=Duration(nanoseconds=400_000_000)
    )
    events = []
    callbacks = SubscriptionEventCallbacks(liveliness=events.append)
    b.node.create_subscription(String, "chatter", print, manual, event_callbacks=callbacks)
    publisher = a.node.create_publisher(String, "chatter", manual)
    a.spin_until(lambda: publisher.get_subscription_count() == 1)
    publisher.assert_liveliness()
    b.spin_until(lambda: events and events[-1].not_alive_count == 1)

    def is_alive_again() -> bool:
        publisher.publish(String())  # a publisher that is discovered late may already count as silent
        return events[-1].alive_count == 1 and events[-1].not_alive_count == 0

    b.spin_until(is_alive_again)


def test_best_available_qos_considers_remote_endpoints(processes):
    process, peer = processes("us"), processes("them")
    best_available = QoSPresetProfiles.BEST_AVAILABLE.value
    peer.node.create_publisher(String, "/scan", QoSPresetProfiles.SENSOR_DATA.value)
    peer.node.create_subscription(String, "/command", print, QoSProfile(1, deadline=Duration(seconds=2)))
    process.spin_until(
        lambda: process.node.count_publishers("/scan") == process.node.count_subscribers("/command") == 1
    )
    process.node.create_subscription(String, "/scan", print, best_available)
    process.node.create_publisher(String, "/command", best_available)
    (endpoint,) = process.node.get_subscriptions_info_by_topic("/scan")
    assert endpoint.qos_profile.reliability is ReliabilityPolicy.BEST_EFFORT
    (offered,) = process.node.get_publishers_info_by_topic("/command")
    assert offered.qos_profile.deadline == Duration(seconds=2)
