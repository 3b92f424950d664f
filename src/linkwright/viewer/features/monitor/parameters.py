"""The parameters panel: what ``rqt_reconfigure`` shows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import MessageInfo
from linkwright.viewer.features.monitor.node_parameters import RemoteNode
from linkwright.viewer.features.monitor.topic_tap import TopicTap
from linkwright.viewer.features.page_feature import FeatureHost, PageFeature
from linkwright.viewer.protocol.parameters import (
    DumpParameters,
    NodeParameters,
    ParameterNodes,
    SetParameter,
    WatchParameters,
)
from linkwright.viewer.web.audience import Page

_EVENTS = "/parameter_events"
_LIST = "/list_parameters"


@dataclass(slots=True)
class _Wish:
    listed: bool
    node: str | None
    told: ParameterNodes | None = None


class ParametersFeature(PageFeature):
    """Shows pages the parameters of nodes, and sets them."""

    RECEIVES = (WatchParameters, SetParameter, DumpParameters)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._wishes: dict[Page, _Wish] = {}
        self._nodes: dict[str, RemoteNode] = {}
        self._events: TopicTap | None = None

    def receive(self, page: Page, message: WatchParameters | SetParameter | DumpParameters) -> None:
        """Do what a page asks for; a node's parameters can be set and dumped by who watches them."""
        if isinstance(message, WatchParameters):
            self._watch(page, message)
            return
        wish = self._wishes.get(page)
        if wish is None or wish.node != message.node:
            return
        if isinstance(message, SetParameter):
            self._nodes[message.node].set(message, page.send)
        else:
            self._nodes[message.node].dump(page.send)

    def page_gone(self, page: Page) -> None:
        """Forget the page's requests."""
        if self._wishes.pop(page, None) is not None:
            self._keep()

    def close(self) -> None:
        """End everything."""
        self._wishes.clear()
        self._keep()

    def _watch(self, page: Page, message: WatchParameters) -> None:
        name = message.node
        known = self._nodes.get(name) if name is not None else None
        if name is not None and known is None:
            try:
                self._nodes[name] = RemoteNode(self.context.node, name, self._tell)
            except LinkwrightError as error:
                page.send(NodeParameters(name, [], error.diagnostics[0].message))
                name = None
        self._wishes[page] = _Wish(message.listed, name)
        self._keep()
        if message.listed:
            self._send_lists()
        if known is None and name is not None:
            self._nodes[name].refresh()
        elif known is not None and known.known is not None:
            page.send(known.known)

    def _keep(self) -> None:
        """Close clients and subscriptions that no page needs, and open those that one does."""
        wishes = self._wishes.values()
        wanted = {wish.node for wish in wishes if wish.node is not None}
        for name in self._nodes.keys() - wanted:
            self._nodes.pop(name).close()
        if wanted and self._events is None:
            self._events = TopicTap(self.context, _EVENTS, self._take)
        elif not wanted and self._events is not None:
            self._events.close()
            self._events = None
        if any(wish.listed for wish in wishes):
            self.context.graph_changes.listen(self._send_lists)
        else:
            self.context.graph_changes.ignore(self._send_lists)

    def _take(self, event: Any, _: MessageInfo) -> None:
        node = self._nodes.get(event.node)
        if node is not None:
            node.take(event)

    def _tell(self, parameters: NodeParameters) -> None:
        for page, wish in self._wishes.items():
            if wish.node == parameters.node:
                page.send(parameters)

    def _send_lists(self) -> None:
        services = (name for name, _ in self.context.node.get_service_names_and_types())
        listed = ParameterNodes([name.removesuffix(_LIST) for name in services if name.endswith(_LIST)])
        for page, wish in self._wishes.items():
            if wish.listed and wish.told != listed:
                back = self._returned(wish, listed)
                wish.told = listed
                page.send(listed)
                if back is not None:
                    back.refresh()

    def _returned(self, wish: _Wish, listed: ParameterNodes) -> RemoteNode | None:
        """The node that the page watches, if it has come (again) since the last list."""
        if wish.told is None or wish.node is None or wish.node in wish.told.nodes or wish.node not in listed.nodes:
            return None
        return self._nodes[wish.node]
