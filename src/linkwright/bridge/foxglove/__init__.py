"""The foxglove_bridge: the graph over a WebSocket, with the protocol of Foxglove and Lichtblick."""

from linkwright.bridge.foxglove.bridge import FoxgloveBridge

__all__ = ["FoxgloveBridge"]
