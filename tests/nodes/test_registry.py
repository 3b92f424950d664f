"""Nodes of Linkwright and of other packages are found through entry points."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.metadata import entry_points

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.loading import extensions
from linkwright.nodes import COMPONENTS, EXECUTABLES, NodeOptions
from linkwright.nodes.options import NodeRegistry, SingleNode
from tests.nodes.harness import NodeHarness


class Blinker(SingleNode):
    """A node of another package."""

    def __init__(self, graph, options: NodeOptions) -> None:
        self._node = graph.create_node(options.name or "blinker")


@pytest.fixture
def installed(tmp_path, monkeypatch: pytest.MonkeyPatch) -> Iterator[NodeRegistry]:
    """Return the executables with an installed package that adds two.

    One of these cannot be imported.
    """
    metadata = tmp_path / "my_robot-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: my_robot\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(
        "[linkwright.nodes]\n"
        f"my_robot/blinker = {__name__}:Blinker\n"
        "my_robot/broken = my_robot_that_is_not_there:Node\n"
        "robot_state_publisher/robot_state_publisher = my_robot_that_is_not_there:Node\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    extensions._read_all_groups.cache_clear()
    yield NodeRegistry("linkwright.nodes")
    extensions._read_all_groups.cache_clear()


def test_builtin_nodes_are_declared_as_entry_points() -> None:
    declared = {entry_point.name for entry_point in entry_points(group="linkwright.nodes")}
    assert {"/".join(key) for key in EXECUTABLES} == declared
    assert ("tf2_ros", "tf2_echo") in EXECUTABLES
    assert ("tf2_ros", "nothing") not in EXECUTABLES
    assert EXECUTABLES.get(("tf2_ros", "nothing")) is None


@pytest.mark.parametrize("key", [*EXECUTABLES, *COMPONENTS], ids="/".join)
def test_builtin_nodes_can_be_imported(key: tuple[str, str]) -> None:
    assert callable(EXECUTABLES.get(key) or COMPONENTS[key])


def test_node_of_another_package_is_started(installed: NodeRegistry, harness: NodeHarness) -> None:
    running = installed["my_robot", "blinker"](harness.graph, NodeOptions())
    assert running.node.get_name() == "blinker"
    running.close()


def test_failed_import_names_the_package(installed: NodeRegistry) -> None:
    with pytest.raises(LinkwrightError, match="the node 'my_robot/broken' cannot be imported") as caught:
        installed["my_robot", "broken"]
    (finding,) = caught.value.diagnostics
    assert finding.code == "NODE002"
    assert finding.hint == (
        "fix the Python package 'my_robot', whose import fails: No module named 'my_robot_that_is_not_there'"
    )


def test_builtin_nodes_are_not_replaced(installed: NodeRegistry) -> None:
    assert installed["robot_state_publisher", "robot_state_publisher"].__module__.startswith("linkwright.")
