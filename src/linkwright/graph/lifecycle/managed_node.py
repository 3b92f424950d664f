"""Managed nodes: nodes whose lifecycle other nodes can control, as in ``rclpy.lifecycle``."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, joined, phrase
from linkwright.graph.faults import RclError
from linkwright.graph.lifecycle.entities import LifecyclePublisher, ManagedEntity
from linkwright.graph.lifecycle.states import (
    ACTIVATING,
    CLEANINGUP,
    CONFIGURING,
    DEACTIVATING,
    ERRORPROCESSING,
    SHUTTINGDOWN,
    STATES,
    TRANSITIONS,
    LifecycleState,
    StateMachine,
    Transition,
    TransitionCallbackReturn,
)

if TYPE_CHECKING:
    from linkwright.graph.loop.node_handle import CallbackGroup

_CALLBACKS = {
    CONFIGURING: "on_configure",
    CLEANINGUP: "on_cleanup",
    SHUTTINGDOWN: "on_shutdown",
    ACTIVATING: "on_activate",
    DEACTIVATING: "on_deactivate",
    ERRORPROCESSING: "on_error",
}


class LifecycleTransitionError(LinkwrightError, RclError):
    """Raised when a requested transition cannot start from the node's current state.

    The wording of the message is rcl's.
    """

    def __init__(self, requested: object, state: LifecycleState, available: Iterable[str]) -> None:
        names = list(dict.fromkeys(available))
        hint = did_you_mean(str(requested), names) or (
            phrase("the transitions from this state are {names}", names=joined(names)) if names else None
        )
        text = phrase(
            "Transition is not registered: No transition matching {transition} found for current state {label}",
            transition=requested,
            label=state.label,
        )
        super().__init__(Diagnostic("GRAPH231", text, hint=hint))


class LifecycleNodeMixin(ManagedEntity):
    """A mixin that turns a node class into a managed node class.

    Initialize the mixin after the node. The callbacks ``on_configure``, ``on_activate``, ``on_deactivate``,
    ``on_cleanup``, ``on_shutdown`` and ``on_error`` receive the state in which the transition starts, and return a
    `TransitionCallbackReturn`. Unless overridden, each callback calls the callback of the same name of every managed
    entity.

    Args:
        enable_communication_interface: whether other nodes can control the node through services, and receive its
            transition events.
        callback_group: the callback group of the services.
    """

    def __init__(
        self, *, enable_communication_interface: bool = True, callback_group: CallbackGroup | None = None
    ) -> None:
        self._state_machine = StateMachine()
        self._managed_entities: list[ManagedEntity] = []
        self._transition_events: Any = None
        if not enable_communication_interface:
            return
        node: Any = self
        name = node.get_name()
        self._transition_events = node.create_publisher(
            _get_message_class("TransitionEvent"), f"{name}/transition_event", 10
        )
        for service, type_name, callback in (
            ("change_state", "ChangeState", self._on_change_state),
            ("get_state", "GetState", self._on_get_state),
            ("get_available_states", "GetAvailableStates", self._on_get_available_states),
            ("get_available_transitions", "GetAvailableTransitions", self._on_get_available_transitions),
            ("get_transition_graph", "GetAvailableTransitions", self._on_get_transition_graph),
        ):
            server = node.create_service(
                _get_service_class(type_name), f"{name}/{service}", callback, callback_group=callback_group
            )
            setattr(self._state_machine, f"service_{service}", server)

    @property
    def lifecycle_state(self) -> LifecycleState:
        """The current state of the node."""
        return self._state_machine.state

    def trigger_configure(self) -> TransitionCallbackReturn:
        """Configure the node.

        Raises:
            LifecycleTransitionError: the node cannot be configured in its current state.
        """
        return self._change_by_label("configure")

    def trigger_cleanup(self) -> TransitionCallbackReturn:
        """Clean the node up. See `trigger_configure`."""
        return self._change_by_label("cleanup")

    def trigger_activate(self) -> TransitionCallbackReturn:
        """Activate the node. See `trigger_configure`."""
        return self._change_by_label("activate")

    def trigger_deactivate(self) -> TransitionCallbackReturn:
        """Deactivate the node. See `trigger_configure`."""
        return self._change_by_label("deactivate")

    def trigger_shutdown(self) -> TransitionCallbackReturn:
        """Shut the node down. See `trigger_configure`."""
        return self._change_by_label("shutdown")

    def add_managed_entity(self, entity: ManagedEntity) -> None:
        """Register an entity that is notified of the node's transitions."""
        if entity not in self._managed_entities:
            self._managed_entities.append(entity)

    def create_lifecycle_publisher(self, *args: Any, **kwargs: Any) -> Any:
        """Create a publisher that publishes only while the node is active.

        The arguments are those of ``create_publisher``, except ``publisher_class``.

        Raises:
            TypeError: ``publisher_class`` is given.
        """
        if "publisher_class" in kwargs:
            raise TypeError("create_publisher() got an unexpected keyword argument 'publisher_class'")
        node: Any = self
        publisher = node.create_publisher(*args, **kwargs, publisher_class=LifecyclePublisher)
        self.add_managed_entity(publisher)
        return publisher

    def destroy_lifecycle_publisher(self, publisher: LifecyclePublisher) -> Any:
        """Destroy a lifecycle publisher, and stop notifying it of transitions."""
        if publisher in self._managed_entities:
            self._managed_entities.remove(publisher)
        node: Any = self
        return node.destroy_publisher(publisher)

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Configure the managed entities."""
        return self._call_entities(lambda entity: entity.on_configure(state))

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Clean up the managed entities."""
        return self._call_entities(lambda entity: entity.on_cleanup(state))

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Shut down the managed entities."""
        return self._call_entities(lambda entity: entity.on_shutdown(state))

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Activate the managed entities."""
        return self._call_entities(lambda entity: entity.on_activate(state))

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Deactivate the managed entities."""
        return self._call_entities(lambda entity: entity.on_deactivate(state))

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Handle an error in a transition.

        SUCCESS leads back to the unconfigured state; any other return value finalizes the node.
        """
        return self._call_entities(lambda entity: entity.on_error(state))

    def _call_entities(
        self, transition: Callable[[ManagedEntity], TransitionCallbackReturn]
    ) -> TransitionCallbackReturn:
        for entity in tuple(self._managed_entities):
            result = transition(entity)
            if result != TransitionCallbackReturn.SUCCESS:
                return result
        return TransitionCallbackReturn.SUCCESS

    def _change_by_label(self, label: str) -> TransitionCallbackReturn:
        transition = self._state_machine.find_by_label(label)
        if transition is None:
            available = [candidate.label for candidate in self._state_machine.available_transitions()]
            raise LifecycleTransitionError(label, self._state_machine.state, available)
        return self._perform(transition)

    def _perform(self, transition: Transition) -> TransitionCallbackReturn:
        """Run the callback of a transition, then the transition that its result triggers.

        If the callback results in an error, the error processing also runs.
        """
        initial = self._state_machine.state
        self._enter_state(transition)
        result = self._run_callback(initial)
        self._end_transition(result)
        if result == TransitionCallbackReturn.ERROR:
            self._end_transition(self._run_callback(initial))
        return result

    def _end_transition(self, result: TransitionCallbackReturn) -> None:
        following_transition = self._state_machine.find_by_label(result.to_label())
        assert following_transition is not None
        self._enter_state(following_transition)

    def _run_callback(self, initial: LifecycleState) -> TransitionCallbackReturn:
        node: Any = self
        name = _CALLBACKS[self._state_machine.state]
        try:
            result = getattr(self, name)(initial)
        except Exception:  # noqa: BLE001  # the error state handles errors of callbacks
            node.get_logger().error(f"{name} failed:\n{traceback.format_exc().rstrip()}")
            return TransitionCallbackReturn.ERROR
        if isinstance(result, TransitionCallbackReturn):
            return result
        node.get_logger().error(
            f"{name} returned {result!r}; it must return TransitionCallbackReturn.SUCCESS, FAILURE or ERROR"
        )
        return TransitionCallbackReturn.ERROR

    def _enter_state(self, transition: Transition) -> None:
        self._state_machine.state = transition.goal
        if self._transition_events is None:
            return
        node: Any = self
        event = self._transition_events.msg_type()
        event.timestamp = max(0, node.get_clock().now().nanoseconds)
        event.transition.id, event.transition.label = transition.transition_id, transition.label
        event.start_state.label, event.start_state.id = transition.start
        event.goal_state.label, event.goal_state.id = transition.goal
        self._transition_events.publish(event)

    def _on_change_state(self, request: Any, response: Any) -> Any:
        requested = request.transition
        machine = self._state_machine
        transition = machine.find_by_label(requested.label) if requested.label else machine.find_by_id(requested.id)
        if transition is None or transition.start.state_id >= CONFIGURING.state_id:
            node: Any = self
            available = [candidate.label for candidate in machine.available_transitions()]
            error = LifecycleTransitionError(requested.label or requested.id, machine.state, available)
            node.get_logger().warning(str(error))
            response.success = False
            return response
        response.success = self._perform(transition) == TransitionCallbackReturn.SUCCESS
        return response

    def _on_get_state(self, _request: Any, response: Any) -> Any:
        response.current_state.label, response.current_state.id = self._state_machine.state
        return response

    def _on_get_available_states(self, _request: Any, response: Any) -> Any:
        state_class = _get_message_class("State")
        response.available_states = [state_class(id=state.state_id, label=state.label) for state in STATES]
        return response

    def _on_get_available_transitions(self, _request: Any, response: Any) -> Any:
        response.available_transitions = [
            _to_description_message(candidate) for candidate in self._state_machine.available_transitions()
        ]
        return response

    def _on_get_transition_graph(self, _request: Any, response: Any) -> Any:
        response.available_transitions = [_to_description_message(transition) for transition in TRANSITIONS]
        return response


def _to_description_message(transition: Transition) -> Any:
    message = _get_message_class("TransitionDescription")()
    message.transition.id, message.transition.label = transition.transition_id, transition.label
    message.start_state.label, message.start_state.id = transition.start
    message.goal_state.label, message.goal_state.id = transition.goal
    return message


def _get_message_class(name: str) -> Any:
    from linkwright.messages import get_message

    return get_message(f"lifecycle_msgs/msg/{name}")


def _get_service_class(name: str) -> Any:
    from linkwright.messages import get_service

    return get_service(f"lifecycle_msgs/srv/{name}")
