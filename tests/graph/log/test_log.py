"""The log: console formats, colors, files, levels and `/rosout`."""

from __future__ import annotations

import io
import os
import re

import pytest

from linkwright.graph import Graph, JumpClock, LogLevel, LogRecord, format_console_line
from linkwright.graph.command_line.log_setup import set_up_logging
from linkwright.graph.command_line.ros_arguments import parse
from linkwright.graph.log.file import LogFile, find_log_folder
from linkwright.graph.logger_services import LoggerServices
from linkwright.graph.qos.profile import ROSOUT_QOS
from linkwright.messages import get_message, get_service

LOG_RECORD = LogRecord("robot.node", LogLevel.WARN, 1_700_000_000_123_456_789, "hello", "/src/a.py", "run", 7)


async def test_console_format_matches_rcutils(capsys):
    graph = Graph(clock=JumpClock(1_700_000_000_123_456_789))
    logger = graph.create_node("node", namespace="/robot").get_logger()
    logger.debug("hidden")
    logger.info("hello")
    logger.warning("careful")
    logger.error("wrong")
    logger.fatal("over")
    await graph.close()
    output = capsys.readouterr()
    assert output.out == ""
    assert output.err.splitlines() == [
        "[INFO] [1700000000.123456789] [robot.node]: hello",
        "[WARN] [1700000000.123456789] [robot.node]: careful",
        "[ERROR] [1700000000.123456789] [robot.node]: wrong",
        "[FATAL] [1700000000.123456789] [robot.node]: over",
    ]


@pytest.mark.parametrize(
    ("form", "line"),
    [
        ("", "[WARN] [1700000000.123456789] [robot.node]: hello"),
        ("{severity}|{name}|{message}", "WARN|robot.node|hello"),
        ("{function_name} {file_name} {line_number} {short_file_name}", "run /src/a.py 7 a.py"),
        ("{time_as_nanoseconds}", "1700000000123456789"),
        ("{unknown} {message", "{unknown} {message"),
        ("{{message}}", "{hello}"),
        (r"a\tb\n\x1b[0m", "a\tb\n\x1b[0m"),
    ],
)
def test_console_format_is_read_from_environment(monkeypatch, form, line):
    monkeypatch.setenv("RCUTILS_CONSOLE_OUTPUT_FORMAT", form)
    assert format_console_line(LOG_RECORD) == line


def test_newer_format_tokens_are_supported(monkeypatch):
    monkeypatch.setenv("RCUTILS_CONSOLE_OUTPUT_FORMAT", "{date_time_with_ms} {thread_id}")
    assert re.fullmatch(r"2023-11-1\d \d\d:\d\d:20\.123 \d+", format_console_line(LOG_RECORD))


async def test_terminal_output_is_colored_unless_disabled(capsys, monkeypatch):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    monkeypatch.delenv("NO_COLOR", raising=False)
    graph = Graph(clock=JumpClock(0))
    logger = graph.get_logger("kdl_parser")
    logger.info("normal")
    logger.warning("yellow")
    monkeypatch.setenv("NO_COLOR", "1")
    logger.warning("plain")
    monkeypatch.setenv("RCUTILS_COLORIZED_OUTPUT", "1")
    logger.error("red")
    assert capsys.readouterr().err.splitlines() == [
        "\x1b[0m[INFO] [0.000000000] [kdl_parser]: normal\x1b[0m",
        "\x1b[33m[WARN] [0.000000000] [kdl_parser]: yellow\x1b[0m",
        "[WARN] [0.000000000] [kdl_parser]: plain",
        "\x1b[31m[ERROR] [0.000000000] [kdl_parser]: red\x1b[0m",
    ]


async def test_environment_selects_output_stream(capsys, monkeypatch):
    monkeypatch.setenv("RCUTILS_LOGGING_USE_STDOUT", "1")
    Graph(clock=JumpClock(0)).get_logger("a").info("x")
    assert capsys.readouterr().out == "[INFO] [0.000000000] [a]: x\n"


@pytest.mark.parametrize("stream", [None, "closed"])
def test_missing_console_is_ignored(monkeypatch, stream):
    closed = io.StringIO()
    closed.close()
    monkeypatch.setattr("sys.stderr", closed if stream else None)
    assert Graph().get_logger("a").info("nobody reads this")


async def test_log_record_names_file_function_and_line(graph, log):
    graph.get_logger("a").info("x")
    assert log[0].file == __file__
    assert log[0].function == "test_log_record_names_file_function_and_line"
    assert log[0].line == test_log_record_names_file_function_and_line.__code__.co_firstlineno + 1


async def test_logger_levels_are_inherited(graph, log):
    robot, arm = graph.get_logger("robot"), graph.get_logger("robot.arm")
    assert arm.get_effective_level() is LogLevel.INFO
    robot.set_level(LogLevel.DEBUG)
    assert arm.level is LogLevel.DEBUG
    assert arm.is_enabled_for(LogLevel.DEBUG)
    arm.set_level(LogLevel.ERROR)
    assert not arm.is_enabled_for(LogLevel.WARN)
    hand = arm.get_child("hand")
    assert (hand.name, hand.level) == ("robot.arm.hand", LogLevel.ERROR)
    arm.set_level(LogLevel.UNSET)
    assert hand.level is LogLevel.DEBUG
    assert graph.get_logger("robotic").level is LogLevel.INFO
    graph.get_logger("").set_level(LogLevel.FATAL)
    assert graph.get_logger("robotic").level is LogLevel.FATAL
    with pytest.raises(ValueError, match="Child logger name must not be empty"):
        arm.get_child("")
    assert hand.debug("now")
    assert log == [LogRecord("robot.arm.hand", LogLevel.DEBUG, graph.clock.now_ns(), "now")]


async def test_once_skip_first_and_throttle_limit_messages(graph, log, clock):
    logger = graph.get_logger("a")
    node_clock = graph.create_node("node").get_clock()
    written = []
    for turn in range(4):
        logger.info(f"once {turn}", once=True)
        logger.info(f"skip {turn}", skip_first=True)
        written.append(logger.info(f"slow {turn}", throttle_duration_sec=1.0, throttle_time_source_type=node_clock))
        logger.info(f"rare {turn}", throttle_duration_sec=1000.0)
        await clock.advance(0.6)
    assert [record.text for record in log] == [
        *("once 0", "slow 0", "rare 0", "skip 1", "skip 2", "slow 2", "skip 3"),
    ]
    assert written == [True, False, True, False]


async def test_filters_are_tracked_per_call_site(graph, log):
    logger = graph.get_logger("a")
    logger.info("here", once=True)
    logger.info("there", once=True)

    def at_one_place(severity, **filters):
        return logger.log("same", severity, **filters)

    assert at_one_place(LogLevel.INFO, throttle_duration_sec=0.001)
    with pytest.raises(ValueError, match=r"Logger severity cannot be changed between calls."):
        at_one_place(LogLevel.WARN, throttle_duration_sec=0.001)
    with pytest.raises(ValueError, match=r"Logging filter parameters cannot be changed between calls."):
        at_one_place(LogLevel.INFO, throttle_duration_sec=0.002)
    with pytest.raises(ValueError, match=r"Requested logging filters cannot be changed between calls."):
        at_one_place(LogLevel.INFO)
    with pytest.raises(ValueError, match=r"Logger name cannot be changed between calls."):
        at_one_place(LogLevel.INFO, throttle_duration_sec=0.001, name="b")
    assert [record.text for record in log] == ["here", "there", "same"]


async def test_invalid_filters_are_rejected(graph):
    logger = graph.get_logger("a")
    with pytest.raises(TypeError, match='parameter "twice" is not one of the recognized logging options'):
        logger.info("x", twice=True)
    with pytest.raises(TypeError, match='required parameter "throttle_duration_sec" not specified'):
        logger.info("x", throttle_time_source_type="RCUTILS_STEADY_TIME")
    with pytest.raises(ValueError, match='Received throttle_time_source_type of "x"'):
        logger.info("x", throttle_duration_sec=1.0, throttle_time_source_type="x")


async def test_node_logs_are_published_on_rosout(graph, log, clock):
    node = graph.create_node("talker", namespace="/robot")
    node.get_logger().warning("before")
    node.get_logger().get_child("part").info("child")
    messages = []
    graph.create_node("listener").create_subscription(
        get_message("rcl_interfaces/msg/Log"), "/rosout", messages.append, ROSOUT_QOS
    )
    node.get_logger().error("after")
    await graph.settle()
    assert [(message.name, message.msg, message.level) for message in messages] == [
        ("robot.talker", "before", 30),
        ("robot.talker.part", "child", 20),
        ("robot.talker", "after", 40),
    ]
    assert messages[0].file == __file__
    assert messages[0].function == "test_node_logs_are_published_on_rosout"
    assert messages[0].stamp.sec == clock.now_ns() // 10**9
    graph.get_logger("other").info("not a node's")
    await graph.settle()
    assert len(messages) == 3


async def test_node_can_disable_rosout(graph):
    graph.create_node("quiet", enable_rosout=False).get_logger().info("x")
    assert "/rosout" not in graph.topics()


def test_log_folder_is_read_from_environment(monkeypatch, tmp_path):
    assert find_log_folder({"ROS_LOG_DIR": str(tmp_path), "ROS_HOME": "/x"}) == tmp_path
    assert find_log_folder({"ROS_HOME": "/x"}).as_posix() == "/x/log"
    monkeypatch.setenv("HOME", str(tmp_path))
    assert find_log_folder({}) == tmp_path / ".ros" / "log"


def test_log_files_are_named_like_spdlog(tmp_path):
    file = LogFile("talker", tmp_path / "deep")
    assert list(tmp_path.iterdir()) == []
    file.write(LOG_RECORD)
    file.close()
    file.write(LOG_RECORD)
    (path,) = (tmp_path / "deep").iterdir()
    assert re.fullmatch(rf"talker_{os.getpid()}_\d{{13}}\.log", path.name)
    assert path.read_text() == "[WARN] [1700000000.123456789] [robot.node]: hello\n"
    (tmp_path / "blocked").write_text("")
    LogFile("talker", tmp_path / "blocked").write(LOG_RECORD)


def test_ros_arguments_select_log_outputs_and_levels(monkeypatch, tmp_path, capsys):
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path))
    silent = set_up_logging(parse(["--ros-args", "--disable-stdout-logs", "--log-level", "a.b:=error"]), "talker")
    silent.sink(LOG_RECORD)
    silent.close()
    assert capsys.readouterr().err == ""
    assert len(list(tmp_path.iterdir())) == 1
    assert (silent.levels.effective_level("a.b.c"), silent.levels.effective_level("a")) == (
        LogLevel.ERROR,
        LogLevel.INFO,
    )
    debug_log = set_up_logging(
        parse(["--ros-args", "--disable-external-lib-logs", "--disable-rosout-logs", "--log-level", "debug"]), "talker"
    )
    debug_log.sink(LOG_RECORD)
    assert "hello" in capsys.readouterr().err
    assert (debug_log.file, debug_log.rosout, debug_log.levels.effective_level("x")) == (None, False, LogLevel.DEBUG)


async def test_logger_level_services_set_and_get_levels(graph):
    node = graph.create_node("node")
    LoggerServices(node, graph.levels)
    asking = graph.create_node("asking")
    set_levels = asking.create_client(get_service("rcl_interfaces/srv/SetLoggerLevels"), "/node/set_logger_levels")
    get_levels = asking.create_client(get_service("rcl_interfaces/srv/GetLoggerLevels"), "/node/get_logger_levels")
    level = get_message("rcl_interfaces/msg/LoggerLevel")
    response = set_levels.call_async(
        set_levels.srv_type.Request(levels=[level(name="node", level=10), level(name="node", level=11)])
    )
    await graph.settle()
    assert [result.successful for result in response.result().results] == [True, False]
    assert node.get_logger().level is LogLevel.DEBUG
    response = get_levels.call_async(get_levels.srv_type.Request(names=["node", "x"]))
    await graph.settle()
    assert [(level.name, level.level) for level in response.result().levels] == [("node", 10), ("x", 0)]
