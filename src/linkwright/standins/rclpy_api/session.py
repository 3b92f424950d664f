"""The functions of the package ``rclpy`` for initialization, shutdown and spinning."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Any

from linkwright.graph.loop.future import Future
from linkwright.standins.rclpy_api.context import Context
from linkwright.standins.rclpy_api.defaults import get_default_context, has_default_context, is_default
from linkwright.standins.rclpy_api.executors import Executor, SingleThreadedExecutor
from linkwright.standins.rclpy_api.node import Node
from linkwright.standins.rclpy_api.signals import (
    SignalHandlerOptions,
    install_signal_handlers,
    uninstall_signal_handlers,
)
from linkwright.standins.rclpy_api.state import current_state

if TYPE_CHECKING:
    from typing_extensions import Self

_lock = threading.RLock()


class InitContextManager:
    """The result of `init`, a context manager that shuts the context down on exit.

    Attributes:
        context: the context that was initialized.
    """

    def __init__(self, context: Context) -> None:
        self.context = context

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        try_shutdown(context=self.context)


def init(
    *,
    args: Sequence[str] | None = None,
    context: Context | None = None,
    domain_id: int | None = None,
    signal_handler_options: SignalHandlerOptions | None = None,
) -> InitContextManager:
    """Initialize a context.

    Nodes can be created only afterwards.

    Args:
        args: the command line; None for ``sys.argv``.
        context: the context to initialize; None for the default context.
        domain_id: the domain ID of the network; None for the value of ROS_DOMAIN_ID, or 0 if the variable is not set.
        signal_handler_options: the signals that shut contexts down. None means all signals if `context` is None, or
            else no signals.

    Raises:
        RuntimeError: the context is already initialized.
    """
    target_context = get_default_context() if context is None else context
    if signal_handler_options is None:
        signal_handler_options = SignalHandlerOptions.ALL if context is None else SignalHandlerOptions.NO
    install_signal_handlers(signal_handler_options)
    state = current_state()
    state.signal_options = SignalHandlerOptions(state.signal_options | signal_handler_options)
    target_context.init(args, domain_id=domain_id)
    return InitContextManager(target_context)


def ok(*, context: Context | None = None) -> bool:
    """Return whether a context is initialized and not shut down."""
    return (get_default_context() if context is None else context).ok()


def shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """Shut a context down.

    Args:
        context: the context to shut down; None for the default context.
        uninstall_handlers: whether to restore the previous signal handlers; None to do so for the default context only.

    Raises:
        RclError: the context is not initialized, or already shut down.
    """
    _end_global_executor(context)
    is_default_context = is_default(context)
    target_context = get_default_context(shutting_down=True) if context is None or is_default_context else context
    target_context.shutdown()
    if uninstall_handlers or (uninstall_handlers is None and is_default_context):
        uninstall_signal_handlers()


def try_shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """Shut a context down, unless it is not initialized or already shut down."""
    is_default_context = is_default(context)
    if is_default_context and not has_default_context():
        return
    if is_default_context:
        _end_global_executor(context)
        get_default_context(shutting_down=True).try_shutdown()
    elif context is not None:
        context.try_shutdown()
    if uninstall_handlers or (uninstall_handlers is None and is_default_context):
        uninstall_signal_handlers()


def get_global_executor() -> Executor:
    """Return the global executor of the default context."""
    with _lock:
        state = current_state()
        if state.executor is None:
            state.executor = SingleThreadedExecutor()
        executor: Executor = state.executor
        return executor


def create_node(node_name: str, **arguments: Any) -> Node:
    """Create a node. See `Node` for the arguments.

    Raises:
        NotInitializedError: the node's context is not initialized.
    """
    return Node(node_name, **arguments)


def spin_once(node: Node, *, executor: Executor | None = None, timeout_sec: float | None = None) -> None:
    """Run one callback of a node, and wait for it if necessary.

    Args:
        node: the node whose callbacks are run.
        executor: the executor; None for the global executor.
        timeout_sec: the maximum time to wait, in seconds; None for no limit.
    """
    runner = get_global_executor() if executor is None else executor
    was_added = runner.add_node(node)
    try:
        runner.spin_once(timeout_sec=timeout_sec)
    finally:
        # If a callback of the node calls this function, the node already belongs to the executor and must not be
        # removed.
        if was_added is not False:
            runner.remove_node(node)


def spin(node: Node, executor: Executor | None = None) -> None:
    """Run the callbacks of a node until its context is shut down.

    Args:
        node: the node whose callbacks are run.
        executor: the executor; None for the global executor.
    """
    runner = get_global_executor() if executor is None else executor
    was_added = runner.add_node(node)
    try:
        runner.spin()
    finally:
        # If a callback of the node calls this function, the node already belongs to the executor and must not be
        # removed.
        if was_added is not False:
            runner.remove_node(node)


def spin_until_future_complete(
    node: Node, future: Future[Any], executor: Executor | None = None, timeout_sec: float | None = None
) -> None:
    """Run the callbacks of a node until a future is done.

    Args:
        node: the node whose callbacks are run.
        future: the future to wait for.
        executor: the executor; None for the global executor.
        timeout_sec: the maximum time to wait, in seconds; None for no limit.
    """
    runner = get_global_executor() if executor is None else executor
    was_added = runner.add_node(node)
    try:
        runner.spin_until_future_complete(future, timeout_sec)
    finally:
        # If a callback of the node calls this function, the node already belongs to the executor and must not be
        # removed.
        if was_added is not False:
            runner.remove_node(node)


def _end_global_executor(context: Context | None) -> None:
    with _lock:
        state = current_state()
        executor = state.executor
        if executor is None or (context is not None and executor.context is not context):
            return
        state.executor = None
    executor.shutdown(0)
