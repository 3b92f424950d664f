from linkwright.graph import Graph, JumpClock, LogLevel, LogRecord, console_line


async def test_the_console_format_is_that_of_rcutils(capsys):
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


async def test_a_terminal_gets_colours_unless_it_asks_for_none(capsys, monkeypatch):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    graph = Graph(clock=JumpClock(0))
    logger = graph.get_logger("kdl_parser")
    logger.info("plain")
    logger.warning("yellow")
    monkeypatch.setenv("NO_COLOR", "1")
    logger.warning("plain")
    assert capsys.readouterr().err.splitlines() == [
        "[INFO] [0.000000000] [kdl_parser]: plain",
        "\x1b[33m[WARN] [0.000000000] [kdl_parser]: yellow\x1b[0m",
        "[WARN] [0.000000000] [kdl_parser]: plain",
    ]


async def test_the_level_can_be_lowered(graph, log):
    logger = graph.create_node("node").get_logger()
    logger.level = LogLevel.DEBUG
    logger.debug("now")
    assert log == [LogRecord("node", LogLevel.DEBUG, graph.clock.now_ns(), "now")]
    assert console_line(log[0]).startswith("[DEBUG]")
