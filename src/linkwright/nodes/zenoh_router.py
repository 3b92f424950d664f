"""``rmw_zenohd``: the router through which nodes of rmw_zenoh_cpp discover each other."""

from __future__ import annotations

from importlib.util import find_spec

from linkwright.diagnostics import Diagnostic, LinkwrightError, install_hint, phrase
from linkwright.graph import Graph
from linkwright.nodes.options import NodeOptions, SingleNode, create_node


class ZenohRouter(SingleNode):
    """The running Zenoh router, which listens at tcp/localhost:7447 by default.

    The environment variables of rmw_zenohd, ``ZENOH_ROUTER_CONFIG_URI`` and ``ZENOH_CONFIG_OVERRIDE``, configure the
    router. Unlike rmw_zenohd, it accepts only connections from this machine by default. The router's node is hidden.

    Args:
        graph: the graph to which the node is added.
        options: the options of the node.

    Raises:
        LinkwrightError: NODE003 if Zenoh is not installed; DDS111 or DDS112 if the router cannot be opened.
    """

    DEFAULT_NAME = "_rmw_zenohd"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        if find_spec("zenoh") is None:
            raise LinkwrightError(
                Diagnostic("NODE003", phrase("the Zenoh router needs the Zenoh library"), hint=install_hint("zenoh"))
            )
        from linkwright.wire.zenoh.connection_problems import find_configured_addresses
        from linkwright.wire.zenoh.session import build_config, close_session, find_listen_addresses, open_session
        from linkwright.wire.zenoh.session_opener import ObstacleReporter
        from linkwright.wire.zenoh.settings import read_router_settings

        config = build_config(read_router_settings())
        self._session = open_session(config)
        try:
            self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        except LinkwrightError:
            close_session(self._session)
            raise
        logger = self._node.get_logger()
        logger.info(f"Zenoh router at {', '.join(find_listen_addresses(config))}")
        self._reporter = ObstacleReporter(config, self._warn, lambda: bool(self._session.info.routers_zid()))
        if find_configured_addresses(config):
            self._reporter.start()

    def _warn(self, reasons: str) -> None:
        self._node.get_logger().warning(f"Not connected yet; retrying: {reasons}")

    def close(self) -> None:
        """Close the router."""
        from linkwright.wire.zenoh.session import close_session

        self._reporter.end()
        close_session(self._session)
        super().close()
