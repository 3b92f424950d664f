"""The node rosapi_node of rosapi, which answers questions of rosbridge's clients about the graph."""

from linkwright.bridge.rosapi.node import RosapiNode

__all__ = ["RosapiNode"]
