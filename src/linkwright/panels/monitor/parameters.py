"""The Parameters panel, the counterpart of ``rqt_reconfigure``."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any, cast

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.graph import MessageInfo, Node, Parameter
from linkwright.graph.parameters.client import AsyncParameterClient
from linkwright.graph.parameters.files import format_parameter_file, plain_value
from linkwright.graph.parameters.parameter import ParameterType
from linkwright.page.audience import Page
from linkwright.page.protocol.monitor import (
    DumpParameters,
    NodeParameters,
    ParameterDump,
    ParameterKind,
    ParameterNodes,
    ParameterResult,
    ParameterRow,
    SetParameter,
    WatchParameters,
)
from linkwright.panels.monitor.topic_tap import RateLimiter, TopicTap
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.rviz.parameter_responses import NoParameterResponseError, wait_for_response, wait_for_services

_KIND_NAMES: dict[ParameterType, ParameterKind] = {
    kind: cast("ParameterKind", kind.name.lower()) for kind in ParameterType
}
_TYPES_BY_KIND = {text: kind for kind, text in _KIND_NAMES.items()}
_EXPECTED_TEXTS = {
    "bool": phrase("true or false"),
    "integer": phrase("an integer"),
    "double": phrase("a number"),
    "byte": phrase("a byte, 0 to 255"),
}
_BOOLS = {"true": True, "false": False}
_INT64_RANGE = range(-(2**63), 2**63)


def make_parameter_row(descriptor: Any, value: Any) -> ParameterRow:
    """Return the row of a parameter for pages.

    Args:
        descriptor: a rcl_interfaces/msg/ParameterDescriptor.
        value: a rcl_interfaces/msg/ParameterValue.
    """
    limits = [*descriptor.floating_point_range, *descriptor.integer_range]
    minimum, maximum, step = ("", "", "")
    if limits:
        minimum, maximum = str(limits[0].from_value), str(limits[0].to_value)
        step = str(limits[0].step) if limits[0].step else ""
    kind, values = format_value(value)
    return ParameterRow(
        name=descriptor.name,
        kind=kind,
        values=values,
        description=descriptor.description,
        constraints=descriptor.additional_constraints,
        read_only=descriptor.read_only,
        minimum=minimum,
        maximum=maximum,
        step=step,
    )


def format_value(value: Any) -> tuple[ParameterKind, list[str]]:
    """Return the kind of a rcl_interfaces/msg/ParameterValue, and the texts of its elements."""
    plain = plain_value(value)
    kind = ParameterType(value.type)
    if kind is ParameterType.NOT_SET:
        return _KIND_NAMES[kind], []
    return _KIND_NAMES[kind], [_format_element(element) for element in (plain if kind.is_array else [plain])]


def parse_parameter(request: SetParameter) -> Parameter:
    """Return the parameter that a page requests to set.

    Raises:
        ValueError: a text is not a value of the parameter's kind; the message quotes the text.
    """
    kind = _TYPES_BY_KIND[request.kind]
    if kind is ParameterType.NOT_SET:
        return Parameter(request.name, kind)
    element = request.kind.removesuffix("_array")
    values = [_parse_element(element, text) for text in request.values]
    if kind.is_array:
        return Parameter(request.name, kind, values)
    if len(values) != 1:
        raise ValueError(f"a {element} must be one value, not {len(values)}")
    return Parameter(request.name, kind, values[0])


def _format_element(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return str(value[0]) if isinstance(value, bytes) else str(value)


def _parse_element(kind: str, text: str) -> Any:
    if kind == "string":
        return text
    try:
        if kind == "bool":
            return _BOOLS[text.strip().lower()]
        if kind == "double":
            return float(text)
        number = int(text, 0)
        if kind == "byte":
            return bytes([number])
    except (ValueError, KeyError):
        raise ValueError(f"'{text}' is not {_EXPECTED_TEXTS[kind]}") from None
    if number not in _INT64_RANGE:
        raise ValueError(f"{text} does not fit into 64 bits")
    return number


_PUBLISH_PERIOD_S = 0.05


class RemoteNode:
    """A client for the parameters of another node that follows their changes.

    Args:
        node: the node that creates the clients.
        name: the full name of the node that has the parameters.
        publish: called with all parameters after the first request and after every change.
    """

    def __init__(self, node: Node, name: str, publish: Callable[[NodeParameters], None]) -> None:
        self.name = name
        self.parameters: NodeParameters | None = None
        self._publish = publish
        self._client = AsyncParameterClient(node, name)
        self._rows: dict[str, ParameterRow] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._publisher = RateLimiter(self._publish_rows, _PUBLISH_PERIOD_S)

    def close(self) -> None:
        """Cancel requests, and destroy the clients."""
        self._publisher.cancel()
        for task in self._tasks:
            task.cancel()
        self._client.destroy()

    def refresh(self) -> None:
        """Request all parameters again."""
        self._run(self._refresh())

    def apply_event(self, event: Any) -> None:
        """Apply a rcl_interfaces/msg/ParameterEvent of the node to the known parameters."""
        for parameter in event.deleted_parameters:
            self._rows.pop(parameter.name, None)
        for parameter in event.changed_parameters:
            row = self._rows.get(parameter.name)
            if row is not None:
                row.kind, row.values = format_value(parameter.value)
        if any(parameter.name not in self._rows for parameter in event.new_parameters):
            self.refresh()
        elif self.parameters is not None:
            self._publisher.request()

    def set(self, request: SetParameter, on_result: Callable[[ParameterResult], None]) -> None:
        """Set a parameter, and call the callback with the result."""
        self._run(self._set(request, on_result))

    def dump(self, on_result: Callable[[ParameterDump], None]) -> None:
        """Call the callback with a parameter file that contains all parameters."""
        self._run(self._dump(on_result))

    def _run(self, coroutine: Any) -> None:
        task = asyncio.get_running_loop().create_task(coroutine)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _refresh(self) -> None:
        try:
            names = await self._request_parameter_names()
            values = (await self._wait_for_response(self._client.get_parameters(names))).values if names else []
            descriptors = (
                (await self._wait_for_response(self._client.describe_parameters(names))).descriptors if names else []
            )
        except NoParameterResponseError as error:
            self.parameters = NodeParameters(self.name, [], str(error))
            self._publish(self.parameters)
            return
        pairs = zip(descriptors, values, strict=False)
        self._rows = {descriptor.name: make_parameter_row(descriptor, value) for descriptor, value in pairs}
        self._publish_rows()

    def _publish_rows(self) -> None:
        self.parameters = NodeParameters(self.name, [self._rows[name] for name in sorted(self._rows)], None)
        self._publish(self.parameters)

    async def _set(self, request: SetParameter, on_result: Callable[[ParameterResult], None]) -> None:
        try:
            await wait_for_services(self._client)
            response = await self._wait_for_response(self._client.set_parameters([parse_parameter(request)]))
        except (ValueError, NoParameterResponseError) as error:
            on_result(ParameterResult(self.name, request.name, False, str(error)))
            return
        result = response.results[0]
        on_result(ParameterResult(self.name, request.name, result.successful, result.reason))

    async def _dump(self, on_result: Callable[[ParameterDump], None]) -> None:
        file = f"{self.name.strip('/').replace('/', '__')}.yaml"
        try:
            names = await self._request_parameter_names()
            values = (await self._wait_for_response(self._client.get_parameters(names))).values if names else []
        except NoParameterResponseError as error:
            on_result(ParameterDump(self.name, file, "", str(error)))
            return
        plain_values = {name: plain_value(value) for name, value in zip(names, values, strict=False)}
        on_result(ParameterDump(self.name, file, format_parameter_file(self.name, plain_values), None))

    async def _request_parameter_names(self) -> list[str]:
        await wait_for_services(self._client)
        return sorted((await self._wait_for_response(self._client.list_parameters())).result.names)

    async def _wait_for_response(self, future: Awaitable[Any]) -> Any:
        return await wait_for_response(self._client, future)


_EVENTS_TOPIC = "/parameter_events"
_LIST_SUFFIX = "/list_parameters"


@dataclass(slots=True)
class _Request:
    wants_list: bool
    node: str | None
    sent: ParameterNodes | None = None


class ParametersFeature(PageFeature):
    """The feature that sends the parameters of nodes to pages, and sets parameters."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._requests: dict[Page, _Request] = {}
        self._nodes: dict[str, RemoteNode] = {}
        self._event_tap: TopicTap | None = None

    def receive(self, page: Page, message: WatchParameters | SetParameter | DumpParameters) -> None:
        """Handle a request.

        A page can set and dump parameters only of the node that it watches.
        """
        if isinstance(message, WatchParameters):
            self._watch(page, message)
            return
        request = self._requests.get(page)
        if request is None or request.node != message.node:
            return
        if isinstance(message, SetParameter):
            self._nodes[message.node].set(message, page.send)
        else:
            self._nodes[message.node].dump(page.send)

    def remove_page(self, page: Page) -> None:
        """Discard the page's requests, and close the clients that no other page needs."""
        if self._requests.pop(page, None) is not None:
            self._update_subscriptions()

    def close(self) -> None:
        """Close all clients and subscriptions."""
        self._requests.clear()
        self._update_subscriptions()

    def _watch(self, page: Page, message: WatchParameters) -> None:
        name = message.node
        watched_node = self._nodes.get(name) if name is not None else None
        if name is not None and watched_node is None:
            try:
                self._nodes[name] = RemoteNode(self.context.node, name, self._publish)
            except LinkwrightError as error:
                page.send(NodeParameters(name, [], error.diagnostics[0].message))
                name = None
        self._requests[page] = _Request(message.wants_list, name)
        self._update_subscriptions()
        if message.wants_list:
            self._send_node_lists()
        if watched_node is None and name is not None:
            self._nodes[name].refresh()
        elif watched_node is not None and watched_node.parameters is not None:
            page.send(watched_node.parameters)

    def _update_subscriptions(self) -> None:
        """Close the clients that no page needs, and update the subscriptions."""
        requests = self._requests.values()
        names = {request.node for request in requests if request.node is not None}
        for name in self._nodes.keys() - names:
            self._nodes.pop(name).close()
        if names and self._event_tap is None:
            self._event_tap = TopicTap(self.context, _EVENTS_TOPIC, self._receive)
        elif not names and self._event_tap is not None:
            self._event_tap.close()
            self._event_tap = None
        if any(request.wants_list for request in requests):
            self.context.graph_changes.watch(self._send_node_lists)
        else:
            self.context.graph_changes.unwatch(self._send_node_lists)

    def _receive(self, event: Any, _: MessageInfo) -> None:
        node = self._nodes.get(event.node)
        if node is not None:
            node.apply_event(event)

    def _publish(self, parameters: NodeParameters) -> None:
        for page, request in self._requests.items():
            if request.node == parameters.node:
                page.send(parameters)

    def _send_node_lists(self) -> None:
        services = (name for name, _ in self.context.node.get_service_names_and_types())
        node_list = ParameterNodes(
            [name.removesuffix(_LIST_SUFFIX) for name in services if name.endswith(_LIST_SUFFIX)]
        )
        for page, request in self._requests.items():
            if request.wants_list and request.sent != node_list:
                reappeared_node = self._find_reappeared_node(request, node_list)
                request.sent = node_list
                page.send(node_list)
                if reappeared_node is not None:
                    reappeared_node.refresh()

    def _find_reappeared_node(self, request: _Request, node_list: ParameterNodes) -> RemoteNode | None:
        """Return the watched node if it has reappeared after it was missing, or None."""
        if (
            request.sent is None
            or request.node is None
            or request.node in request.sent.nodes
            or request.node not in node_list.nodes
        ):
            return None
        return self._nodes[request.node]
