"""The session of one client: its requests, and what they have created."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Callable, Coroutine
from dataclasses import dataclass
from enum import IntEnum
from functools import partial
from typing import Any

from linkwright.bridge.rosbridge import bson
from linkwright.bridge.rosbridge.actions import OfferedAction, SentGoal
from linkwright.bridge.rosbridge.encodings import MessageEncoder
from linkwright.bridge.rosbridge.fragments import Fragments, split_message
from linkwright.bridge.rosbridge.globs import Globs
from linkwright.bridge.rosbridge.offers import Offers
from linkwright.bridge.rosbridge.publications import Publications
from linkwright.bridge.rosbridge.requests import Request, RequestError, split_numbered_name
from linkwright.bridge.rosbridge.services import OfferedService, ServiceCalls
from linkwright.bridge.rosbridge.subscriptions import Settings, TopicSubscription
from linkwright.bridge.rosbridge.values import to_json_values
from linkwright.bridge.websockets.clients import Client
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import GoalStatus, Node

_MAX_TASKS = 64
"""The maximum number of pending calls and goals of one client."""

_MAX_NAMES = 1000
"""The maximum number of topics, services and actions of one client."""

_MAX_LOGGED_ERRORS = 20
_FRAGMENT = "fragment"


class StatusLevel(IntEnum):
    """The levels of status messages. A client receives those of its level, and those above it."""

    INFO = 0
    WARNING = 1
    ERROR = 2
    NONE = 3


@dataclass(slots=True)
class Limits:
    """The limits of a session.

    Attributes:
        message_size: the maximum number of characters of a message of the client, and of a message to it that is not
            sent in fragments.
        fragment_timeout_s: the seconds after which fragments of an incomplete message are dropped.
    """

    message_size: int
    fragment_timeout_s: float


@dataclass(slots=True)
class SharedResources:
    """The parts of the node that the sessions of all clients share.

    Attributes:
        bson_only: whether clients send and receive BSON instead of JSON.
        services: the services that clients offer.
        actions: the actions that clients offer.
    """

    node: Node
    limits: Limits
    publications: Publications
    calls: ServiceCalls
    encoder: MessageEncoder
    topic_globs: Globs
    service_globs: Globs
    services: Offers[OfferedService]
    actions: Offers[OfferedAction]
    bson_only: bool = False

    def read_time(self) -> Any:
        """Return the time of the node's clock as a message."""
        return self.node.get_clock().now().to_msg()


class Session:
    """The session of one client.

    Args:
        resources: what the sessions share.
        client: the connection.
    """

    def __init__(self, resources: SharedResources, client: Client) -> None:
        loop = asyncio.get_running_loop()
        limits = resources.limits
        self._resources = resources
        self._client = client
        self._node = resources.node
        self._level = StatusLevel.ERROR
        self._fragment_size = limits.message_size
        self._fragments = Fragments(limits.fragment_timeout_s, limits.message_size, loop.time)
        self._subscriptions: dict[str, TopicSubscription] = {}
        self._advertised: dict[str, set[Any]] = {}
        self._goals: dict[Any, SentGoal] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._logged_errors = 0
        self._operations: dict[str, Callable[[Request], None]] = {
            "advertise": self._advertise,
            "unadvertise": self._unadvertise,
            "publish": self._publish,
            "subscribe": self._subscribe,
            "unsubscribe": self._unsubscribe,
            "call_service": self._call_service,
            "advertise_service": self._advertise_service,
            "unadvertise_service": self._unadvertise_service,
            "service_response": self._respond,
            "send_action_goal": self._send_goal,
            "cancel_action_goal": self._cancel_goal,
            "advertise_action": self._advertise_action,
            "unadvertise_action": self._unadvertise_action,
            "action_feedback": self._send_feedback,
            "action_result": self._end_goal,
            "set_level": self._set_level,
            _FRAGMENT: self._add_fragment,
        }

    def receive(self, message: str | bytes) -> None:
        """Handle a message of the client. An error is sent back as a status."""
        identity = None
        try:
            request = _parse(message, self._resources)
            identity = request.identity
            self._handle(request)
        except Exception as error:  # noqa: BLE001 - no message of a client may end the node
            self.send_status(StatusLevel.ERROR, _describe(error), identity)

    def on_graph_changed(self) -> None:
        """Fit the subscriptions to the publishers."""
        for subscription in self._subscriptions.values():
            subscription.refit()

    def send_status(self, level: StatusLevel, text: str, identity: Any = None) -> None:
        """Send a status to the client if it asks for such ones, and log an error."""
        if level is StatusLevel.ERROR and self._logged_errors < _MAX_LOGGED_ERRORS:
            self._logged_errors += 1
            self._node.get_logger().error(f"A client of rosbridge: {text[:500]}")
        if level >= self._level:
            status = {"op": "status", "level": level.name.lower(), "msg": text}
            self._send(status if identity is None else {**status, "id": identity})

    def close(self) -> None:
        """Remove everything that the client has created."""
        for task in self._tasks:
            task.cancel()
        for subscription in self._subscriptions.values():
            subscription.close()
        for topic in self._advertised:
            self._resources.publications.close(self, topic, is_lost=True)
        self._subscriptions.clear()
        self._advertised.clear()
        self._resources.services.withdraw_all(self)
        self._resources.actions.withdraw_all(self)

    # --- messages ----------------------------------------------------------------------------------------------

    def _handle(self, request: Request) -> None:
        operation = request.get("op")
        if operation is None:
            raise RequestError(f"Received a message without an op. It must be one of {', '.join(self._operations)}.")
        handle = self._operations.get(operation) if isinstance(operation, str) else None
        if handle is None:
            raise RequestError(
                f"Unknown operation: {str(operation)[:60]}. Allowed operations: {', '.join(self._operations)}"
            )
        try:
            handle(request)
        except (RequestError, LinkwrightError) as error:
            raise RequestError(f"{operation}: {_describe(error)}") from None

    def _send(self, message: dict[str, Any], fragment_size: int | None = None) -> None:
        if self._resources.bson_only:
            self._client.send(bson.encode(message))
            return
        size = self._fragment_size if fragment_size is None else fragment_size
        for frame in split_message(json.dumps(message, default=to_json_values), size, message.get("id")):
            self._client.send(frame)

    def _add_fragment(self, request: Request) -> None:
        text = self._fragments.add(request)
        if text is None:
            return
        whole = _parse(text, self._resources)
        if whole.get("op") == _FRAGMENT:
            raise RequestError("fragments of fragments are not supported")
        self.receive(text)

    def _set_level(self, request: Request) -> None:
        name = request.read("level", str).upper()
        if name not in StatusLevel.__members__:
            raise RequestError("Expected field level to be one of info, warning, error, none.")
        self._level = StatusLevel[name]

    def _run(self, call: Coroutine[Any, Any, None]) -> None:
        if len(self._tasks) >= _MAX_TASKS:
            call.close()
            raise RequestError("too many calls and goals at once")
        task = asyncio.get_running_loop().create_task(call)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    # --- topics ----------------------------------------------------------------------------------------------

    def _check_topic(self, topic: str) -> None:
        if not self._resources.topic_globs.match(topic):
            raise RequestError(f"topic {topic[:200]} is not allowed by topics_glob")
        if len(self._subscriptions) + len(self._advertised) >= _MAX_NAMES:
            raise RequestError(f"a client may use at most {_MAX_NAMES} topics")

    def _advertise(self, request: Request) -> None:
        topic = request.read("topic", str)
        self._check_topic(topic)
        self._resources.publications.open(
            self,
            topic,
            request.read("type", str),
            latches=request.read("latch", bool, False),
            queue_size=request.read_count("queue_size") or 100,
        )
        self._advertised.setdefault(topic, set()).add(request.identity)

    def _unadvertise(self, request: Request) -> None:
        topic = request.read("topic", str)
        identities = self._advertised.get(topic)
        if identities is None:
            self.send_status(StatusLevel.WARNING, f"topic {topic[:200]} was not advertised", request.identity)
            return
        identities.discard(request.identity)
        if not identities or request.identity is None:
            del self._advertised[topic]
            self._resources.publications.close(self, topic)

    def _publish(self, request: Request) -> None:
        topic = request.read("topic", str)
        if topic not in self._advertised:
            self._check_topic(topic)
        shared = self._resources.publications.open(
            self,
            topic,
            None,
            latches=request.read("latch", bool, False),
            queue_size=request.read_count("queue_size") or 100,
        )
        self._advertised.setdefault(topic, set())
        self._resources.publications.publish(self, shared, request.get("msg", {}))

    def _subscribe(self, request: Request) -> None:
        topic, type_name = request.read("topic", str), request.read("type", str, "") or None
        settings = Settings.of(request)
        self._check_topic(topic)
        subscription = self._subscriptions.get(topic)
        if subscription is None:
            subscription = TopicSubscription(
                self._node, topic, type_name, self._client, self._resources.encoder, self._fragment_size
            )
            subscription.add(request.identity, settings)
            self._subscriptions[topic] = subscription
        else:
            subscription.check_type(type_name)
            subscription.add(request.identity, settings)
        self.send_status(StatusLevel.INFO, f"Subscribed to {topic}", request.identity)

    def _unsubscribe(self, request: Request) -> None:
        topic = request.read("topic", str)
        subscription = self._subscriptions.get(topic)
        if subscription is None:
            self.send_status(StatusLevel.WARNING, f"topic {topic[:200]} was not subscribed to", request.identity)
            return
        subscription.remove(request.identity)
        if not subscription.has_requests:
            del self._subscriptions[topic]
            subscription.close()
        self.send_status(StatusLevel.INFO, f"Unsubscribed from {topic}", request.identity)

    # --- services --------------------------------------------------------------------------------------------

    def _check_service(self, service: str) -> None:
        if not self._resources.service_globs.match(service):
            raise RequestError(f"service {service[:200]} is not allowed by services_glob")

    def _call_service(self, request: Request) -> None:
        service, identity = split_numbered_name(request.read("service", str), request.identity)
        response = {"op": "service_response", "service": request.read("service", str)}
        fragment_size = request.read_count("fragment_size") or None
        timeout_s = request.get("timeout")
        if timeout_s is not None and (isinstance(timeout_s, bool) or not isinstance(timeout_s, (int, float))):
            raise RequestError("Expected field timeout to be a number.")

        async def call() -> dict[str, Any]:
            self._check_service(service)
            values = await self._resources.calls.call(service, request.get("args"), timeout_s)
            return {**response, "values": values, "result": True}

        failure = {**response, "result": False}
        self._run(self._answer(call, failure, identity, fragment_size, "call_service"))

    async def _answer(
        self,
        call: Callable[[], Awaitable[dict[str, Any]]],
        failure: dict[str, Any],
        identity: Any,
        fragment_size: int | None,
        operation: str,
    ) -> None:
        """Send the message that a call returns, or that it has failed."""
        try:
            message = await call()
        except Exception as error:  # noqa: BLE001 - an error of a service or action is the client's answer
            text = _describe(error)
            self.send_status(StatusLevel.ERROR, f"{operation}: {text}", identity)
            message = {**failure, "values": text}
        if identity is not None:
            message["id"] = identity
        self._send(message, fragment_size)

    def _advertise_service(self, request: Request) -> None:
        name = request.read("service", str)
        self._check_service(name)
        create = partial(
            OfferedService, self._node, name, request.read("type", str), self._send, self._resources.read_time
        )
        self._resources.services.add(self, name, create)
        self.send_status(StatusLevel.INFO, f"Advertised service {name}", request.identity)

    def _unadvertise_service(self, request: Request) -> None:
        self._resources.services.withdraw(self, request.read("service", str))

    def _respond(self, request: Request) -> None:
        self._resources.services.find(self, request.read("service", str)).respond(request)

    # --- actions ---------------------------------------------------------------------------------------------

    def _send_goal(self, request: Request) -> None:
        action, identity = split_numbered_name(request.read("action", str), request.identity)
        goal = SentGoal(self._node, action, request.read("action_type", str))
        response = {"action": request.read("action", str)} | ({} if identity is None else {"id": identity})
        fragment_size = request.read_count("fragment_size") or None

        def send_feedback(values: dict[str, Any]) -> None:
            self._send({"op": "action_feedback", **response, "values": values}, fragment_size)

        async def run() -> dict[str, Any]:
            on_feedback = send_feedback if request.read("feedback", bool, False) else None
            try:
                values, status = await goal.run(request.get("args"), self._resources.read_time, on_feedback)
            finally:
                if self._goals.get(identity) is goal:
                    del self._goals[identity]
            return {"op": "action_result", **response, "values": values, "status": status, "result": True}

        failure = {"op": "action_result", **response, "status": int(GoalStatus.UNKNOWN), "result": False}
        self._run(self._answer(run, failure, identity, fragment_size, "send_action_goal"))
        self._goals[identity] = goal

    def _cancel_goal(self, request: Request) -> None:
        _, identity = split_numbered_name(request.read("action", str), request.identity)
        goal = self._goals.get(identity)
        if goal is None:
            raise RequestError(f"there is no goal with the id {str(identity)[:200]}")
        goal.cancel()

    def _advertise_action(self, request: Request) -> None:
        name = request.read("action", str)
        create = partial(
            OfferedAction, self._node, name, request.read("type", str), self._send, self._resources.read_time
        )
        self._resources.actions.add(self, name, create)
        self.send_status(StatusLevel.INFO, f"Advertised action {name}", request.identity)

    def _unadvertise_action(self, request: Request) -> None:
        self._resources.actions.withdraw(self, request.read("action", str))

    def _send_feedback(self, request: Request) -> None:
        self._resources.actions.find(self, request.read("action", str)).send_feedback(request)

    def _end_goal(self, request: Request) -> None:
        self._resources.actions.find(self, request.read("action", str)).end_goal(request)


def _parse(message: str | bytes, resources: SharedResources) -> Request:
    """Return the request that a message contains.

    Raises:
        RequestError: the message is too long, or is not a JSON object or BSON document.
    """
    max_size = resources.limits.message_size
    if len(message) > max_size:
        raise RequestError(f"the message is longer than max_message_size ({max_size} bytes)")
    form = "BSON" if resources.bson_only and isinstance(message, bytes) else "JSON"
    try:
        values = bson.decode(message) if isinstance(message, bytes) and form == "BSON" else json.loads(message)
    except (ValueError, RecursionError) as error:
        raise RequestError(f"the message is not {form}: {str(error)[:200]}") from None
    if not isinstance(values, dict):
        raise RequestError("the message is not a JSON object")
    identity = values.get("id")
    if not (identity is None or isinstance(identity, (str, int))):
        raise RequestError("Expected field id to be a text or an integer.")
    return Request(values)


def _describe(error: Exception) -> str:
    if isinstance(error, LinkwrightError):
        return error.diagnostics[0].message
    return str(error) if isinstance(error, RequestError) else f"{type(error).__name__}: {str(error)[:200]}"
