"""Action clients: send goals, cancel them, and receive feedback and results."""

from __future__ import annotations

import uuid
import weakref
from collections.abc import Callable
from functools import partial
from inspect import iscoroutinefunction
from types import GenericAlias
from typing import Any

from linkwright.graph.actions.base import ActionEndpoint
from linkwright.graph.actions.goal import ACTIVE_STATES, GoalStatus
from linkwright.graph.endpoints.service import Client
from linkwright.graph.loop.future import Future
from linkwright.graph.loop.node_handle import CallbackGroup
from linkwright.graph.node import Node
from linkwright.graph.qos.profile import ACTION_STATUS_QOS, DEFAULT_QOS, SERVICES_QOS, QoSProfile


class ClientGoalHandle:
    """The client's handle to a goal that it has sent (rclpy ``ClientGoalHandle``).

    Attributes:
        goal_id: the goal's ID (unique_identifier_msgs/msg/UUID).
        accepted: whether the server accepted the goal.
        stamp: when the server accepted the goal (builtin_interfaces/msg/Time).
        status: the goal's latest known state.
    """

    __class_getitem__: Any = classmethod(GenericAlias)  # As in rclpy, annotations may name the action type.

    def __init__(self, action_client: ActionClient, goal_id: Any, goal_response: Any) -> None:
        self._action_client = action_client
        self.goal_id = goal_id
        self.accepted: bool = goal_response.accepted
        self.stamp = goal_response.stamp
        self.status = int(GoalStatus.UNKNOWN)

    def __eq__(self, other: object) -> bool:
        return bytes(self.goal_id.uuid) == bytes(other.goal_id.uuid) if isinstance(other, ClientGoalHandle) else False

    def __hash__(self) -> int:
        return hash(bytes(self.goal_id.uuid))

    def __repr__(self) -> str:
        return f"ClientGoalHandle <id={self.goal_id.uuid}, accepted={self.accepted}, status={self.status}>"

    def cancel_goal(self, timeout_sec: float | None = None) -> Any:
        """Request cancellation of the goal, and block until the server responds.

        Args:
            timeout_sec: the maximum wait, in seconds; None for no limit.

        Returns:
            The action_msgs/srv/CancelGoal response.

        Raises:
            TimeoutError: the response did not arrive in time.
        """
        return _wait_for_result(self.cancel_goal_async(), timeout_sec)

    def cancel_goal_async(self) -> Future[Any]:
        """Request cancellation of the goal.

        Returns:
            A future that gets the action_msgs/srv/CancelGoal response.
        """
        return self._action_client.cancel(self)

    def get_result(self, timeout_sec: float | None = None) -> Any:
        """Request the result, and block until it arrives.

        Args:
            timeout_sec: the maximum wait, in seconds; None for no limit.

        Returns:
            The response with ``status`` and ``result``.

        Raises:
            TimeoutError: the response did not arrive in time.
        """
        return _wait_for_result(self.get_result_async(), timeout_sec)

    def get_result_async(self) -> Future[Any]:
        """Request the result.

        Returns:
            A future that gets the response with ``status`` and ``result``.
        """
        return self._action_client.request_result(self)


class ActionClient(ActionEndpoint):
    """A client that sends goals to an action server (rclpy ``ActionClient``).

    Args:
        node: the node that owns the client.
        action_type: the action's class or type name.
        action_name: relative, absolute or private name.
        callback_group: the group of the feedback callbacks.
        goal_service_qos_profile: the QoS of the service that accepts goals.
        result_service_qos_profile: the QoS of the service that returns results.
        cancel_service_qos_profile: the QoS of the service that cancels goals.
        feedback_sub_qos_profile: the QoS of the feedback subscription.
        status_sub_qos_profile: the QoS of the status subscription.

    Raises:
        TypeError: the type is not an action type.
        InvalidServiceNameError: the name is not valid.
    """

    def __init__(
        self,
        node: Node,
        action_type: Any,
        action_name: str,
        *,
        callback_group: CallbackGroup | None = None,
        goal_service_qos_profile: QoSProfile = SERVICES_QOS,
        result_service_qos_profile: QoSProfile = SERVICES_QOS,
        cancel_service_qos_profile: QoSProfile = SERVICES_QOS,
        feedback_sub_qos_profile: QoSProfile = DEFAULT_QOS,
        status_sub_qos_profile: QoSProfile = ACTION_STATUS_QOS,
    ) -> None:
        from linkwright.messages import get_message

        super().__init__(node, action_type, action_name)
        self._uuid = get_message("unique_identifier_msgs/msg/UUID")
        impl = self._action_type.Impl

        def create_client(service_class: Any, name: str, qos: QoSProfile) -> Client[Any, Any]:
            return node.create_client(
                service_class, self._full_name(name), qos_profile=qos, callback_group=callback_group
            )

        self._goal_client = create_client(impl.SendGoalService, "send_goal", goal_service_qos_profile)
        self._cancel_client = create_client(impl.CancelGoalService, "cancel_goal", cancel_service_qos_profile)
        self._result_client = create_client(impl.GetResultService, "get_result", result_service_qos_profile)
        self._feedback_subscription = node.create_subscription(
            impl.FeedbackMessage,
            self._full_name("feedback"),
            self._on_feedback,
            feedback_sub_qos_profile,
            callback_group=callback_group,
        )
        self._status = node.create_subscription(
            impl.GoalStatusMessage,
            self._full_name("status"),
            self._on_status,
            status_sub_qos_profile,
            callback_group=callback_group,
        )
        self._goal_handles: dict[bytes, weakref.ref[ClientGoalHandle]] = {}
        self._feedback_callbacks: dict[bytes, Callable[[Any], Any]] = {}
        self._handle.add_cleanup(self.destroy)

    def server_is_ready(self) -> bool:
        """Return whether an action server with all its services and topics is available."""
        clients = (self._goal_client, self._cancel_client, self._result_client)
        return all(client.service_is_ready() for client in clients) and all(
            subscription.get_publisher_count() for subscription in (self._feedback_subscription, self._status)
        )

    def wait_for_server(self, timeout_sec: float | None = None) -> bool:
        """Block the calling thread until a server is available, and return whether one is.

        For the timeout see `Client.wait_for_service`.
        """
        return self._handle.graph.wait_until(self.server_is_ready, timeout_sec)

    def send_goal(self, goal: Any, timeout_sec: float | None = None, **options: Any) -> Any:
        """Send a goal, and block the calling thread until its result arrives.

        Another thread must run callbacks in the meantime.

        Args:
            goal: the goal message.
            timeout_sec: how many seconds to wait for the server to accept the goal, and again for the result.
            options: as for `send_goal_async`.

        Returns:
            The response with ``status`` and ``result``; None when the goal was rejected.

        Raises:
            TypeError: `goal` is not a goal message of the action.
            TimeoutError: the server did not respond in time.
        """
        handle = _wait_for_result(self.send_goal_async(goal, **options), timeout_sec)
        return handle.get_result(timeout_sec) if handle.accepted else None

    def send_goal_async(
        self, goal: Any, feedback_callback: Callable[[Any], Any] | None = None, goal_uuid: Any = None
    ) -> Future[ClientGoalHandle]:
        """Send a goal without blocking.

        Args:
            goal: the goal message.
            feedback_callback: called with each feedback message for this goal; its field ``feedback`` contains the
                action's feedback.
            goal_uuid: the goal's ID; a random one by default.

        Returns:
            A future that gets the goal's handle when the server has accepted or rejected it.

        Raises:
            TypeError: `goal` is not a goal message of the action.
        """
        if not isinstance(goal, self._action_type.Goal):
            raise TypeError(f"Expected {self._action_type.Goal}, got {type(goal)}")
        request = self._action_type.Impl.SendGoalService.Request()
        request.goal_id = self._uuid(uuid=list(uuid.uuid4().bytes)) if goal_uuid is None else goal_uuid
        request.goal = goal
        key = bytes(request.goal_id.uuid)
        if feedback_callback is not None:
            self._feedback_callbacks[key] = feedback_callback
        handle_future: Future[ClientGoalHandle] = Future()
        response_future = self._goal_client.call_async(request)
        handle_future.source = self._goal_client
        response_future.add_waiter(partial(self._on_goal_response, response_future, request.goal_id, handle_future))
        return handle_future

    def cancel(self, goal: ClientGoalHandle) -> Future[Any]:
        """Request cancellation of a goal. See `ClientGoalHandle.cancel_goal_async`.

        Raises:
            TypeError: `goal` is not a goal handle.
        """
        _check_handle(goal)
        request = self._action_type.Impl.CancelGoalService.Request()
        request.goal_info.goal_id = goal.goal_id
        return self._cancel_client.call_async(request)

    def request_result(self, goal: ClientGoalHandle) -> Future[Any]:
        """Request the result of a goal. See `ClientGoalHandle.get_result_async`.

        Raises:
            TypeError: `goal` is not a goal handle.
        """
        _check_handle(goal)
        request = self._action_type.Impl.GetResultService.Request()
        request.goal_id = goal.goal_id
        result_future: Future[Any] = Future()
        response_future = self._result_client.call_async(request)
        result_future.source = self._result_client
        response_future.add_waiter(partial(self._on_result, response_future, bytes(goal.goal_id.uuid), result_future))
        return result_future

    def destroy(self) -> None:
        """Remove the client from the graph.

        A second call does nothing. Pending futures stay pending.
        """
        if self._destroyed:
            return
        self._destroyed = True
        clients = (self._goal_client, self._cancel_client, self._result_client)
        for endpoint in (*clients, self._feedback_subscription, self._status):
            endpoint.destroy()
        self._handle.remove_cleanup(self.destroy)

    def _on_goal_response(
        self, response_future: Future[Any], goal_id: Any, handle_future: Future[ClientGoalHandle]
    ) -> None:
        if response_future.cancelled():
            handle_future.cancel()
            return
        handle = ClientGoalHandle(self, goal_id, response_future.result())
        key = bytes(goal_id.uuid)
        if handle.accepted:
            self._goal_handles[key] = weakref.ref(handle)
        else:
            self._feedback_callbacks.pop(key, None)
        handle_future.hand_over(handle, self._handle.dispatcher)

    def _on_result(self, response_future: Future[Any], key: bytes, result_future: Future[Any]) -> None:
        if response_future.cancelled():
            result_future.cancel()
            return
        callback = self._feedback_callbacks.get(key)
        if callback is not None and not iscoroutinefunction(callback):
            # Feedback that was published before the goal ended must be delivered before its result.
            while (call := self._feedback_subscription.take()) is not None:
                call()
        self._feedback_callbacks.pop(key, None)
        result_future.hand_over(response_future.result(), self._handle.dispatcher)

    def _on_feedback(self, message: Any) -> Any:
        callback = self._feedback_callbacks.get(bytes(message.goal_id.uuid))
        return None if callback is None else callback(message)

    def _on_status(self, message: Any) -> None:
        for status in message.status_list:
            key = bytes(status.goal_info.goal_id.uuid)
            reference = self._goal_handles.get(key)
            if reference is None:
                continue
            handle = reference()
            if handle is not None:
                handle.status = status.status
            if handle is None or GoalStatus(status.status) not in ACTIVE_STATES:
                del self._goal_handles[key]


def _check_handle(goal: object) -> None:
    if not isinstance(goal, ClientGoalHandle):
        raise TypeError(f"Expected type ClientGoalHandle but received {type(goal)}")


def _wait_for_result(future: Future[Any], timeout_sec: float | None) -> Any:
    if not future.wait(timeout_sec):
        raise TimeoutError("the action server did not respond in time")
    return future.result()
