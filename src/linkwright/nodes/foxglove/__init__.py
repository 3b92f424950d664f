"""foxglove_bridge: the graph over a WebSocket, as Foxglove and Lichtblick understand it."""

from linkwright.nodes.foxglove.bridge import FoxgloveBridge

__all__ = ["FoxgloveBridge"]
