"""The foxglove_bridge, which serves the graph over a WebSocket to Foxglove and Lichtblick."""

from linkwright.bridge.foxglove.bridge import FoxgloveBridge

__all__ = ["FoxgloveBridge"]
