"""aggregator_node: groups of diagnostics, their levels, and stale and missing items."""

from __future__ import annotations

import pytest

from linkwright.messages import get_message
from linkwright.nodes import NodeOptions
from linkwright.nodes.diagnostic_aggregator.add_analyzer import AddAnalyzer
from linkwright.nodes.diagnostic_aggregator.items import remove_prefix
from linkwright.nodes.diagnostic_aggregator.node import DiagnosticAggregator

ARRAY, STATUS = get_message("diagnostic_msgs/msg/DiagnosticArray"), get_message("diagnostic_msgs/msg/DiagnosticStatus")
OK, WARN, ERROR, STALE = range(4)
GENERIC = "diagnostic_aggregator/GenericAnalyzer"
GROUP = "diagnostic_aggregator/AnalyzerGroup"
PARTS = {
    "path": "Robot",
    "arms": {"type": GENERIC, "path": "Arms", "startswith": ["/arms"]},
    "sides": {
        "type": GROUP,
        "path": "Sides",
        "analyzers": {
            "left": {"type": GENERIC, "path": "Left", "contains": ["/left"]},
            "right": {"type": GENERIC, "path": "Right", "contains": ["/right"]},
        },
    },
}
CAMERAS = {"cameras": {"type": GENERIC, "path": "Cameras", "startswith": ["camera"]}, "use_sim_time": False}


class AggregatorHarness:
    """The input and the outputs of an aggregator."""

    def __init__(self, harness, parameters):
        self.harness = harness
        self.node = DiagnosticAggregator(harness.graph, NodeOptions(parameters=parameters))
        self.arrays, self.states = [], []
        harness.node.create_subscription(ARRAY, "/diagnostics_agg", self.arrays.append, 10)
        harness.node.create_subscription(STATUS, "/diagnostics_toplevel_state", self.states.append, 10)
        self.publisher = harness.node.create_publisher(ARRAY, "/diagnostics", 10)

    async def send(self, *items, seconds=5):
        """Publish statuses, each a name, a level, and optionally a message."""
        message = ARRAY()
        message.header.stamp.sec = seconds
        for name, level, *text in items:
            status = STATUS(name=name, message=text[0] if text else "", hardware_id="id")
            status.level = bytes([level])
            message.status.append(status)
        self.publisher.publish(message)
        await self.harness.graph.settle()

    async def report(self, seconds=1.0):
        """Return the level and the message of each status, and the values of each group, after some time."""
        await self.harness.clock.advance(seconds)
        statuses = self.arrays[-1].status
        levels = {status.name: (status.level[0], status.message) for status in statuses}
        values = {status.name: {pair.key: pair.value for pair in status.values} for status in statuses}
        return levels, values

    @property
    def state(self):
        return self.states[-1].name, self.states[-1].level[0]


@pytest.fixture
def aggregate(harness):
    return lambda parameters: AggregatorHarness(harness, parameters)


async def test_statuses_are_sorted_into_groups(aggregate):
    aggregator = aggregate(PARTS)
    await aggregator.send(("/arms/left", WARN, "warm"), ("/arms/right", OK, "fine"), ("/legs/right", ERROR, "broken"))
    levels, values = await aggregator.report()
    assert levels == {
        "/Robot/Arms": (WARN, "Warning"),
        "/Robot/Arms/ arms left": (WARN, "warm"),
        "/Robot/Arms/ arms right": (OK, "fine"),
        "/Robot/Sides/Left": (WARN, "Warning"),
        "/Robot/Sides/Left/ arms left": (WARN, "warm"),
        "/Robot/Sides/Right": (ERROR, "Error"),
        "/Robot/Sides/Right/ arms right": (OK, "fine"),
        "/Robot/Sides/Right/ legs right": (ERROR, "broken"),
        "/Robot/Sides": (ERROR, "Error"),
        "/Robot": (ERROR, "Error"),
    }
    assert values["/Robot/Arms"] == {"/arms/left": "warm", "/arms/right": "fine"}
    assert values["/Robot"] == {"Arms": "Warning", "/Robot/Sides": "Error"}
    assert aggregator.state == ("toplevel_state", ERROR)


async def test_aggregator_without_path_has_no_status_of_its_own(aggregate):
    aggregator = aggregate({"analyzers": {"arms": {"type": "GenericAnalyzer", "path": "Arms", "startswith": "/arms"}}})
    await aggregator.send(("/arms/left", OK))
    levels, _ = await aggregator.report()
    assert list(levels) == ["/Arms", "/Arms/ arms left"]


class TestSelection:
    @pytest.mark.parametrize(("rule", "taken"), [
        ({"startswith": ["mot"]}, {"motor: left", "motor: right"}),
        ({"contains": ["left", "arm"]}, {"motor: left", "arm"}),
        ({"name": ["arm"]}, {"arm"}),
        ({"regex": ["motor: (left|up)", "("]}, {"motor: left"}),
        ({"regex": ["motor"]}, set()),
        ({"find_and_remove_prefix": ["motor"], "startswith": ["arm"]}, {"left", "right", "arm"}),
    ])  # fmt: skip
    async def test_one_matching_rule_is_enough(self, aggregate, rule, taken):
        aggregator = aggregate({"part": {"type": GENERIC, "path": "Part", **rule}})
        await aggregator.send(("motor: left", OK), ("motor: right", OK), ("arm", OK))
        levels, _ = await aggregator.report()
        assert {name.removeprefix("/Part/") for name in levels if name.startswith("/Part/")} == taken

    async def test_unselected_statuses_are_in_other_until_they_are_stale(self, aggregate):
        aggregator = aggregate({**PARTS, "other_as_errors": True})
        await aggregator.send(("camera", OK, "fine"))
        levels, _ = await aggregator.report()
        assert levels["/Robot/Other"] == (ERROR, 'Unanalyzed items found in "Other"')
        assert levels["/Robot/Other/camera"] == (OK, "fine")
        levels, _ = await aggregator.report(6.0)
        assert not [name for name in levels if "Other" in name]

    async def test_discarded_statuses_are_not_reported_and_ignored_ones_are_in_other(self, aggregate):
        discard, ignore = "diagnostic_aggregator/DiscardAnalyzer", "diagnostic_aggregator/IgnoreAnalyzer"
        aggregator = aggregate({
            "a": {"type": discard, "path": "A", "contains": ["noise"]},
            "b": {"type": ignore, "path": "B", "contains": ["camera"]},
        })  # fmt: skip
        await aggregator.send(("noise", ERROR), ("camera", OK))
        levels, _ = await aggregator.report()
        assert list(levels) == ["/Other", "/Other/camera"]

    @pytest.mark.parametrize(("path", "prefix", "short"), [
        ("/Base/hokuyo: Connection", "hokuyo", "/Base/Connection"), ("/Base/arm", "hokuyo", "/Base/arm"),
        ("/hokuyo/hokuyo_2", "hokuyo", "/hokuyo/_2"), ("/a/b", "", "/a/b"),
    ])  # fmt: skip
    def test_prefixes_are_removed_with_colon_and_spaces(self, path, prefix, short):
        assert remove_prefix(path, prefix) == short


class TestStaleItems:
    async def test_stale_item_is_an_error_of_its_group_unless_all_are_stale(self, aggregate):
        aggregator = aggregate({"arms": {"type": GENERIC, "path": "Arms", "startswith": ["/arms"], "timeout": 3.0}})
        await aggregator.send(("/arms/left", OK))
        await aggregator.report(2.0)
        await aggregator.send(("/arms/right", OK))
        levels, _ = await aggregator.report(2.0)
        assert (levels["/Arms"], levels["/Arms/ arms left"][0], levels["/Arms/ arms right"][0]) == (
            (ERROR, "Error"), STALE, OK)  # fmt: skip
        levels, _ = await aggregator.report(2.0)
        assert levels["/Arms"] == (STALE, "Stale")
        assert aggregator.state == ("toplevel_state", STALE)

    async def test_items_without_timeout_never_become_stale(self, aggregate):
        aggregator = aggregate({"arms": {"type": GENERIC, "path": "Arms", "startswith": ["/arms"], "timeout": -1.0}})
        await aggregator.send(("/arms/left", OK))
        levels, _ = await aggregator.report(60.0)
        assert levels["/Arms"] == (OK, "OK")

    @pytest.mark.parametrize(("foo_discards", "foo", "bar_discards", "bar", "level"), [
        (True, None, True, None, OK), (True, STALE, True, STALE, OK), (True, None, True, STALE, OK),
        (False, None, False, None, STALE), (False, STALE, False, STALE, STALE), (False, None, False, STALE, STALE),
        (True, None, False, None, ERROR), (True, OK, False, None, ERROR), (True, None, False, OK, OK),
        (True, OK, False, OK, OK),
    ])  # fmt: skip
    async def test_group_without_items_is_ok_only_if_it_discards_stale_ones(
        self, aggregate, foo_discards, foo, bar_discards, bar, level
    ):
        part = {"type": GROUP, "path": "part"}
        for name, discards in (("foo", foo_discards), ("bar", bar_discards)):
            part[name] = {"type": GENERIC, "path": name, "find_and_remove_prefix": [f"/{name}"]}
            part[name]["discard_stale"] = discards
        aggregator = aggregate({"path": "agg", "analyzers": {"part": part}})
        await aggregator.send(*[(f"/{name}", sent) for name, sent in (("foo", foo), ("bar", bar)) if sent is not None])
        levels, _ = await aggregator.report()
        assert levels["/agg"][0] == level

    async def test_expected_items_are_missing_until_they_come(self, aggregate):
        aggregator = aggregate({"arms": {"type": GENERIC, "path": "Arms", "expected": ["left", "right"]}})
        levels, _ = await aggregator.report()
        assert (levels["/Arms"], levels["/Arms/left"]) == ((STALE, "Stale"), (STALE, "Missing"))
        await aggregator.send(("left", OK, "fine"))
        levels, values = await aggregator.report()
        assert (levels["/Arms"], levels["/Arms/left"]) == ((ERROR, "Error"), (OK, "fine"))
        assert values["/Arms"] == {"left": "fine", "right": "Missing"}
        await aggregator.send(("right", OK, "fine"))
        levels, _ = await aggregator.report()
        assert levels["/Arms"] == (OK, "OK")

    async def test_discarded_expected_item_is_still_missing(self, aggregate):
        aggregator = aggregate({
            "arms": {"type": GENERIC, "path": "Arms", "expected": ["left"], "discard_stale": True, "timeout": 2.0}
        })  # fmt: skip
        await aggregator.send(("left", OK))
        levels, _ = await aggregator.report()
        assert levels["/Arms"] == (OK, "OK")
        levels, values = await aggregator.report(3.0)
        assert (levels["/Arms"], levels["/Arms/left"]) == ((ERROR, "Error"), (STALE, "Missing"))
        assert values["/Arms"] == {"left": "Missing"}

    @pytest.mark.parametrize(("count", "sent", "status"), [
        (2, 1, (ERROR, "Expected 2, found 1")), (2, 0, (STALE, "No items found, expected 2")), (2, 2, (OK, "OK")),
        (0, 0, (OK, "OK")), (-1, 1, (OK, "OK")), (-1, 0, (STALE, "Stale")),
    ])  # fmt: skip
    async def test_number_of_items_is_checked(self, aggregate, count, sent, status):
        aggregator = aggregate({"arms": {"type": GENERIC, "path": "Arms", "startswith": ["arm"], "num_items": count}})
        await aggregator.send(*[(f"arm {number}", OK) for number in range(sent)])
        levels, _ = await aggregator.report()
        assert levels["/Arms"] == status


class TestState:
    async def test_empty_aggregator_is_an_error(self, aggregate, logged):
        aggregator = aggregate({})
        levels, _ = await aggregator.report()
        assert levels == {"/AnalyzerGroup": (ERROR, "No analyzers")}
        assert aggregator.state == ("toplevel_state", ERROR)
        assert any("no analyzer is set" in text for text in logged("ERROR"))

    async def test_critical_aggregator_publishes_errors_at_once(self, aggregate):
        aggregator = aggregate({**PARTS, "critical": True})
        await aggregator.send(("/arms/left", ERROR))
        await aggregator.send(("/arms/left", ERROR))
        assert [(state.name, state.level[0]) for state in aggregator.states] == [("toplevel_state_critical", ERROR)]
        await aggregator.report()
        assert aggregator.state == ("toplevel_state", ERROR)

    async def test_rate_is_a_parameter(self, aggregate):
        aggregator = aggregate({**PARTS, "pub_rate": 4.0})
        await aggregator.report(2.0)
        assert len(aggregator.arrays) == 8

    async def test_missing_timestamp_is_logged_once(self, aggregate, logged):
        aggregator = aggregate(PARTS)
        await aggregator.send(("/arms/left", OK), seconds=0)
        await aggregator.send(("/arms/left", OK), seconds=0)
        assert logged("WARN") == ["diagnostics without a timestamp were received: /arms/left"]


class TestAddedAnalyzers:
    async def test_running_aggregator_gets_analyzers(self, harness, aggregate):
        aggregator = aggregate(PARTS)
        adding = AddAnalyzer(harness.graph, NodeOptions(parameters=CAMERAS, namespace="/vision"))
        await harness.clock.advance(1.0)
        assert adding.finished.result() == 0
        adding.close()
        await aggregator.send(("camera", OK), ("/arms/left", OK))
        levels, _ = await aggregator.report()
        assert {"/Robot/Cameras/camera", "/Robot/Arms/ arms left"} <= levels.keys()
        assert "/Robot/Other" not in levels

    async def test_aggregator_is_awaited(self, harness, aggregate, logged):
        adding = AddAnalyzer(harness.graph, NodeOptions(parameters=CAMERAS))
        await harness.clock.advance(1.5)
        assert not adding.finished.done()
        assert logged("INFO") == ["waiting for the service '/analyzers/set_parameters_atomically' of the aggregator"]
        aggregate(PARTS)
        await harness.clock.advance(1.0)
        assert adding.finished.result() == 0

    async def test_other_name_of_aggregator_is_a_remapping(self, harness):
        aggregator = DiagnosticAggregator(harness.graph, NodeOptions(name="mine", parameters=PARTS))
        remapping = ("/analyzers/set_parameters_atomically", "/mine/set_parameters_atomically")
        adding = AddAnalyzer(harness.graph, NodeOptions(parameters=CAMERAS, remappings=[remapping]))
        await harness.clock.advance(1.0)
        assert adding.finished.result() == 0
        assert aggregator.node.get_parameter("cameras.path").value == "Cameras"

    async def test_refusal_is_logged(self, harness, aggregate, logged):
        aggregator = aggregate({**PARTS, "cameras": {"type": GENERIC, "path": "Cameras", "startswith": ["lens"]}})
        wrong = {"cameras": {"type": GENERIC, "path": 5, "startswith": ["camera"]}}
        adding = AddAnalyzer(harness.graph, NodeOptions(parameters=wrong))
        await harness.clock.advance(1.0)
        assert adding.finished.result() == 1
        assert any("refuses the analyzers" in text for text in logged("ERROR"))
        assert aggregator.node.node.get_parameter("cameras.path").value == "Cameras"


class TestWrongParameters:
    @pytest.mark.parametrize(("analyzer", "problem"), [
        ({"type": "mine/Special", "path": "P", "name": "x"}, "parameter 'part.type' must be 'GenericAnalyzer'"),
        ({"type": GENERIC, "path": "P"}, "analyzer 'part' selects no diagnostics"),
        ({"type": GENERIC, "contains": ["x"]}, "set the parameter 'part.path'"),
        ({"type": GROUP, "path": "P"}, "analyzer group 'part' has no analyzers"),
        ({"type": GENERIC, "path": "P", "name": "x", "timeout": "5"}, "parameter 'part.timeout' must be a number"),
    ])  # fmt: skip
    async def test_analyzer_that_cannot_be_created_is_logged_and_stale(self, aggregate, logged, analyzer, problem):
        aggregator = aggregate({**PARTS, "part": analyzer})
        levels, _ = await aggregator.report()
        assert levels["/Robot/part"] == (STALE, "Analyzer init failed")
        assert "/Robot/Arms" in levels
        assert any(problem in text for text in logged("ERROR"))

    async def test_expression_that_is_not_regular_is_logged(self, aggregate, logged):
        aggregate({"part": {"type": GENERIC, "path": "P", "regex": ["("]}, **PARTS})
        assert any("parameter 'part.regex': '(' is not a regular expression" in text for text in logged("ERROR"))

    async def test_discarding_needs_a_timeout(self, aggregate, logged):
        part = {"type": GENERIC, "path": "P", "contains": ["x"], "discard_stale": True, "timeout": 0}
        aggregator = aggregate({"part": part})
        await aggregator.send(("x", OK))
        levels, _ = await aggregator.report(60.0)
        assert levels["/P/x"][0] == OK
        assert any("has no timeout" in text for text in logged("ERROR"))
