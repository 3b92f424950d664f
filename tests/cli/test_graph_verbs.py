"""``linkwright node``, ``param`` and ``service``: the output of ros2, and errors."""

from __future__ import annotations

import signal

import pytest
import yaml

from linkwright.cli import main
from linkwright.graph import Graph, ParameterDescriptor
from linkwright.graph.endpoints.service import ServiceIntrospectionState
from linkwright.graph.qos.profile import SERVICES_QOS
from linkwright.messages import String, get_service


def create_robot(graph: Graph) -> None:
    node = graph.create_node("complex_node")
    node.create_publisher(String, "chatter", 10)
    node.create_subscription(String, "orders", lambda _message: None, 10)
    node.declare_parameter("speed", 1.5, ParameterDescriptor(description="how fast", additional_constraints="not much"))
    node.declare_parameter("names.left", "l")
    node.declare_parameter("gains", [1.0, 2.0])
    node.declare_parameter("fixed", 3, ParameterDescriptor(read_only=True))
    node.create_service("example_interfaces/srv/AddTwoInts", "add_two_ints", add_two_ints)
    graph.create_node("_hidden_node", start_parameter_services=False)


def add_two_ints(request, response):
    response.sum = request.a + request.b
    return response


@pytest.fixture(autouse=True)
def _robot(add_to_graph):
    add_to_graph(create_robot)


def run_command(capsys, *words: str, status: int = 0) -> tuple[str, str]:
    assert main(list(words)) == status
    captured = capsys.readouterr()
    return captured.out, captured.err


# node


def test_node_list_prints_nodes(capsys):
    assert run_command(capsys, "node", "list")[0] == "/complex_node\n"
    assert run_command(capsys, "node", "list", "-c")[0] == "1\n"
    assert "/_hidden_node\n" in run_command(capsys, "node", "list", "-a")[0]


def test_duplicate_node_names_cause_warning(add_to_graph, capsys):
    def twice(graph: Graph) -> None:
        create_robot(graph)
        create_robot(graph)

    add_to_graph(twice)
    out, err = run_command(capsys, "node", "list")
    assert out == "/complex_node\n/complex_node\n"
    assert "WARNING: Be aware that there are nodes in the graph that share an exact name" in err


def test_node_info_prints_endpoints(capsys):
    assert run_command(capsys, "node", "info", "/complex_node")[0].splitlines() == [
        "/complex_node",
        "  Subscribers:",
        "    /orders: std_msgs/msg/String",
        "  Publishers:",
        "    /chatter: std_msgs/msg/String",
        "    /parameter_events: rcl_interfaces/msg/ParameterEvent",
        "    /rosout: rcl_interfaces/msg/Log",
        "  Service Servers:",
        "    /add_two_ints: example_interfaces/srv/AddTwoInts",
        "    /complex_node/describe_parameters: rcl_interfaces/srv/DescribeParameters",
        "    /complex_node/get_parameter_types: rcl_interfaces/srv/GetParameterTypes",
        "    /complex_node/get_parameters: rcl_interfaces/srv/GetParameters",
        "    /complex_node/list_parameters: rcl_interfaces/srv/ListParameters",
        "    /complex_node/set_parameters: rcl_interfaces/srv/SetParameters",
        "    /complex_node/set_parameters_atomically: rcl_interfaces/srv/SetParametersAtomically",
        "  Service Clients:",
        "",
        "  Action Servers:",
        "",
        "  Action Clients:",
        "",
    ]


@pytest.mark.parametrize("name", ["/complex_nod", "complex_nod"])
def test_node_info_of_unknown_node_suggests_nearest(capsys, name):
    _, err = run_command(capsys, "node", "info", name, status=1)
    assert f"Unable to find node '{name}'" in err
    assert "did you mean '/complex_node'?" in err


def test_node_info_of_hidden_node_requires_option(capsys):
    run_command(capsys, "node", "info", "/_hidden_node", status=1)
    assert run_command(capsys, "node", "info", "--include-hidden", "/_hidden_node")[0].startswith("/_hidden_node\n")


# param


def test_param_list_prints_names(capsys):
    names = ["  fixed", "  gains", "  names.left", "  speed", "  use_sim_time"]
    assert run_command(capsys, "param", "list")[0].splitlines() == ["/complex_node:", *names]
    assert run_command(capsys, "param", "list", "complex_node")[0].splitlines() == names
    assert run_command(capsys, "param", "list", "/complex_node", "--filter", "^n")[0].splitlines() == ["  names.left"]
    assert run_command(capsys, "param", "list", "/complex_node", "--param-prefixes", "names")[0] == "  names.left\n"


def test_param_list_prints_types(capsys):
    assert run_command(capsys, "param", "list", "/complex_node", "--param-type")[0].splitlines() == [
        "  fixed (type: integer)",
        "  gains (type: double array)",
        "  names.left (type: string)",
        "  speed (type: double)",
        "  use_sim_time (type: boolean)",
    ]


@pytest.mark.parametrize(
    ("name", "printed"),
    [
        ("speed", "Double value is: 1.5\n"),
        ("names.left", "String value is: l\n"),
        ("fixed", "Integer value is: 3\n"),
        ("use_sim_time", "Boolean value is: False\n"),
        ("gains", "Double values are: array('d', [1.0, 2.0])\n"),
    ],
)
def test_param_get_prints_value(capsys, name, printed):
    assert run_command(capsys, "param", "get", "/complex_node", name)[0] == printed


def test_param_get_can_hide_type(capsys):
    assert run_command(capsys, "param", "get", "--hide-type", "/complex_node", "speed")[0] == "1.5\n"


def test_param_get_of_unknown_parameter_suggests_nearest(capsys):
    _, err = run_command(capsys, "param", "get", "/complex_node", "sped", status=1)
    assert "did you mean 'speed'?" in err


def test_param_get_of_unknown_node_suggests_nearest(capsys):
    _, err = run_command(capsys, "param", "get", "/complx_node", "speed", "--timeout", "0.1", status=1)
    assert "Node not found: '/complx_node'" in err
    assert "did you mean '/complex_node'?" in err


def test_param_set_accepts_several_parameters(capsys):
    assert run_command(capsys, "param", "set", "/complex_node", "speed", "2.5")[0] == "Set parameter successful\n"
    out, _ = run_command(capsys, "param", "set", "/complex_node", "speed", "2.5", "names.left", "x")
    assert out == "speed: Set parameter successful\nnames.left: Set parameter successful\n"
    out, _ = run_command(capsys, "param", "set", "--atomic", "/complex_node", "speed", "2.5", "names.left", "x")
    assert out == "Set parameters atomically successful\n"


def test_param_set_rejects_wrong_type(capsys):
    _, err = run_command(capsys, "param", "set", "/complex_node", "speed", "fast", status=1)
    assert err.startswith("Setting parameter failed: Wrong parameter type")


def test_param_set_rejects_read_only_parameter(capsys):
    _, err = run_command(capsys, "param", "set", "/complex_node", "fixed", "4", status=1)
    assert err.startswith("Setting parameter failed: ")


def test_param_set_requires_value(capsys):
    assert "name/value pairs" in run_command(capsys, "param", "set", "/complex_node", "speed", status=2)[1]


def test_param_describe_prints_descriptors(capsys):
    assert run_command(capsys, "param", "describe", "/complex_node", "speed", "fixed")[0].splitlines() == [
        "Parameter name: speed",
        "  Type: double",
        "  Description: how fast",
        "  Constraints:",
        "    Additional constraints: not much",
        "Parameter name: fixed",
        "  Type: integer",
        "  Constraints:",
        "    Read only: true",
    ]


DUMPED_PARAMETERS = """\
/complex_node:
  ros__parameters:
    fixed: 3
    gains:
    - 1.0
    - 2.0
    names:
      left: l
    speed: 1.5
    use_sim_time: false
"""


def test_param_dump_prints_or_writes_yaml(capsys, tmp_path):
    assert run_command(capsys, "param", "dump", "/complex_node")[0] == DUMPED_PARAMETERS + "\n"
    out, _ = run_command(capsys, "param", "dump", "/complex_node", "--output-dir", str(tmp_path))
    file = tmp_path / "complex_node.yaml"
    assert out == f"Saving to:  {file}\n"
    assert yaml.safe_load(file.read_text(encoding="utf-8")) == yaml.safe_load(DUMPED_PARAMETERS)


def test_param_load_reports_each_parameter(capsys, tmp_path):
    file = tmp_path / "p.yaml"
    file.write_text("/**:\n  ros__parameters:\n    speed: 9.0\n/complex_node:\n  ros__parameters:\n    fixed: 3.5\n")
    out, err = run_command(capsys, "param", "load", "/complex_node", str(file), status=1)
    assert out == "Set parameter speed successful\n"
    assert err.startswith("Set parameter fixed failed: ")
    out, err = run_command(capsys, "param", "load", "/complex_node", str(file), "--no-use-wildcard", status=1)
    assert out == ""


def test_param_load_rejects_file_for_other_nodes(capsys, tmp_path):
    file = tmp_path / "p.yaml"
    file.write_text("/other:\n  ros__parameters:\n    speed: 9.0\n")
    _, err = run_command(capsys, "param", "load", "/complex_node", str(file), status=1)
    assert "Param file does not contain parameters for /complex_node, only for nodes: ['/other']" in err


def test_param_load_rejects_missing_file(capsys):
    assert "does not exist" in run_command(capsys, "param", "load", "/complex_node", "nothing.yaml", status=1)[1]


def test_param_delete_reports_failures(capsys):
    _, err = run_command(capsys, "param", "delete", "/complex_node", "speed", status=1)
    assert err.startswith("Deleting parameter failed")
    assert "did you mean 'speed'?" in run_command(capsys, "param", "delete", "/complex_node", "speeed", status=1)[1]


# service


def test_service_list_prints_names_types_and_count(capsys):
    out, _ = run_command(capsys, "service", "list", "-t")
    lines = out.splitlines()
    assert lines[0] == "/add_two_ints [example_interfaces/srv/AddTwoInts]"
    assert len(lines) == 7
    assert run_command(capsys, "service", "list", "-c")[0] == "7\n"


def test_service_type_find_and_info_print_results(capsys):
    kind = "example_interfaces/srv/AddTwoInts"
    assert run_command(capsys, "service", "type", "/add_two_ints")[0] == f"{kind}\n"
    assert run_command(capsys, "service", "find", kind)[0] == "/add_two_ints\n"
    assert run_command(capsys, "service", "find", "not_a_service_type")[0] == ""
    out, _ = run_command(capsys, "service", "info", "/add_two_ints")
    assert out == f"Type: {kind}\nClients count: 0\nServices count: 1\n"


def test_service_call_prints_request_and_response(capsys):
    words = ["service", "call", "/add_two_ints", "example_interfaces/srv/AddTwoInts", "{a: 2, b: 3}"]
    assert run_command(capsys, *words)[0] == (
        "requester: making request: example_interfaces.srv.AddTwoInts_Request(a=2, b=3)\n\n"
        "response:\nexample_interfaces.srv.AddTwoInts_Response(sum=5)\n\n"
    )


def test_service_call_rejects_wrong_type(capsys):
    _, err = run_command(capsys, "service", "call", "/add_two_ints", "std_srvs/srv/Empty", status=1)
    assert "service '/add_two_ints' is of type example_interfaces/srv/AddTwoInts, not std_srvs/srv/Empty" in err


def test_service_call_times_out_without_server(capsys):
    words = ["service", "call", "/nothing", "std_srvs/srv/Empty", "--timeout", "0.1"]
    out, err = run_command(capsys, *words, status=1)
    assert out == "waiting for service to become available...\n"
    assert "did not appear" in err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["/add_two_ints", "example_interfaces/srv/AddTwoInt"], "did you mean"),
        (["/add_two_ints", "example_interfaces/srv/AddTwoInts", "{c: 1}"], "has no field 'c'"),
        (["/add_two_ints", "example_interfaces/srv/AddTwoInts", "{a: x}"], "field 'a' is of type int64"),
    ],
)
def test_service_call_reports_invalid_requests(capsys, words, message):
    assert message in run_command(capsys, "service", "call", *words, status=1)[1]


def run_watching_command(graph: Graph) -> None:
    """Run a command that shows the requests to a service, call the service, and press Ctrl-C."""
    node = graph.create_node("watched")
    service = node.create_service("example_interfaces/srv/AddTwoInts", "sum", add_two_ints)
    service.configure_introspection(node.get_clock(), SERVICES_QOS, ServiceIntrospectionState.CONTENTS)
    client = node.create_client("example_interfaces/srv/AddTwoInts", "sum")
    responses = []

    def ask() -> None:
        if graph.count_subscribers("/sum/_service_event"):
            client.call_async(client.srv_type.Request(a=2, b=3)).add_done_callback(answered)

    def answered(_: object) -> None:
        responses.append(1)
        if len(responses) == 3:
            signal.raise_signal(signal.SIGINT)

    node.create_timer(0.05, ask)


def test_service_echo_prints_events(add_to_graph, capsys):
    add_to_graph(run_watching_command)
    out, _ = run_command(capsys, "service", "echo", "/sum", "--flow-style", status=130)
    received, sent = out.split("---\n")[:2]
    assert received.startswith("info:\n  event_type: REQUEST_RECEIVED\n  stamp:\n    sec: ")
    assert received.endswith("  sequence_number: 1\nrequest: [{a: 2, b: 3}]\nresponse: []\n")
    assert "event_type: RESPONSE_SENT" in sent
    assert sent.endswith("request: []\nresponse: [{sum: 5}]\n")


def test_service_echo_prints_csv(add_to_graph, capsys):
    add_to_graph(run_watching_command)
    out, _ = run_command(capsys, "service", "echo", "/sum", "example_interfaces/srv/AddTwoInts", "--csv", status=130)
    first = out.splitlines()[0].split(",")
    assert (first[0], first[-4:]) == ("1", ["1", "2", "3", ""])


def test_service_echo_reports_missing_introspection(add_to_graph, capsys):
    def silent(graph: Graph) -> None:
        create_robot(graph)
        graph.create_node("user").create_timer(0.05, lambda: signal.raise_signal(signal.SIGINT))

    add_to_graph(silent)
    assert (
        "service '/add_two_ints' has no events yet"
        in run_command(capsys, "service", "echo", "/add_two_ints", status=130)[1]
    )


def test_unknown_service_suggests_nearest(capsys):
    assert "did you mean '/add_two_ints'?" in run_command(capsys, "service", "type", "/add_two_int", status=1)[1]


def test_service_call_times_out_if_server_hangs(add_to_graph, capsys):
    async def never(_request, _response):
        import asyncio

        await asyncio.sleep(60)

    add_to_graph(lambda graph: graph.create_node("slow").create_service("std_srvs/srv/Empty", "hang", never))
    words = ["service", "call", "/hang", "std_srvs/srv/Empty", "--timeout", "0.2"]
    assert "did not respond within 0.2 s" in run_command(capsys, *words, status=1)[1]


def test_get_service_returns_service_class():
    assert get_service("example_interfaces/srv/AddTwoInts").Request(a=1).a == 1


# nested commands


@pytest.mark.parametrize("verb", ["topic", "node", "param", "service", "action", "interface", "lifecycle", "component"])
def test_command_group_without_subcommand_prints_help(capsys, verb):
    out, _ = run_command(capsys, verb)
    assert out.startswith(f"usage: linkwright {verb}")


def test_unknown_subcommand_suggests_nearest(capsys):
    _, err = run_command(capsys, "topic", "ecko", "/chatter", status=2)
    assert err == "linkwright topic: there is no command 'ecko'; did you mean 'echo'?\n"


def test_usage_shows_program_name(capsys):
    assert main(["topic", "echo", "-h"], program="ros2") == 0
    assert capsys.readouterr().out.startswith("usage: ros2 topic echo ")


@pytest.mark.parametrize("verb", ["start", "stop", "status"])
def test_daemon_commands_are_accepted(capsys, verb):
    assert "daemon" in run_command(capsys, "daemon", verb)[0]


def test_missing_dds_is_one_error(monkeypatch, capsys):
    monkeypatch.undo()
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")
    _, err = run_command(capsys, "node", "list", status=1)
    assert "the nodes of other processes cannot be reached without DDS" in err
    assert "LINKWRIGHT_DDS" in err
