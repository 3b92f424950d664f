"""The service of nodes that describes the types they use."""

from __future__ import annotations

from typing import Any

import pytest

from linkwright.graph import Graph, Node
from linkwright.messages import get_message, get_service, type_hash

JOINT_STATE = "sensor_msgs/msg/JointState"


@pytest.fixture(autouse=True)
def jazzy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DISTRO", "jazzy")


async def request_description(graph: Graph, node: Node, **request: Any) -> Any:
    asking = graph.create_node("asking")
    service = get_service("type_description_interfaces/srv/GetTypeDescription")
    client = asking.create_client(service, f"{node.get_fully_qualified_name()}/get_type_description")
    response = client.call_async(service.Request(**request))
    await graph.settle()
    asking.destroy_node()
    return response.result()


async def test_message_description_includes_nested_types(graph: Graph) -> None:
    node = graph.create_node("node", namespace="ns")
    node.create_publisher(get_message(JOINT_STATE), "joint_states", 1)
    response = await request_description(graph, node, type_name=JOINT_STATE, type_hash=type_hash(JOINT_STATE))
    assert (response.successful, response.failure_reason) == (True, "")
    described = response.type_description
    assert described.type_description.type_name == JOINT_STATE
    assert [field.name for field in described.type_description.fields] == [
        "header",
        "name",
        "position",
        "velocity",
        "effort",
    ]
    nested = ["builtin_interfaces/msg/Time", "std_msgs/msg/Header"]
    assert [
        referenced_type_description.type_name for referenced_type_description in described.referenced_type_descriptions
    ] == nested
    assert [(type_source.type_name, type_source.encoding) for type_source in response.type_sources] == [
        (name, "msg") for name in (JOINT_STATE, *nested)
    ]
    assert "float64[] position" in response.type_sources[0].raw_file_contents


async def test_service_request_and_response_sources_are_implicit(graph: Graph) -> None:
    node = graph.create_node("node")
    node.create_client(get_service("std_srvs/srv/SetBool"), "switch")
    response = await request_description(
        graph, node, type_name="std_srvs/srv/SetBool", type_hash=type_hash("std_srvs/srv/SetBool")
    )
    encodings = {type_source.type_name: type_source.encoding for type_source in response.type_sources}
    assert encodings["std_srvs/srv/SetBool"] == "srv"
    assert encodings["std_srvs/srv/SetBool_Request"] == "implicit"


async def test_type_sources_can_be_omitted(graph: Graph) -> None:
    node = graph.create_node("node")
    name = "rcl_interfaces/msg/ParameterEvent"
    response = await request_description(
        graph, node, type_name=name, type_hash=type_hash(name), include_type_sources=False
    )
    assert response.successful
    assert list(response.type_sources) == []


@pytest.mark.parametrize(
    ("name", "sent", "reason"),
    [
        (JOINT_STATE, type_hash(JOINT_STATE), "Type not currently in use by this node"),
        ("rcl_interfaces/msg/ParameterEvent", type_hash(JOINT_STATE), "Type not currently in use by this node"),
        ("rcl_interfaces/msg/ParameterEvent", "RIHS01_12", "Failed to parse type hash"),
    ],
)
async def test_unused_types_and_invalid_hashes_are_rejected(graph: Graph, name: str, sent: str, reason: str) -> None:
    response = await request_description(graph, graph.create_node("node"), type_name=name, type_hash=sent)
    assert (response.successful, response.failure_reason) == (False, reason)


@pytest.mark.parametrize("distribution", ["", "humble", "Humble"])
async def test_humble_nodes_have_no_type_description_service(
    graph: Graph, monkeypatch: pytest.MonkeyPatch, distribution: str
) -> None:
    monkeypatch.setenv("ROS_DISTRO", distribution)
    node = graph.create_node("node")
    assert "/node/get_type_description" not in dict(node.get_service_names_and_types())
    assert not node.has_parameter("start_type_description_service")


@pytest.mark.parametrize(("distribution", "is_enabled"), [("humble", True), ("jazzy", False)])
async def test_parameter_enables_type_description_service(
    graph: Graph, monkeypatch: pytest.MonkeyPatch, distribution: str, is_enabled: bool
) -> None:
    monkeypatch.setenv("ROS_DISTRO", distribution)
    node = graph.create_node("node", parameters={"start_type_description_service": is_enabled})
    assert ("/node/get_type_description" in dict(node.get_service_names_and_types())) is is_enabled
    assert node.get_parameter("start_type_description_service").value is is_enabled
    assert node.describe_parameter("start_type_description_service").read_only
