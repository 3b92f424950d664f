"""The Parameters panel, the counterpart of ``rqt_reconfigure``."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any, cast

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.graph import MessageInfo, Node, Parameter
from linkwright.graph.parameters.client import AsyncParameterClient
from linkwright.graph.parameters.files import parameter_file_text, plain_value
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
from linkwright.panels.monitor.topic_tap import Paced, TopicTap
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.rviz.parameter_answers import NoAnswerError, answer, services_ready

_KINDS: dict[ParameterType, ParameterKind] = {kind: cast("ParameterKind", kind.name.lower()) for kind in ParameterType}
_TYPES = {text: kind for kind, text in _KINDS.items()}
_ARTICLES = {
    "bool": phrase("true or false"),
    "integer": phrase("an integer"),
    "double": phrase("a number"),
    "byte": phrase("a byte, 0 to 255"),
}
_BOOLS = {"true": True, "false": False}
_LONGS = range(-(2**63), 2**63)


def parameter_row(descriptor: Any, value: Any) -> ParameterRow:
    """Return the page's row for a parameter.

    Args:
        descriptor: rcl_interfaces/msg/ParameterDescriptor.
        value: rcl_interfaces/msg/ParameterValue.
    """
    limits = [*descriptor.floating_point_range, *descriptor.integer_range]
    minimum, maximum, step = ("", "", "")
    if limits:
        minimum, maximum = str(limits[0].from_value), str(limits[0].to_value)
        step = str(limits[0].step) if limits[0].step else ""
    kind, values = value_texts(value)
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


def value_texts(value: Any) -> tuple[ParameterKind, list[str]]:
    """Return the kind of a rcl_interfaces/msg/ParameterValue, and the texts of its elements."""
    plain = plain_value(value)
    kind = ParameterType(value.type)
    if kind is ParameterType.NOT_SET:
        return _KINDS[kind], []
    return _KINDS[kind], [_text(element) for element in (plain if kind.is_array else [plain])]


def parameter_of(request: SetParameter) -> Parameter:
    """Return the parameter that a page requests to set.

    Raises:
        ValueError: a text is not a value of the parameter's kind; the message quotes the text.
    """
    kind = _TYPES[request.kind]
    if kind is ParameterType.NOT_SET:
        return Parameter(request.name, kind)
    element = request.kind.removesuffix("_array")
    values = [_value(element, text) for text in request.values]
    if kind.is_array:
        return Parameter(request.name, kind, values)
    if len(values) != 1:
        raise ValueError(f"a {element} is one value, not {len(values)}")
    return Parameter(request.name, kind, values[0])


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return str(value[0]) if isinstance(value, bytes) else str(value)


def _value(kind: str, text: str) -> Any:
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
        raise ValueError(f"'{text}' is not {_ARTICLES[kind]}") from None
    if number not in _LONGS:
        raise ValueError(f"{text} is more than 64 bits can hold")
    return number


_PUBLISH_PERIOD = 0.05


class RemoteNode:
    """Reads and sets the parameters of another node, and follows their changes.

    Args:
        node: the node that creates the clients.
        name: the full name of the node that has the parameters.
        publish: called with all parameters at the start and after every change.
    """

    def __init__(self, node: Node, name: str, publish: Callable[[NodeParameters], None]) -> None:
        self.name = name
        self.known: NodeParameters | None = None
        self._publish = publish
        self._client = AsyncParameterClient(node, name)
        self._rows: dict[str, ParameterRow] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._turn = Paced(self._publish_rows, _PUBLISH_PERIOD)

    def close(self) -> None:
        """Cancel requests, and destroy the clients."""
        self._turn.cancel()
        for task in self._tasks:
            task.cancel()
        self._client.destroy()

    def refresh(self) -> None:
        """Request all parameters again."""
        self._run(self._refresh())

    def apply_event(self, event: Any) -> None:
        """Apply the node's rcl_interfaces/msg/ParameterEvent to the known parameters."""
        for parameter in event.deleted_parameters:
            self._rows.pop(parameter.name, None)
        for parameter in event.changed_parameters:
            row = self._rows.get(parameter.name)
            if row is not None:
                row.kind, row.values = value_texts(parameter.value)
        if any(parameter.name not in self._rows for parameter in event.new_parameters):
            self.refresh()
        elif self.known is not None:
            self._turn.ask()

    def set(self, request: SetParameter, answer: Callable[[ParameterResult], None]) -> None:
        """Set a parameter, and call `answer` with the result."""
        self._run(self._set(request, answer))

    def dump(self, answer: Callable[[ParameterDump], None]) -> None:
        """Call `answer` with a parameter file that contains all parameters."""
        self._run(self._dump(answer))

    def _run(self, work: Any) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _refresh(self) -> None:
        try:
            names = await self._names()
            values = (await self._answer(self._client.get_parameters(names))).values if names else []
            descriptors = (await self._answer(self._client.describe_parameters(names))).descriptors if names else []
        except NoAnswerError as error:
            self.known = NodeParameters(self.name, [], str(error))
            self._publish(self.known)
            return
        pairs = zip(descriptors, values, strict=False)
        self._rows = {descriptor.name: parameter_row(descriptor, value) for descriptor, value in pairs}
        self._publish_rows()

    def _publish_rows(self) -> None:
        self.known = NodeParameters(self.name, [self._rows[name] for name in sorted(self._rows)], None)
        self._publish(self.known)

    async def _set(self, request: SetParameter, answer: Callable[[ParameterResult], None]) -> None:
        try:
            await services_ready(self._client)
            response = await self._answer(self._client.set_parameters([parameter_of(request)]))
        except (ValueError, NoAnswerError) as error:
            answer(ParameterResult(self.name, request.name, False, str(error)))
            return
        result = response.results[0]
        answer(ParameterResult(self.name, request.name, result.successful, result.reason))

    async def _dump(self, answer: Callable[[ParameterDump], None]) -> None:
        file = f"{self.name.strip('/').replace('/', '__')}.yaml"
        try:
            names = await self._names()
            values = (await self._answer(self._client.get_parameters(names))).values if names else []
        except NoAnswerError as error:
            answer(ParameterDump(self.name, file, "", str(error)))
            return
        plain = {name: plain_value(value) for name, value in zip(names, values, strict=False)}
        answer(ParameterDump(self.name, file, parameter_file_text(self.name, plain), None))

    async def _names(self) -> list[str]:
        await services_ready(self._client)
        return sorted((await self._answer(self._client.list_parameters())).result.names)

    async def _answer(self, future: Awaitable[Any]) -> Any:
        return await answer(self._client, future)


_EVENTS = "/parameter_events"
_LIST = "/list_parameters"


@dataclass(slots=True)
class _Request:
    listed: bool
    node: str | None
    sent: ParameterNodes | None = None


class ParametersFeature(PageFeature):
    """Shows pages the parameters of nodes, and sets them."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._requests: dict[Page, _Request] = {}
        self._nodes: dict[str, RemoteNode] = {}
        self._events: TopicTap | None = None

    def receive(self, page: Page, message: WatchParameters | SetParameter | DumpParameters) -> None:
        """Handle a request; a page can set and dump the parameters only of a node that it watches."""
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

    def page_closed(self, page: Page) -> None:
        """Discard the page's requests, and close the clients that no other page needs."""
        if self._requests.pop(page, None) is not None:
            self._update_subscriptions()

    def close(self) -> None:
        """Close all clients and subscriptions."""
        self._requests.clear()
        self._update_subscriptions()

    def _watch(self, page: Page, message: WatchParameters) -> None:
        name = message.node
        known = self._nodes.get(name) if name is not None else None
        if name is not None and known is None:
            try:
                self._nodes[name] = RemoteNode(self.context.node, name, self._publish)
            except LinkwrightError as error:
                page.send(NodeParameters(name, [], error.diagnostics[0].message))
                name = None
        self._requests[page] = _Request(message.listed, name)
        self._update_subscriptions()
        if message.listed:
            self._send_lists()
        if known is None and name is not None:
            self._nodes[name].refresh()
        elif known is not None and known.known is not None:
            page.send(known.known)

    def _update_subscriptions(self) -> None:
        """Open the clients and subscriptions that pages need, and close all others."""
        requests = self._requests.values()
        names = {request.node for request in requests if request.node is not None}
        for name in self._nodes.keys() - names:
            self._nodes.pop(name).close()
        if names and self._events is None:
            self._events = TopicTap(self.context, _EVENTS, self._receive)
        elif not names and self._events is not None:
            self._events.close()
            self._events = None
        if any(request.listed for request in requests):
            self.context.graph_changes.watch(self._send_lists)
        else:
            self.context.graph_changes.unwatch(self._send_lists)

    def _receive(self, event: Any, _: MessageInfo) -> None:
        node = self._nodes.get(event.node)
        if node is not None:
            node.apply_event(event)

    def _publish(self, parameters: NodeParameters) -> None:
        for page, request in self._requests.items():
            if request.node == parameters.node:
                page.send(parameters)

    def _send_lists(self) -> None:
        services = (name for name, _ in self.context.node.get_service_names_and_types())
        listed = ParameterNodes([name.removesuffix(_LIST) for name in services if name.endswith(_LIST)])
        for page, request in self._requests.items():
            if request.listed and request.sent != listed:
                back = self._reappeared_node(request, listed)
                request.sent = listed
                page.send(listed)
                if back is not None:
                    back.refresh()

    def _reappeared_node(self, request: _Request, listed: ParameterNodes) -> RemoteNode | None:
        """Return the node that the page watches if it was not in the list sent before, or None."""
        if (
            request.sent is None
            or request.node is None
            or request.node in request.sent.nodes
            or request.node not in listed.nodes
        ):
            return None
        return self._nodes[request.node]
