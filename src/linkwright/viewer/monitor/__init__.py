"""The live panels: plots, topics, the node graph, parameters, the log and the teleop pad."""

from linkwright.viewer.monitor.panels import live_panels

__all__ = ["live_panels"]
