"""``linkwright topic``: the output of ros2 topic, and errors."""

from __future__ import annotations

import re

import pytest

from linkwright.cli import main
from linkwright.graph import DESCRIPTION_QOS, Graph, QoSProfile, ReliabilityPolicy
from linkwright.graph.qos.profile import QoSPresetProfiles
from linkwright.messages import Header, JointState, String, Time, get_message

COMMON = ["/parameter_events", "/rosout"]


def talker(graph: Graph, *, topic: str = "chatter", period: float = 0.02, qos: QoSProfile | int = 10) -> None:
    node = graph.create_node("talker", start_parameter_services=False)
    publisher = node.create_publisher(String, topic, qos)
    count = 0

    def publish() -> None:
        nonlocal count
        count += 1
        publisher.publish(String(data=f"Hello {count}"))

    node.create_timer(period, publish)


def out(capsys) -> str:
    return capsys.readouterr().out


# list, type, find, info


def test_topic_list_prints_names(add_to_graph, capsys):
    add_to_graph(talker)
    assert main(["topic", "list"]) == 0
    assert out(capsys).splitlines() == ["/chatter", *COMMON]


def test_topic_list_prints_types(add_to_graph, capsys):
    add_to_graph(talker)
    assert main(["topic", "list", "-t"]) == 0
    assert "/chatter [std_msgs/msg/String]" in out(capsys).splitlines()


def test_topic_list_prints_count(add_to_graph, capsys):
    add_to_graph(talker)
    assert main(["topic", "list", "-c"]) == 0
    assert out(capsys) == "3\n"


@pytest.mark.parametrize(
    "words", [["list", "-a"], ["list", "--include-hidden-topics"], ["--include-hidden-topics", "list"]]
)
def test_hidden_topics_are_listed_only_with_option(add_to_graph, capsys, words):
    add_to_graph(lambda graph: talker(graph, topic="_secret"))
    assert main(["topic", *words]) == 0
    assert "/_secret" in out(capsys)
    assert main(["topic", "list"]) == 0
    assert "/_secret" not in out(capsys)


def test_topic_list_verbose_prints_publishers_and_subscribers(add_to_graph, capsys):
    add_to_graph(talker)
    assert main(["topic", "list", "-v"]) == 0
    lines = out(capsys).splitlines()
    assert lines[0] == "Published topics:"
    assert " * /chatter [std_msgs/msg/String] 1 publisher" in lines
    assert lines[lines.index("") + 1] == "Subscribed topics:"


def test_topic_type_prints_type(add_to_graph, capsys):
    add_to_graph(talker)
    assert main(["topic", "type", "chatter"]) == 0
    assert out(capsys) == "std_msgs/msg/String\n"


def test_topic_type_of_unknown_topic_suggests_nearest(add_to_graph, capsys):
    add_to_graph(talker)
    assert main(["topic", "type", "/chater"]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "did you mean '/chatter'?" in captured.err


def test_topic_find_prints_topics_of_type(add_to_graph, capsys):
    add_to_graph(talker)
    assert main(["topic", "find", "std_msgs/msg/String"]) == 0
    assert out(capsys) == "/chatter\n"
    assert main(["topic", "find", "-c", "std_msgs/msg/String"]) == 0
    assert out(capsys) == "1\n"


def test_topic_info_prints_type_and_counts(add_to_graph, capsys):
    add_to_graph(talker)
    assert main(["topic", "info", "/chatter"]) == 0
    assert out(capsys) == "Type: std_msgs/msg/String\nPublisher count: 1\nSubscription count: 0\n"


def test_topic_info_of_unknown_topic_is_an_error(add_to_graph, capsys):
    add_to_graph(talker)
    assert main(["topic", "info", "/unknown_topic"]) == 1
    assert "Unknown topic '/unknown_topic'" in capsys.readouterr().err


def test_topic_info_verbose_prints_endpoints(add_to_graph, capsys):
    add_to_graph(talker)
    assert main(["topic", "info", "-v", "/chatter"]) == 0
    text = out(capsys)
    lines = [line for line in text.splitlines() if not line.startswith("Topic type hash: RIHS01_")]
    assert lines[:9] == [
        "Type: std_msgs/msg/String",
        "",
        "Publisher count: 1",
        "",
        "Node name: talker",
        "Node namespace: /",
        "Topic type: std_msgs/msg/String",
        "Endpoint type: PUBLISHER",
        lines[8],
    ]
    assert re.fullmatch(r"GID: ([0-9a-f]{2}\.){15}[0-9a-f]{2}", lines[8])
    assert lines[9:] == [
        "QoS profile:",
        "  Reliability: RELIABLE",
        "  History (Depth): KEEP_LAST (10)",
        "  Durability: VOLATILE",
        "  Lifespan: Infinite",
        "  Deadline: Infinite",
        lines[15],
        "  Liveliness lease duration: Infinite",
        "",
        "Subscription count: 0",
        "",
    ]


# echo


def test_echo_once_prints_one_message(add_to_graph, capsys):
    add_to_graph(talker)
    assert main(["topic", "echo", "--once", "/chatter"]) == 0
    assert re.fullmatch(r"data: Hello \d+\n---\n", out(capsys))


def latched(graph: Graph) -> None:
    node = graph.create_node("description", start_parameter_services=False)
    node.create_publisher(String, "robot_description", DESCRIPTION_QOS).publish(String(data="<robot/>"))


def test_echo_prints_latched_message(add_to_graph, capsys):
    add_to_graph(latched)
    assert main(["topic", "echo", "--once", "robot_description", "--timeout", "2"]) == 0
    assert out(capsys) == "data: <robot/>\n---\n"


def state(graph: Graph) -> None:
    node = graph.create_node("arm", start_parameter_services=False)
    publisher = node.create_publisher(JointState, "joint_states", 10)
    message = JointState(
        header=Header(stamp=Time(sec=1, nanosec=2), frame_id="base"), name=["a", "b"], position=[0.5, 1.0]
    )
    node.create_timer(0.02, lambda: publisher.publish(message))


STATE_YAML = """\
header:
  stamp:
    sec: 1
    nanosec: 2
  frame_id: base
name:
- a
- b
position:
- 0.5
- 1.0
velocity: []
effort: []
---
"""


@pytest.mark.parametrize(
    ("options", "printed"),
    [
        ([], STATE_YAML),
        (["--field", "header.stamp"], "sec: 1\nnanosec: 2\n---\n"),
        (["--field", "header.frame_id"], "base\n---\n"),
        (["--csv"], "1,2,base,a,b,0.5,1.0,,\n"),
        (["--no-arr", "--field", "header"], "stamp:\n  sec: 1\n  nanosec: 2\nframe_id: base\n---\n"),
        (["--flow-style"], STATE_YAML.replace("\n- a\n- b", " [a, b]").replace("\n- 0.5\n- 1.0", " [0.5, 1.0]")),
        (["--filter", "len(m.name) == 2 and m.position[1] > 0.7"], STATE_YAML),
    ],
)
def test_echo_options_change_output(add_to_graph, capsys, options, printed):
    add_to_graph(state)
    assert main(["topic", "echo", "--once", "--timeout", "5", *options, "/joint_states"]) == 0
    assert out(capsys) == printed


def test_echo_truncates_long_strings(add_to_graph, capsys):
    add_to_graph(latched)
    assert main(["topic", "echo", "--once", "-l", "4", "/robot_description"]) == 0
    assert out(capsys) == "data: <rob...\n---\n"


def test_echo_raw_prints_bytes(add_to_graph, capsys):
    add_to_graph(latched)
    assert main(["topic", "echo", "--once", "--raw", "/robot_description"]) == 0
    assert out(capsys).startswith("b'\\x00\\x01\\x00\\x00\\t\\x00\\x00\\x00<robot/>\\x00")


def test_echo_prints_message_info(add_to_graph, capsys):
    add_to_graph(state)
    words = ["--once", "-i", "--field", "header.stamp", "/joint_states"]
    assert main(["topic", "echo", *words]) == 0
    assert re.match(r"received_timestamp: \d{19}\nsource_timestamp: \d{19}\n---\nsec: 1\n", out(capsys))


def test_echo_waits_for_topic_of_given_type(add_to_graph, capsys):
    add_to_graph(lambda graph: None)
    assert main(["topic", "echo", "/later", "std_msgs/msg/String", "--timeout", "0.1"]) == 0
    assert out(capsys) == ""


def test_echo_reports_unknown_topic(add_to_graph, capsys):
    add_to_graph(talker)
    assert main(["topic", "echo", "/chattr"]) == 1
    err = capsys.readouterr().err
    assert err.startswith("WARNING: topic [/chattr] does not appear to be published yet\n")
    assert "Could not determine the type for the passed topic" in err
    assert "did you mean '/chatter'?" in err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["/joint_states", "--field", "header.stmp"], "did you mean 'stamp'?"),
        (["/joint_states", "--field", "header..stamp"], "Invalid field 'header..stamp'"),
        (["/joint_states", "sensor_msgs/msg/JointStat"], "did you mean 'JointState'"),
        (["/joint_states", "--filter", "x.data"], "a filter cannot use the name 'x'"),
        (["/joint_states", "--filter", "m.__class__"], "a filter cannot use '__class__'"),
        (["/joint_states", "--filter", "m.nothing > 1"], "the filter cannot be evaluated for a message"),
        (["/joint_states", "--filter", "m."], "the filter is not a Python expression"),
    ],
)
def test_echo_reports_invalid_arguments(add_to_graph, capsys, words, message):
    add_to_graph(state)
    assert main(["topic", "echo", "--timeout", "5", *words]) == 1
    assert message in capsys.readouterr().err


def test_echo_warns_about_incompatible_qos(add_to_graph, capsys):
    add_to_graph(lambda graph: talker(graph, qos=QoSProfile(10, ReliabilityPolicy.BEST_EFFORT)))
    assert main(["topic", "echo", "/chatter", "--qos-reliability", "reliable", "--timeout", "0.2"]) == 0
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "New publisher discovered on topic '/chatter', offering incompatible QoS" in captured.err
    assert "RELIABILITY" in captured.err


def two_types(graph: Graph) -> None:
    node = graph.create_node("both", start_parameter_services=False)
    node.create_publisher(String, "mixed", 10)
    node.create_publisher(Header, "mixed", 10)


def test_echo_rejects_topic_with_two_types(add_to_graph, capsys):
    add_to_graph(two_types)
    assert main(["topic", "echo", "/mixed"]) == 1
    err = capsys.readouterr().err
    assert "contains more than one type: [std_msgs/msg/Header, std_msgs/msg/String]" in err


def test_qos_profile_names_match_graph_presets():
    from linkwright.cli import qos

    assert set(qos._PROFILES) == set(QoSPresetProfiles.short_keys())


# pub


def listener(messages: list, kind=String, topic: str = "chatter"):
    def make(graph: Graph) -> None:
        node = graph.create_node("listener", start_parameter_services=False)
        node.create_subscription(kind, topic, messages.append, 10)

    return make


def test_pub_once_publishes_one_message(add_to_graph, capsys):
    messages: list = []
    add_to_graph(listener(messages))
    words = ["pub", "--once", "/chatter", "std_msgs/msg/String", "data: hello"]
    assert main(["topic", *words, "--keep-alive", "0.02"]) == 0
    assert [message.data for message in messages] == ["hello"]
    assert out(capsys) == "publisher: beginning loop\npublishing #1: std_msgs.msg.String(data='hello')\n\n"


def test_pub_times_publishes_given_number_of_messages(add_to_graph, capsys):
    messages: list = []
    add_to_graph(listener(messages))
    words = ["pub", "-t", "3", "-r", "100", "-p", "2", "/chatter", "std_msgs/String", "{data: x}"]
    assert main(["topic", *words, "--keep-alive", "0.02"]) == 0
    assert len(messages) == 3
    assert out(capsys) == "publisher: beginning loop\npublishing #2: std_msgs.msg.String(data='x')\n\n"


def test_pub_times_out_without_subscription(add_to_graph, capsys):
    add_to_graph(lambda graph: None)
    words = ["pub", "-1", "/chatter", "std_msgs/msg/String", "--max-wait-time-secs", "0.1"]
    assert main(["topic", *words]) == 1
    captured = capsys.readouterr()
    assert captured.out == "Waiting for at least 1 matching subscription(s)...\n"
    assert "Timed out" in captured.err


def test_pub_sets_stamp_to_publishing_time(add_to_graph):
    messages: list = []
    add_to_graph(listener(messages, JointState, "joint_states"))
    words = ["pub", "-1", "/joint_states", "sensor_msgs/msg/JointState", "{header: auto, name: [a], position: [1]}"]
    assert main(["topic", *words, "--keep-alive", "0.02"]) == 0
    assert messages[0].header.stamp.sec > 1_500_000_000
    assert list(messages[0].position) == [1.0]


def test_pub_reads_messages_from_yaml_file(add_to_graph, tmp_path):
    messages: list = []
    add_to_graph(listener(messages))
    file = tmp_path / "messages.yaml"
    file.write_text("data: one\n---\ndata: two\n---\n", encoding="utf-8")
    words = ["pub", "/chatter", "std_msgs/msg/String", "--yaml-file", str(file), "-r", "50", "-w", "1"]
    assert main(["topic", *words, "--keep-alive", "0.02"]) == 0
    assert [message.data for message in messages] == ["one", "two"]


@pytest.mark.parametrize(
    ("kind", "values", "message"),
    [
        ("std_msgs/msg/String", "data: [", "the values are not YAML"),
        ("std_msgs/msg/String", "data:hello", "YAML requires a space after the colon: 'data: hello'"),
        ("std_msgs/msg/String", "{dat: x}", "did you mean 'data'?"),
        ("geometry_msgs/msg/Twist", "{linear: {x: fast}}", "field 'linear.x' is of type double"),
        ("geometry_msgs/msg/Twist", "{linear: {w: 1.0}, angular: {q: 2}}", "has no field 'q'"),
        ("geometry_msgs/msg/Twistt", "{}", "did you mean"),
        ("std_msgs/msg/UInt8", "{data: 300}", "field 'data' is of type uint8"),
    ],
)
def test_pub_reports_invalid_values_with_location(add_to_graph, capsys, kind, values, message):
    add_to_graph(lambda graph: None)
    assert main(["topic", "pub", "-1", "/t", kind, values]) == 1
    assert message in capsys.readouterr().err


def test_pub_marks_unknown_field(add_to_graph, capsys):
    add_to_graph(lambda graph: None)
    main(["topic", "pub", "-1", "/t", "geometry_msgs/msg/Twist", "{linear: {x: 1.0, w: 2.0}}"])
    err = capsys.readouterr().err
    assert "<values>:1:19" in err
    assert "1 | {linear: {x: 1.0, w: 2.0}}\n  |                   ^" in err


# hz, bw, delay


def run_for(seconds: float, words: list[str], monkeypatch: pytest.MonkeyPatch) -> int:
    """Run an endless command for some seconds."""
    from linkwright.cli.session import Session

    original = Session.wait_until_finished

    async def wait_until_finished(self, timeout: float | None = None) -> int | None:
        return await original(self, seconds)

    monkeypatch.setattr(Session, "wait_until_finished", wait_until_finished)
    return main(words)


def test_hz_prints_average_rate(add_to_graph, capsys, monkeypatch):
    add_to_graph(lambda graph: talker(graph, period=0.01))
    assert run_for(1.2, ["topic", "hz", "/chatter"], monkeypatch) == 0
    text = out(capsys)
    match = re.fullmatch(
        r"average rate: (\d+\.\d{3})\n\tmin: (\d\.\d{3})s max: (\d\.\d{3})s std dev: \d\.\d{5}s window: \d+\n", text
    )
    assert match, text
    rate, shortest, longest = map(float, match.groups())
    assert shortest - 0.001 <= 1 / rate <= longest + 0.001


def test_hz_prints_table_for_several_topics(add_to_graph, capsys, monkeypatch):
    def make(graph: Graph) -> None:
        talker(graph, topic="a")
        state(graph)

    add_to_graph(make)
    assert run_for(1.2, ["topic", "hz", "/a", "/joint_states"], monkeypatch) == 0
    lines = out(capsys).splitlines()
    assert lines[:2] == ["Subscribed to [/a]", "Subscribed to [/joint_states]"]
    assert lines[2].split() == ["topic", "rate", "min_delta", "max_delta", "stddev", "window"]
    assert set(lines[3]) == {"="}
    assert lines[4].split()[0] == "/a"


def test_hz_counts_filtered_messages(add_to_graph, capsys, monkeypatch):
    add_to_graph(lambda graph: talker(graph, period=0.01))
    words = ["topic", "hz", "/chatter", "--filter", "m.data.endswith('0')"]
    assert run_for(1.2, words, monkeypatch) == 0
    assert 6 < float(out(capsys).split()[2]) < 14


def test_bw_prints_bandwidth(add_to_graph, capsys, monkeypatch):
    add_to_graph(lambda graph: talker(graph, period=0.01))
    assert run_for(1.2, ["topic", "bw", "/chatter"], monkeypatch) == 0
    text = out(capsys)
    pattern = r"Subscribed to \[/chatter\]\n[\d.]+ K?B/s from \d+ messages\n\tMessage size mean: .* min: .* max: .*\n"
    assert re.fullmatch(pattern, text), text


def test_delay_prints_average_delay(add_to_graph, capsys, monkeypatch):
    def make(graph: Graph) -> None:
        node = graph.create_node("camera", start_parameter_services=False)
        publisher = node.create_publisher("sensor_msgs/msg/Range", "range", 10)
        kind = get_message("sensor_msgs/msg/Range")

        def publish() -> None:
            message = kind()
            message.header.stamp = node.get_clock().now().to_msg()
            publisher.publish(message)

        node.create_timer(0.02, publish)

    add_to_graph(make)
    assert run_for(1.2, ["topic", "delay", "/range"], monkeypatch) == 0
    match = re.match(r"average delay: (-?\d\.\d{3})\n\tmin: ", out(capsys))
    assert match
    assert abs(float(match[1])) < 0.5


def test_delay_requires_header(add_to_graph, capsys):
    add_to_graph(talker)
    assert main(["topic", "delay", "/chatter"]) == 1
    assert "msg does not have header" in capsys.readouterr().err
