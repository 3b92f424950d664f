"""The discovery of nodes and endpoints of other processes over DDS."""

from __future__ import annotations

import socket
import threading
from typing import Any

from linkwright.graph.names.rules import NodeIdentity
from linkwright.graph.qos.profile import QoSProfile
from linkwright.messages import String
from linkwright.wire.dds import discovery, engine, join
from linkwright.wire.dds.discovery_info import ParticipantEntities
from linkwright.wire.dds.remote import RemoteEndpoint
from tests.waiting import TIMEOUT_S, wait_until


def remote_node_names(process):
    return sorted(name for name, _ in process.node.get_node_names_and_namespaces())


def test_nodes_appear_and_disappear(processes):
    a, b = processes("a"), processes("b")
    extra = b.graph.create_node("extra", namespace="/deep/er")
    a.spin_until(lambda: NodeIdentity("extra", "/deep/er") in a.transport.remote_nodes())
    assert remote_node_names(a) == ["a", "b", "extra"]
    extra.destroy_node()
    a.spin_until(lambda: remote_node_names(a) == ["a", "b"])
    b.close()
    a.spin_until(lambda: remote_node_names(a) == ["a"])


def test_nodes_with_duplicate_names_are_listed_separately(processes):
    a, b = processes("a"), processes("twin")
    b.graph.create_node("twin")
    a.spin_until(lambda: remote_node_names(a) == ["a", "twin", "twin"])


def test_graph_watchers_are_notified(processes):
    a = processes("a")
    changes: list[int] = []
    a.transport.watch(lambda: changes.append(1))
    b = processes("b")
    a.spin_until(lambda: changes and "b" in remote_node_names(a))
    count_before = len(changes)
    b.node.create_publisher(String, "chatter", 10)
    a.spin_until(lambda: len(changes) > count_before and a.node.count_publishers("chatter") == 1)


def test_endpoints_of_nodes_are_discovered(processes):
    a, b = processes("a"), processes("b")
    b.node.create_publisher(String, "said", 10)
    b.node.create_subscription(String, "heard", print, 10)
    a.spin_until(lambda: a.node.count_publishers("said") == a.node.count_subscribers("heard") == 1)
    assert ("/said", ["std_msgs/msg/String"]) in a.node.get_publisher_names_and_types_by_node("b", "/")
    assert ("/heard", ["std_msgs/msg/String"]) in a.node.get_subscriber_names_and_types_by_node("b", "/")
    services = dict(a.node.get_service_names_and_types_by_node("b", "/"))
    assert services["/b/list_parameters"] == ["rcl_interfaces/srv/ListParameters"]


def test_wait_for_discovery_ends_when_all_nodes_are_discovered(processes, programs):
    programs("linkwright_program", "one")
    programs("linkwright_program", "two")
    process = processes("ours")
    assert process.transport.wait_for_discovery(TIMEOUT_S)
    assert {node.name for node in process.transport.remote_nodes()} == {"one", "two"}


def test_process_announces_nodes_after_creating_all_endpoints(processes, monkeypatch):
    may_join = threading.Event()

    class Late(engine.Engine):
        def __init__(self, *arguments: Any) -> None:
            assert may_join.wait(TIMEOUT_S)
            super().__init__(*arguments)

    announced = []
    other = processes("other")
    on_entities_announced = other.transport._remote.on_entities_announced

    def listen(entities: ParticipantEntities) -> None:
        announced.append(entities)
        on_entities_announced(entities)

    monkeypatch.setattr(other.transport._remote, "on_entities_announced", listen)
    monkeypatch.setattr(engine, "Engine", Late)
    monkeypatch.setattr(engine, "_FIRST_ANNOUNCE_SPAN_S", float("inf"))
    process = processes("ours", join_now=False)
    publishers = [process.node.create_publisher(String, f"topic_{number}", 10) for number in range(50)]
    transport = join(process.graph)  # this requests all publishers before the transport joins
    may_join.set()
    assert transport.wait_until_ready(TIMEOUT_S)
    wait_until(lambda: announced)
    assert {publisher.gid for publisher in publishers} <= set(announced[0].nodes[0].writers)


def test_wait_for_discovery_ends_soon_without_peers(processes):
    process = processes("ours")
    assert process.transport.wait_for_discovery(TIMEOUT_S)


def test_killed_process_and_its_successor_are_listed_once(processes, programs):
    process = processes("ours")
    first = programs("linkwright_program", "worker")
    process.spin_until(lambda: remote_node_names(process) == ["ours", "worker"])
    first.kill()
    process.spin_until(lambda: remote_node_names(process) == ["ours"], 2)
    programs("linkwright_program", "worker")
    process.spin_until(lambda: remote_node_names(process) == ["ours", "worker"])


def test_local_process_is_recognized_by_host_name_and_machine_id(monkeypatch):
    """Fast DDS 3 announces the machine ID, Fast DDS 2 and Cyclone the host name."""
    host_name = socket.gethostname()
    monkeypatch.setattr(discovery, "read_machine_id", lambda: "3d12")
    for text in ("3d12", f"{host_name}:0", host_name):
        properties = {"fastdds.physical_data.host": text, "fastdds.physical_data.process": "42"}
        assert next(discovery.announced_processes(lambda name, text=properties: text.get(name, ""))) == (
            host_name,
            "42",
        )
    other_process = {"__Hostname": "elsewhere", "__Pid": "42"}
    assert list(discovery.announced_processes(lambda name: other_process.get(name, ""))) == [
        ("", ""),
        ("elsewhere", "42"),
    ]


def test_fifty_nodes_with_services_are_discovered(processes, programs):
    process = processes("ours")
    for number in range(50):
        process.graph.create_node(f"node_{number}")
    other = programs("linkwright_program", "other")
    names = other.ask_until(lambda names: len(names) == 52, "nodes", seconds=20)
    assert "node_49" in names


def test_type_hash_of_fast_dds_request_is_not_service_hash():
    """Request and response each announce their own hash.

    With Cyclone both announce the hash of the service.
    """
    hashes = {
        guid[:2]: [
            RemoteEndpoint(guid, 1, guid, False, topic, type_name, QoSProfile(1), {"typehash": "RIHS01_1"})
            .endpoint_info(None)
            .type_hash
            for topic, type_name in (
                ("rq/flipRequest", "std_srvs::srv::dds_::SetBool_Request_"),
                ("rt/chatter", "std_msgs::msg::dds_::String_"),
            )
        ]
        for guid in (b"\x01\x0f" + bytes(14), b"\x01\x10" + bytes(14))
    }
    assert hashes == {b"\x01\x0f": ["", "RIHS01_1"], b"\x01\x10": ["RIHS01_1", "RIHS01_1"]}
