"""The node rosbridge_websocket of rosbridge_server, which serves the graph to web pages and programs by WebSocket."""

from linkwright.bridge.rosbridge.node import RosbridgeWebsocket

__all__ = ["RosbridgeWebsocket"]
