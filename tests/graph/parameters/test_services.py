"""The parameter services of a node, and their clients."""

from __future__ import annotations

import pytest

from linkwright.graph import Graph, Parameter, ParameterDescriptor, SetParametersResult
from linkwright.graph.parameters.client import AsyncParameterClient, parameter_dict_from_yaml_file
from linkwright.graph.parameters.events import ParameterEventHandler
from linkwright.messages import get_message


@pytest.fixture
def server(graph: Graph):
    node = graph.create_node("server", namespace="/robot", parameters={"rate": 30})
    node.declare_parameter("rate", 10)
    node.declare_parameter("arm.name", "left", ParameterDescriptor(description="which"))
    node.declare_parameter("any", None, ParameterDescriptor(dynamic_typing=True))
    node.declare_parameter("late", Parameter.Type.BOOL)
    return node


@pytest.fixture
def client(graph: Graph, server):
    return AsyncParameterClient(graph.create_node("asking"), "/robot/server")


async def get_response(graph, future):
    await graph.settle()
    assert future.done()
    return future.result()


async def test_node_has_six_parameter_services(graph, server):
    services = dict(server.get_service_names_and_types_by_node("server", "/robot"))
    assert services == {
        f"/robot/server/{name}": [f"rcl_interfaces/srv/{kind}"]
        for name, kind in {
            "describe_parameters": "DescribeParameters",
            "get_parameters": "GetParameters",
            "get_parameter_types": "GetParameterTypes",
            "list_parameters": "ListParameters",
            "set_parameters": "SetParameters",
            "set_parameters_atomically": "SetParametersAtomically",
        }.items()
    }


async def test_parameter_services_can_be_disabled(graph):
    node = graph.create_node("quiet", start_parameter_services=False, enable_rosout=False)
    assert node.get_service_names_and_types_by_node("quiet", "/") == []
    assert "/rosout" not in graph.topics()


async def test_parameter_client_gets_values_types_and_descriptions(graph, client):
    assert client.services_are_ready()
    assert client.wait_for_services(0.0)
    values = (await get_response(graph, client.get_parameters(["rate", "arm.name"]))).values
    assert [values[0].integer_value, values[1].string_value] == [30, "left"]
    assert list((await get_response(graph, client.get_parameter_types(["rate", "any", "late"]))).types) == [
        2,
        0,
        0,
    ]
    descriptors = (await get_response(graph, client.describe_parameters(["arm.name"]))).descriptors
    assert [(descriptor.name, descriptor.type, descriptor.description) for descriptor in descriptors] == [
        ("arm.name", 4, "which")
    ]
    listing = (await get_response(graph, client.list_parameters(["arm"]))).result
    assert (list(listing.names), list(listing.prefixes)) == (["arm.name"], ["arm"])
    assert len((await get_response(graph, client.list_parameters(depth=1))).result.names) == 4


async def test_unknown_parameter_empties_response(graph, client):
    for ask in (client.get_parameters, client.get_parameter_types, client.describe_parameters):
        response = await get_response(graph, ask(["rate", "gone"]))
        (field,) = response.get_fields_and_field_types()
        assert len(getattr(response, field)) == 0
    assert len((await get_response(graph, client.get_parameters(["rate", "late"]))).values) == 0


async def test_parameter_client_sets_parameters(graph, server, client):
    server.add_on_set_parameters_callback(
        lambda parameters: SetParametersResult(all(parameter.value != 13 for parameter in parameters), "unlucky")
    )
    messages = []
    future = client.set_parameters(
        [Parameter("rate", value=1), Parameter("rate", value=13), Parameter("gone", value=1)],
        callback=lambda completed: messages.append(completed.result()),
    )
    results = (await get_response(graph, future)).results
    assert [result.successful for result in results] == [True, False, False]
    assert results[1].reason == "unlucky"
    assert results[2].reason == "Invalid access to undeclared parameter(s): ['gone']"
    assert len(messages) == 1
    response = await get_response(
        graph, client.set_parameters_atomically([Parameter("rate", value=2), Parameter("rate", value="x")])
    )
    assert not response.result.successful
    assert server.get_parameter("rate").value == 1
    assert (await get_response(graph, client.set_parameters([Parameter("any", value=[1.5])]))).results[0].successful
    assert (await get_response(graph, client.delete_parameters(["any"]))).results[0].successful
    assert not server.has_parameter("any")


async def test_value_of_unknown_type_is_rejected(graph, client):
    message = Parameter("rate", value=1).to_parameter_msg()
    message.value.type = 77
    response = await get_response(graph, client.set_parameters([message]))
    assert not response.results[0].successful


async def test_parameter_client_loads_file(graph, server, client, tmp_path):
    file = tmp_path / "p.yaml"
    file.write_text(
        "/**: {ros__parameters: {rate: 1}}\n/robot/server: {ros__parameters: {rate: 2, arm: {name: right}}}\n"
    )
    assert (await get_response(graph, client.load_parameter_file(str(file), use_wildcard=True))).results[0].successful
    assert (server.get_parameter("rate").value, server.get_parameter("arm.name").value) == (2, "right")
    response = await get_response(graph, client.load_parameter_file_atomically(str(file)))
    assert response.result.successful
    messages = parameter_dict_from_yaml_file(str(file), target_nodes=["/robot/server"], namespace="x.")
    assert list(messages) == ["x.rate", "x.arm.name"]
    with pytest.raises(RuntimeError, match="does not contain parameters for /gone"):
        parameter_dict_from_yaml_file(str(file), target_nodes=["/gone"])
    with pytest.raises(FileNotFoundError, match=r"parameter file .*gone\.yaml' does not exist"):
        parameter_dict_from_yaml_file(str(file.with_name("gone.yaml")))
    file.write_text("/**: {ros__parameters: {rate: 1}}\n")
    with pytest.raises(RuntimeError, match="does not contain selected parameters"):
        parameter_dict_from_yaml_file(str(file))


async def test_parameter_events_are_published_for_accepted_changes(graph, server, clock):
    events = []
    watcher = graph.create_node("watcher")
    watcher.create_subscription(
        get_message("rcl_interfaces/msg/ParameterEvent"), "/parameter_events", events.append, 10
    )
    server.set_parameters([Parameter("rate", value=3), Parameter("rate", value="x"), Parameter("any", value=1)])
    server.set_parameters([Parameter("any")])
    server.declare_parameter("fresh", 1.5)
    await graph.settle()
    assert [
        (
            [parameter.name for parameter in event.new_parameters],
            [parameter.name for parameter in event.changed_parameters],
            [parameter.name for parameter in event.deleted_parameters],
        )
        for event in events
    ] == [([], ["rate"], []), (["any"], [], []), ([], [], ["any"]), (["fresh"], [], [])]
    assert {event.node for event in events} == {"/robot/server"}
    assert events[0].stamp.sec == clock.now_ns() // 10**9
    assert events[0].changed_parameters[0].value.integer_value == 3


async def test_parameter_event_handler_reports_single_parameters(graph, server):
    watcher = graph.create_node("watcher", namespace="/robot")
    handler = ParameterEventHandler(watcher)
    messages = []
    rate = handler.add_parameter_callback(
        "rate", "server", lambda parameter: messages.append(("rate", parameter.value.integer_value))
    )
    handler.add_parameter_callback("rate", "/other", lambda parameter: messages.append(("other", parameter)))
    callback_handle = handler.add_parameter_callback(
        "mine", "", lambda parameter: messages.append(("mine", parameter.value.bool_value))
    )
    event = handler.add_parameter_event_callback(lambda parameter_event: messages.append(parameter_event.node))
    server.set_parameters([Parameter("rate", value=3)])
    watcher.declare_parameter("mine", True)
    await graph.settle()
    assert messages == [("rate", 3), "/robot/server", ("mine", True), "/robot/watcher"]
    handler.remove_parameter_callback(rate)
    handler.remove_parameter_callback(callback_handle)
    handler.remove_parameter_event_callback(event)
    for remove, handle in ((handler.remove_parameter_callback, rate), (handler.remove_parameter_event_callback, event)):
        with pytest.raises(RuntimeError, match="Callback doesn't exist"):
            remove(handle)
    server.set_parameters([Parameter("rate", value=4)])
    await graph.settle()
    assert len(messages) == 4
    handler.destroy()
