"""Action servers: accept goals, execute them, and publish feedback, status and results."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from functools import partial
from inspect import isawaitable
from typing import Any

from linkwright.graph.actions.base import ActionEndpoint
from linkwright.graph.actions.goal import (
    ACTIVE_STATES,
    CANCELABLE_STATES,
    CancelResponse,
    GoalEvent,
    GoalResponse,
    GoalStatus,
    ServerGoalHandle,
)
from linkwright.graph.loop.dispatcher import Entity
from linkwright.graph.loop.node_handle import FREE_GROUP, CallbackGroup, NodeHandle
from linkwright.graph.loop.timer import Timer
from linkwright.graph.node import Node
from linkwright.graph.qos.profile import ACTION_STATUS_QOS, DEFAULT_QOS, SERVICES_QOS, QoSProfile
from linkwright.graph.time.values import Time
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

ERROR_NONE, ERROR_REJECTED, ERROR_UNKNOWN_GOAL_ID, ERROR_GOAL_TERMINATED = range(4)
"""The return codes of a cancel request (action_msgs/srv/CancelGoal)."""


def default_goal_callback(goal_request: Any) -> GoalResponse:  # noqa: ARG001  # a callback's signature
    """Accept every goal."""
    return GoalResponse.ACCEPT


def default_handle_accepted_callback(goal_handle: ServerGoalHandle) -> None:
    """Execute the goal immediately."""
    goal_handle.execute()


def default_cancel_callback(cancel_request: ServerGoalHandle) -> CancelResponse:  # noqa: ARG001
    """Refuse every request to cancel."""
    return CancelResponse.REJECT


async def await_result(value: Any) -> Any:
    """Return a callback's return value, after awaiting it if it is awaitable."""
    return await value if isawaitable(value) else value


class ActionServer(ActionEndpoint):
    """The server of an action (rclpy ``ActionServer``).

    The server consists of three services and two topics below ``NAME/_action/``. Callbacks may be coroutine functions.
    An execute callback that is not a coroutine function runs in the dispatcher's thread and blocks other callbacks
    there.

    Args:
        node: the node that owns the server.
        action_type: the action's class or type name.
        action_name: relative, absolute or private name.
        execute_callback: called with the handle of a goal to execute; returns the result.
        callback_group: the group of the callbacks below; goals are executed outside all groups.
        goal_callback: called with a goal; decides whether it is accepted.
        handle_accepted_callback: called with the handle of an accepted goal; starts its execution, now or later.
        cancel_callback: called with the handle of a goal whose cancellation was requested; decides whether to cancel
            it.
        goal_service_qos_profile: the QoS of the service that accepts goals.
        result_service_qos_profile: the QoS of the service that returns results.
        cancel_service_qos_profile: the QoS of the service that cancels goals.
        feedback_pub_qos_profile: the QoS of the feedback topic.
        status_pub_qos_profile: the QoS of the status topic.
        result_timeout: how many seconds a goal's result is kept after its end; negative to keep it forever.

    Raises:
        TypeError: the execute callback is not callable, or the type is not an action type.
        InvalidServiceNameError: the name is not valid.
    """

    def __init__(
        self,
        node: Node,
        action_type: Any,
        action_name: str,
        execute_callback: Callable[[ServerGoalHandle], Any],
        *,
        callback_group: CallbackGroup | None = None,
        goal_callback: Callable[[Any], Any] | None = default_goal_callback,
        handle_accepted_callback: Callable[[ServerGoalHandle], Any] | None = default_handle_accepted_callback,
        cancel_callback: Callable[[ServerGoalHandle], Any] | None = default_cancel_callback,
        goal_service_qos_profile: QoSProfile = SERVICES_QOS,
        result_service_qos_profile: QoSProfile = SERVICES_QOS,
        cancel_service_qos_profile: QoSProfile = SERVICES_QOS,
        feedback_pub_qos_profile: QoSProfile = DEFAULT_QOS,
        status_pub_qos_profile: QoSProfile = ACTION_STATUS_QOS,
        result_timeout: float = 900,
    ) -> None:
        from linkwright.messages import get_message

        super().__init__(node, action_type, action_name)
        self.register_execute_callback(execute_callback)
        self.register_goal_callback(goal_callback)
        self.register_handle_accepted_callback(handle_accepted_callback)
        self.register_cancel_callback(cancel_callback)
        self._result_timeout_ns = round(result_timeout * NANOSECONDS_PER_SECOND)
        self._lock = threading.RLock()
        self._goal_handles: dict[bytes, ServerGoalHandle] = {}
        self._goal_info = get_message("action_msgs/msg/GoalInfo")
        self._goal_status = get_message("action_msgs/msg/GoalStatus")
        self._expiry_timer: Timer | None = None
        self._execution_queue = self._handle.add(_ExecutionQueue(self._handle))
        impl = self._action_type.Impl
        self._services = [
            node.create_service(
                service_type, self._full_name(name), callback, qos_profile=qos, callback_group=group, replying=True
            )
            for service_type, name, callback, qos, group in (
                (impl.SendGoalService, "send_goal", self._on_goal, goal_service_qos_profile, callback_group),
                (impl.CancelGoalService, "cancel_goal", self._on_cancel, cancel_service_qos_profile, callback_group),
                (impl.GetResultService, "get_result", self._on_result, result_service_qos_profile, FREE_GROUP),
            )
        ]
        self._feedback_publisher = node.create_publisher(
            impl.FeedbackMessage, self._full_name("feedback"), feedback_pub_qos_profile
        )
        self._status = node.create_publisher(impl.GoalStatusMessage, self._full_name("status"), status_pub_qos_profile)
        self._handle.add_cleanup(self.destroy)

    def register_execute_callback(self, execute_callback: Callable[[ServerGoalHandle], Any]) -> None:
        """Set the callback that executes goals.

        Raises:
            TypeError: `execute_callback` is not callable.
        """
        if not callable(execute_callback):
            raise TypeError("Failed to register goal execution callback: not callable")
        self._execute_callback = execute_callback

    def register_goal_callback(self, goal_callback: Callable[[Any], Any] | None) -> None:
        """Set the callback that decides which goals are accepted.

        None accepts all goals.
        """
        self._goal_callback = goal_callback or default_goal_callback

    def register_handle_accepted_callback(
        self, handle_accepted_callback: Callable[[ServerGoalHandle], Any] | None
    ) -> None:
        """Set the callback that starts the execution of accepted goals.

        None starts the execution immediately.
        """
        self._handle_accepted_callback = handle_accepted_callback or default_handle_accepted_callback

    def register_cancel_callback(self, cancel_callback: Callable[[ServerGoalHandle], Any] | None) -> None:
        """Set the callback that decides which goals may be canceled.

        None refuses all requests.
        """
        self._cancel_callback = cancel_callback or default_cancel_callback

    def destroy(self) -> None:
        """Remove the server from the graph, and drop unfinished goals.

        A second call does nothing.
        """
        with self._lock:
            if self._destroyed:
                return
            self._destroyed = True
            goals = list(self._goal_handles.values())
            self._goal_handles.clear()
        for goal in goals:
            goal.retire()
        for entity in (*self._services, self._feedback_publisher, self._status, self._execution_queue):
            entity.destroy()
        if self._expiry_timer is not None:
            self._expiry_timer.destroy()
        self._handle.remove_cleanup(self.destroy)

    # --- called by goal handles --------------------------------------------------------------------------------------

    def start_execution(self, goal: ServerGoalHandle, callback: Callable[[ServerGoalHandle], Any] | None) -> None:
        """Schedule the execution of a goal."""
        if not self._destroyed:
            self._execution_queue.add(partial(self._execute, callback or self._execute_callback, goal))

    def publish_feedback(self, goal_id: Any, feedback: Any) -> None:
        """Publish the feedback of a goal."""
        if not self._destroyed:
            message = self._action_type.Impl.FeedbackMessage()
            message.goal_id = goal_id
            message.feedback = feedback
            self._feedback_publisher.publish(message)

    def on_goal_state_change(self, goal: ServerGoalHandle) -> None:
        """Publish the states of all goals.

        If the goal has ended, start the timeout of its result.
        """
        if GoalStatus(goal.status) not in ACTIVE_STATES:
            goal.ended_ns = self._node.get_clock().now_ns()
            self._start_expiry_timer()
        self._publish_status()

    def remove_goal(self, goal: ServerGoalHandle) -> None:
        """Remove a goal from the server."""
        with self._lock:
            self._goal_handles.pop(bytes(goal.goal_id.uuid), None)

    # --- the services ------------------------------------------------------------------------------------------------

    async def _on_goal(self, request: Any, reply: Callable[[Any], None]) -> None:
        logger = self._handle.logger
        uuid = bytes(request.goal_id.uuid)
        logger.debug(f"New goal request with ID: {request.goal_id.uuid}")
        response = self._action_type.Impl.SendGoalService.Response()
        goal = None
        if uuid not in self._goal_handles:
            decision = await await_result(self._goal_callback(request.goal))
            if not isinstance(decision, GoalResponse):
                logger.warning("Goal request callback did not return a GoalResponse type. Rejecting goal.")
            elif decision is GoalResponse.ACCEPT:
                goal = self._accept(request)
                response.accepted = True
                response.stamp = goal.goal_info.stamp
        reply(response)
        if goal is None:
            logger.debug(f"New goal rejected: {request.goal_id.uuid}")
            return
        logger.debug(f"New goal accepted: {request.goal_id.uuid}")
        self._publish_status()
        await await_result(self._handle_accepted_callback(goal))

    def _accept(self, request: Any) -> ServerGoalHandle:
        info = self._goal_info()
        info.goal_id = request.goal_id
        info.stamp = self._node.get_clock().now().to_msg()
        goal = ServerGoalHandle(self, info, request.goal)
        with self._lock:
            self._goal_handles[bytes(request.goal_id.uuid)] = goal
        return goal

    async def _on_cancel(self, request: Any, reply: Callable[[Any], None]) -> None:
        response = self._action_type.Impl.CancelGoalService.Response()
        response.return_code, goals = self._find_goals_to_cancel(request.goal_info)
        canceling = []
        for goal in goals:
            decision = await await_result(self._cancel_callback(goal))
            if decision is CancelResponse.ACCEPT and GoalStatus(goal.status) in CANCELABLE_STATES:
                goal.update(GoalEvent.CANCEL_GOAL)
                canceling.append(goal.goal_info)
        if goals and not canceling:
            response.return_code = ERROR_REJECTED
        response.goals_canceling = canceling
        reply(response)

    def _find_goals_to_cancel(self, info: Any) -> tuple[int, list[ServerGoalHandle]]:
        """Return the preliminary return code of a cancel request, and the goals that it may cancel.

        As in rcl_action's ``process_cancel_request``:

        - An ID selects that goal.
        - A stamp selects all goals that were accepted up to that time.
        - An ID with a stamp selects that goal and all goals that were accepted up to that time.
        - A request with neither selects all goals.
        """
        uuid = bytes(info.goal_id.uuid)
        has_id = any(uuid)
        stamp_ns = info.stamp.sec * NANOSECONDS_PER_SECOND + info.stamp.nanosec
        with self._lock:
            goals = list(self._goal_handles.values())
            requested_goal = self._goal_handles.get(uuid)
        if has_id and not stamp_ns:
            if requested_goal is None:
                return ERROR_UNKNOWN_GOAL_ID, []
            if GoalStatus(requested_goal.status) not in CANCELABLE_STATES:
                return ERROR_GOAL_TERMINATED, []
            return ERROR_NONE, [requested_goal]
        return ERROR_NONE, [
            goal
            for goal in goals
            if GoalStatus(goal.status) in CANCELABLE_STATES
            and (goal is requested_goal or not stamp_ns or Time.from_msg(goal.goal_info.stamp).nanoseconds <= stamp_ns)
        ]

    def _on_result(self, request: Any, reply: Callable[[Any], None]) -> None:
        goal = self._goal_handles.get(bytes(request.goal_id.uuid))
        if goal is None:
            self._handle.logger.debug(f"Sending result response for unknown goal ID: {request.goal_id.uuid}")
            response = self._action_type.Impl.GetResultService.Response()
            response.status = int(GoalStatus.UNKNOWN)
            reply(response)
            return
        goal.result.add_done_callback(lambda future: reply(future.result()))

    # --- execution ---------------------------------------------------------------------------------------------------

    async def _execute(self, callback: Callable[[ServerGoalHandle], Any], goal: ServerGoalHandle) -> None:
        result = None
        try:
            result = await await_result(callback(goal))
        except Exception as error:  # noqa: BLE001  # the client of the goal must learn that it failed
            self._execution_queue.report(error)
        result_class = self._action_type.Result
        if self._destroyed:
            return
        if goal.is_active:
            self._handle.logger.warning(f"Goal state not set, assuming aborted. Goal ID: {goal.goal_id.uuid}")
            if GoalStatus(goal.status) is GoalStatus.ACCEPTED:
                goal.update(GoalEvent.EXECUTE)
            goal.abort()
        elif result is None and not goal.result.ended():
            self._handle.logger.warning(
                f"the execute callback of action '{self._action_name}' returned no result: an empty result is sent"
            )
        if result is not None and not isinstance(result, result_class):
            self._handle.logger.error(
                f"the execute callback of action '{self._action_name}' returned {type(result)}, not {result_class}: "
                "an empty result is sent"
            )
            result = None
        goal.set_result(result_class() if result is None else result)

    def _publish_status(self) -> None:
        if self._destroyed:
            return
        message = self._action_type.Impl.GoalStatusMessage()
        with self._lock:
            goals = list(self._goal_handles.values())
        statuses = []
        for goal in goals:
            status = self._goal_status()
            status.goal_info = goal.goal_info
            status.status = goal.status
            statuses.append(status)
        message.status_list = statuses
        self._status.publish(message)

    # --- expiry of results -------------------------------------------------------------------------------------------

    def _start_expiry_timer(self) -> None:
        with self._lock:
            if self._result_timeout_ns < 0 or self._destroyed:
                return
            if self._expiry_timer is None:
                self._expiry_timer = self._node.create_timer(
                    0.0, self._remove_expired_goals, FREE_GROUP, autostart=False
                )
            if self._expiry_timer.is_canceled():
                self._expiry_timer.timer_period_ns = self._result_timeout_ns
                self._expiry_timer.reset()

    def _remove_expired_goals(self) -> None:
        assert self._expiry_timer is not None
        self._expiry_timer.cancel()
        now_ns = self._node.get_clock().now_ns()
        with self._lock:
            expiry_times = {
                uuid: goal.ended_ns + self._result_timeout_ns
                for uuid, goal in self._goal_handles.items()
                if goal.ended_ns is not None
            }
            for uuid, expiry_ns in expiry_times.items():
                if expiry_ns <= now_ns:
                    self._goal_handles.pop(uuid).retire()
            later_expiry_times = [end_ns for end_ns in expiry_times.values() if end_ns > now_ns]
        if later_expiry_times:
            self._expiry_timer.timer_period_ns = min(later_expiry_times) - now_ns
            self._expiry_timer.reset()


class _ExecutionQueue(Entity):
    """The queue of accepted goals whose execution has not started."""

    def __init__(self, node: NodeHandle) -> None:
        super().__init__(node, FREE_GROUP)
        self._waiting: deque[Callable[[], object]] = deque()

    @property
    def description(self) -> str:
        """The description of this entity in log messages."""
        return "execute callback of an action"

    def add(self, call: Callable[[], object]) -> None:
        """Queue a call."""
        self._waiting.append(call)
        self.announce()

    def has_work(self) -> bool:
        """Return whether an execution is queued."""
        return bool(self._waiting)

    def take(self) -> Callable[[], object] | None:
        """Remove the oldest call from the queue and return it, or None if the queue is empty."""
        return self._take_from(self._waiting)
