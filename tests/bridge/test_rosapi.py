"""rosapi_node, whose services clients of rosbridge call."""

from __future__ import annotations

import json
from contextlib import asynccontextmanager

import pytest

from linkwright.graph import ActionServer, ParameterDescriptor, SetParametersResult
from linkwright.messages import String
from tests.bridge.rosbridge_client import RosbridgeClient, RosbridgeSetup, add_set_bool, rosbridge_setup

FIBONACCI = "example_interfaces/action/Fibonacci"


class RosapiClient:
    """A client that calls services of rosapi."""

    def __init__(self, setup: RosbridgeSetup, client: RosbridgeClient) -> None:
        self.setup = setup
        self.client = client

    async def ask(self, service: str, /, **args) -> dict:
        response = await self.client.call(f"/rosapi/{service}", args)
        assert response["result"] is True, response
        return response["values"]


@asynccontextmanager
async def rosapi_client():
    async with rosbridge_setup(rosapi=True) as setup, setup.client() as client:
        yield RosapiClient(setup, client)


async def test_topics_are_listed_with_their_types():
    async with rosapi_client() as api:
        api.setup.node.create_publisher(String, "/chatter", 10)
        api.setup.node.create_publisher(String, "/_hidden", 10)
        topics = await api.ask("topics")
        assert dict(zip(topics["topics"], topics["types"], strict=True))["/chatter"] == "std_msgs/msg/String"
        assert "/_hidden" not in topics["topics"]
        assert await api.ask("topic_type", topic="/chatter") == {"type": "std_msgs/msg/String"}
        assert await api.ask("topic_type", topic="/none") == {"type": ""}
        for name in ("std_msgs/String", "std_msgs/msg/String"):
            assert await api.ask("topics_for_type", type=name) == {"topics": ["/chatter"]}
        raw = await api.ask("topics_and_raw_types")
        text = raw["typedefs_full_text"][raw["topics"].index("/connected_clients")]
        assert "MSG: builtin_interfaces/Time" in text


async def test_services_are_listed_with_their_types():
    async with rosapi_client() as api:
        add_set_bool(api.setup)
        assert "/switch" in (await api.ask("services"))["services"]
        assert await api.ask("service_type", service="/switch") == {"type": "std_srvs/srv/SetBool"}
        assert await api.ask("services_for_type", type="std_srvs/SetBool") == {"services": ["/switch"]}
        assert await api.ask("service_node", service="/switch") == {"node": "/robot"}
        assert await api.ask("service_node", service="/none") == {"node": ""}
        assert await api.ask("service_providers", service="std_srvs/srv/SetBool") == {"providers": ["/robot"]}


async def test_nodes_are_listed_with_their_endpoints():
    async with rosapi_client() as api:
        node = api.setup.node
        node.create_publisher(String, "/chatter", 10)
        node.create_subscription(String, "/words", print, 10)
        add_set_bool(api.setup)
        assert {"/robot", "/rosapi", "/rosbridge_websocket"} <= set((await api.ask("nodes"))["nodes"])
        details = await api.ask("node_details", node="/robot")
        assert "/chatter" in details["publishing"]
        assert details["subscribing"] == ["/words"]
        assert "/switch" in details["services"]
        assert await api.ask("publishers", topic="/chatter") == {"publishers": ["/robot"]}
        assert await api.ask("subscribers", topic="/words") == {"subscribers": ["/robot"]}


async def test_action_servers_are_listed():
    async with rosapi_client() as api:
        ActionServer(api.setup.node, FIBONACCI, "/fibonacci", print)
        assert await api.ask("action_servers") == {"action_servers": ["/fibonacci"]}
        assert await api.ask("action_type", action="/fibonacci") == {"type": FIBONACCI}


async def test_details_of_a_type_include_the_messages_in_it():
    async with rosapi_client() as api:
        first, header, time = (await api.ask("message_details", type="sensor_msgs/JointState"))["typedefs"]
        assert first == {
            "type": "sensor_msgs/JointState",
            "fieldnames": ["header", "name", "position", "velocity", "effort"],
            "fieldtypes": ["std_msgs/Header", "string", "double", "double", "double"],
            "fieldarraylen": [-1, 0, 0, 0, 0],
            "examples": ["{}", "[]", "[]", "[]", "[]"],
            "constnames": [],
            "constvalues": [],
        }
        assert (header["type"], time["type"]) == ("std_msgs/Header", "builtin_interfaces/Time")
        status = (await api.ask("message_details", type="diagnostic_msgs/DiagnosticStatus"))["typedefs"][0]
        assert "STALE" in status["constnames"]
        info = (await api.ask("message_details", type="sensor_msgs/CameraInfo"))["typedefs"][0]
        assert info["fieldarraylen"][info["fieldnames"].index("k")] == 9
        assert await api.ask("message_details", type="no_msgs/Nothing") == {"typedefs": []}


async def test_details_of_services_are_listed():
    async with rosapi_client() as api:
        request = (await api.ask("service_request_details", type="std_srvs/SetBool"))["typedefs"][0]
        assert (request["type"], request["fieldnames"]) == ("std_srvs/SetBool_Request", ["data"])
        response = (await api.ask("service_response_details", type="std_srvs/SetBool"))["typedefs"][0]
        assert response["fieldtypes"] == ["boolean", "string"]
        interfaces = (await api.ask("interfaces"))["interfaces"]
        assert {"std_msgs/msg/String", "std_srvs/srv/SetBool", FIBONACCI} <= set(interfaces)


@pytest.mark.parametrize(
    ("default", "text", "value"),
    [
        (1.5, "2", 2.0),
        (1.5, "2.5", 2.5),
        ([1.0, 2.0], "[3, 4.5]", [3.0, 4.5]),
        (1, "2", 2),
        (True, "false", False),
        ("a", '"true"', "true"),
        (["a"], '["b", "c"]', ["b", "c"]),
    ],
)
async def test_parameter_is_set_and_read_as_json(default, text, value):
    async with rosapi_client() as api:
        api.setup.node.declare_parameter("speed", default)
        name = "/robot:speed"
        assert await api.ask("set_param", name=name, value=text) == {"successful": True, "reason": ""}
        assert api.setup.node.get_parameter("speed").value == value
        response = await api.ask("get_param", name=name)
        assert (json.loads(response["value"]), response["successful"]) == (value, True)
        assert await api.ask("has_param", name=name) == {"exists": True}
        assert name in (await api.ask("get_param_names"))["names"]


async def test_parameter_is_deleted():
    async with rosapi_client() as api:
        api.setup.node.declare_parameter("speed", 1.0, ParameterDescriptor(dynamic_typing=True))
        assert (await api.ask("delete_param", name="/robot:speed"))["successful"] is True
        assert await api.ask("has_param", name="/robot:speed") == {"exists": False}


@pytest.mark.parametrize(
    ("name", "text", "reason"),
    [
        ("speed", "1", "expecting <node_name>:<param_name>"),
        ("/nobody:speed", "1", "there is no node /nobody"),
        ("/robot:speed", "fast", "the value must be JSON"),
        ("/robot:speed", "-1.0", "too slow"),
        ("/robot:speed", '{"a": 1}', "a parameter cannot have this value"),
    ],
)
async def test_parameter_that_is_not_set_has_a_reason(name, text, reason):
    async with rosapi_client() as api:
        api.setup.node.declare_parameter("speed", 1.0)
        api.setup.node.add_on_set_parameters_callback(
            lambda parameters: SetParametersResult(successful=parameters[0].value > 0, reason="too slow")
        )
        response = await api.ask("set_param", name=name, value=text)
        assert response["successful"] is False
        assert reason in response["reason"]


async def test_time_and_version_are_known():
    async with rosapi_client() as api:
        assert (await api.ask("get_time"))["time"]["sec"] > 1_600_000_000
        version = await api.ask("get_ros_version")
        assert version["version"] == 2
        assert version["distro"]
