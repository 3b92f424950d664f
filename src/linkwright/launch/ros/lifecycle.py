"""Lifecycle nodes of a launch.

The launcher requests and monitors their transitions.
"""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import phrase
from linkwright.launch.errors.locations import error_at
from linkwright.launch.model import events
from linkwright.launch.model.actions import EmitEvent, OpaqueFunction, RegisterEventHandler
from linkwright.launch.model.event_handlers import EventHandler
from linkwright.launch.model.markup.expose import expose_action
from linkwright.launch.model.process_event_handlers import OnProcessStart
from linkwright.launch.ros.deprecated_arguments import with_deprecated_arguments
from linkwright.launch.ros.lifecycle_events import (
    STATES,
    TRANSITIONS,
    ChangeState,
    OnStateTransition,
    StateTransition,
)
from linkwright.launch.ros.node import Node

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linkwright.launch.model.action import Action
    from linkwright.launch.model.context import LaunchContext
    from linkwright.launch.model.markup.entity import Entity, Parser

_CONFIGURE_TRANSITION, _ACTIVATE_TRANSITION = 1, 3
_POLL_INTERVAL_S = 0.2
_QUEUE_DEPTH = 10


class LifecycleEventManager:
    """A monitor of a lifecycle node, which also requests the node's transitions.

    The manager emits a `StateTransition` event after each transition, and handles `ChangeState` events.

    Args:
        lifecycle_node: the action or description of the node; its ``node_name`` is the full name.
    """

    def __init__(self, lifecycle_node: Any) -> None:
        self._node = lifecycle_node
        self._client: Any = None
        self.current_state = STATES[0]

    @property
    def node_name(self) -> str:
        """The node's full name."""
        return str(self._node.node_name)

    def setup_lifecycle_manager(self, context: LaunchContext) -> None:
        """Start monitoring the node and handling requests for its transitions."""
        launcher = context.session.host.launcher_node
        launcher.create_subscription(
            "lifecycle_msgs/msg/TransitionEvent",
            f"{self.node_name}/transition_event",
            lambda message: self._handle_transition(context, message),
            _QUEUE_DEPTH,
        )
        self._client = launcher.create_client("lifecycle_msgs/srv/ChangeState", f"{self.node_name}/change_state")
        context.register_event_handler(
            EventHandler(
                matcher=lambda event: isinstance(event, ChangeState),
                entities=[OpaqueFunction(function=self._handle_request)],
            )
        )

    def _handle_transition(self, context: LaunchContext, message: Any) -> None:
        self.current_state = STATES.get(message.goal_state.id, STATES[0])
        context.emit_event_sync(StateTransition(action=self._node, msg=message))

    def _handle_request(self, context: LaunchContext) -> None:
        event = context.locals.event
        if event.lifecycle_node_matcher(self._node):
            context.session.spawn(self._change_state(context, event.transition_id))

    async def _change_state(self, context: LaunchContext, transition_id: int) -> None:
        request = self._client.srv_type.Request()
        request.transition.id = transition_id
        response = await call_service(context, self._client, request)
        if response is not None and not response.success:
            name = TRANSITIONS[transition_id]
            text = f"Failed to make transition '{name}' for LifecycleNode '{self.node_name}'"
            context.session.log.write_error("launch_ros.actions.lifecycle_node", text)


async def call_service(context: LaunchContext, client: Any, request: Any) -> Any:
    """Wait until a service is available, call it, and return the response.

    Returns:
        The response, or None if the launch ends before the response arrives.
    """
    future = client.call_async(request)
    while not future.done():
        if context.is_shutdown:
            missing_part = "service response" if client.service_is_ready() else "service"
            text = f"Abandoning wait for the '{client.srv_name}' {missing_part}, due to shutdown."
            context.session.log.write_warning("launch_ros", text)
            client.remove_pending_request(future)
            return None
        await _wait_briefly(future)
    return future.result()


async def _wait_briefly(future: Any) -> None:
    """Wait for a future for a short time, so that the caller can check for a shutdown."""
    loop = asyncio.get_running_loop()
    wake_up = loop.create_future()

    def wake(_: Any = None) -> None:
        if not wake_up.done():
            wake_up.set_result(None)

    future.add_done_callback(lambda _: loop.call_soon_threadsafe(wake))
    handle = loop.call_later(_POLL_INTERVAL_S, wake)
    try:
        await wake_up
    finally:
        handle.cancel()


@expose_action("lifecycle_node")
@with_deprecated_arguments(node_executable="executable", node_name="name", node_namespace="namespace")
class LifecycleNode(Node):
    """An action that starts a lifecycle node, and monitors its state.

    Args:
        name: the node's name.
        namespace: the node's namespace.
        autostart: whether the node is configured and activated when it has started.
        kwargs: see `Node`.
    """

    is_lifecycle_node = True

    def __init__(self, *, name: Any, namespace: Any, autostart: Any = False, **kwargs: Any) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self.__autostart = autostart
        self.__manager = LifecycleEventManager(self)

    @classmethod
    def parse(
        cls, entity: Entity, parser: Parser, ignore: Sequence[str] | None = None
    ) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag."""
        _, kwargs = super().parse(entity, parser, ignore)
        autostart = entity.get_attr("autostart", data_type=bool, optional=True)
        if autostart is not None:
            kwargs["autostart"] = parser.parse_if_substitutions(autostart)
        return cls, kwargs

    @property
    def node_autostart(self) -> Any:
        """Whether the node is configured and activated when it has started."""
        return self.__autostart

    @property
    def current_state(self) -> str:
        """The name of the last state that the node reported."""
        return self.__manager.current_state

    def execute(self, context: LaunchContext) -> list[Any] | None:
        """Start the node and the monitoring of its state, and return the entities to visit next.

        Raises:
            LinkwrightError: see `Node.execute`.
        """
        if context.is_shutdown:
            return None
        self._expand_names(context)
        self.__manager.setup_lifecycle_manager(context)
        next_entities = list(super().execute(context) or [])
        if is_autostarted(context, self.__autostart):
            next_entities += create_autostart_actions(self)
        return next_entities


def is_autostarted(context: LaunchContext, value: Any) -> bool:
    """Return whether the argument ``autostart`` of a lifecycle node evaluates to true."""
    from linkwright.launch.model.markup.values import normalize_typed_substitution, perform_typed_substitution

    return bool(perform_typed_substitution(context, normalize_typed_substitution(value, bool), bool))


def create_autostart_actions(action: Any) -> list[Any]:
    """Return actions that configure and activate a lifecycle node after its start.

    The node is configured when it has started, and activated when it has been configured.
    """
    change_actions = {
        transition_id: EmitEvent(
            event=ChangeState(lifecycle_node_matcher=events.matches_action(action), transition_id=transition_id)
        )
        for transition_id in (_CONFIGURE_TRANSITION, _ACTIVATE_TRANSITION)
    }
    on_configured = OnStateTransition(
        target_lifecycle_node=action,
        start_state="configuring",
        goal_state="inactive",
        entities=[change_actions[_ACTIVATE_TRANSITION]],
    )
    return [
        RegisterEventHandler(OnProcessStart(target_action=action, on_start=[change_actions[_CONFIGURE_TRANSITION]])),
        RegisterEventHandler(on_configured),
    ]


def unknown_transition_error(location: Any, text: str) -> Exception:
    """Return the error for a transition ID that is not a number."""
    message = phrase("expected integer for lifecycle transition, got {text}", text=text)
    return error_at(location, "LAUNCH138", message, ros_error=ValueError(message))
