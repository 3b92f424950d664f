"""The live panels together: they share one look-out for changes of the graph."""

from __future__ import annotations

from linkwright.viewer.features import Desk, PageFeature
from linkwright.viewer.monitor.graph_changes import GraphChanges
from linkwright.viewer.monitor.log import LogFeature
from linkwright.viewer.monitor.node_graph import NodeGraphFeature
from linkwright.viewer.monitor.parameters import ParametersFeature
from linkwright.viewer.monitor.plots import PlotsFeature
from linkwright.viewer.monitor.teleop import TeleopFeature
from linkwright.viewer.monitor.topics import TopicsFeature


def live_panels(desk: Desk) -> list[PageFeature]:
    """What the live panels of pages talk to."""
    changes = GraphChanges(desk.node.graph)
    return [
        TopicsFeature(desk, changes),
        PlotsFeature(desk, changes),
        NodeGraphFeature(desk, changes),
        ParametersFeature(desk, changes),
        LogFeature(desk, changes),
        TeleopFeature(desk, changes),
    ]
