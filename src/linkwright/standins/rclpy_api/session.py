"""The functions of the package ``rclpy`` itself: beginning, ending, spinning."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Any

from linkwright.graph.faults import NotInitializedError, RclError
from linkwright.graph.future import Future
from linkwright.standins.rclpy_api.context import Context
from linkwright.standins.rclpy_api.signals import (
    SignalHandlerOptions,
    install_signal_handlers,
    uninstall_signal_handlers,
)

if TYPE_CHECKING:
    from typing_extensions import Self

    from linkwright.graph import Graph
    from linkwright.standins.rclpy_api.executors import Executor
    from linkwright.standins.rclpy_api.node import Node

_lock = threading.RLock()


class _Defaults:
    """What stands in for arguments that are left out."""

    context: Context | None = None
    executor: Executor | None = None


class InitContextManager:
    """What `init` gives: entered, it shuts the context down at the end of the block.

    Attributes:
        context: the context that was initialised.
    """

    def __init__(self, context: Context) -> None:
        self.context = context

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        if self.context is _Defaults.context:
            try_shutdown()
        else:
            self.context.try_shutdown()


def get_default_context(*, shutting_down: bool = False) -> Context:
    """The context of everything that is given none; a new one after the old one was shut down.

    Args:
        shutting_down: forget it; the next call gives a new one.

    Raises:
        RclError: there is none to be shut down.
    """
    with _lock:
        if shutting_down:
            if _Defaults.context is None:
                raise RclError(
                    "Context must be initialized before it can be shutdown: rclpy.init() has not been called"
                )
            context, _Defaults.context = _Defaults.context, None
            return context
        if _Defaults.context is None:
            _Defaults.context = Context()
        return _Defaults.context


def init(
    *,
    args: Sequence[str] | None = None,
    context: Context | None = None,
    domain_id: int | None = None,
    signal_handler_options: SignalHandlerOptions | None = None,
) -> InitContextManager:
    """Begin; before this there are no nodes.

    Args:
        args: the command line; ``sys.argv`` when None.
        context: what is initialised; the default context when None.
        domain_id: the network's domain; that of ROS_DOMAIN_ID, else 0, when None.
        signal_handler_options: which signals shut it down; all for the default context, else none, when None.

    Raises:
        RuntimeError: it was initialised already.
    """
    chosen = get_default_context() if context is None else context
    if signal_handler_options is None:
        signal_handler_options = SignalHandlerOptions.ALL if context is None else SignalHandlerOptions.NO
    install_signal_handlers(signal_handler_options)
    chosen.init(args, domain_id=domain_id)
    return InitContextManager(chosen)


def use_graph(graph: Graph, args: Sequence[str]) -> Context:
    """Begin with a graph that is there already, as `linkwright.testing` does; it is closed with the context.

    Args:
        graph: the graph in which the nodes of the default context are.
        args: the command line.

    Raises:
        RuntimeError: the default context was initialised already.
    """
    with _lock:
        if _Defaults.context is not None and _Defaults.context.ok():
            raise RuntimeError("rclpy.init() has been called already")
        context = _Defaults.context = Context(graph)
    context.init(args, initialize_logging=False)
    return context


def ok(*, context: Context | None = None) -> bool:
    """Whether the program is to go on: `init` was called, and nothing has ended it since."""
    return (get_default_context() if context is None else context).ok()


def shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """End what `init` began.

    Args:
        context: what is shut down; the default context when None.
        uninstall_handlers: whether signals are handled as before `init` again; when None, with the default context.

    Raises:
        RclError: it is not initialised, or shut down already.
    """
    _end_global_executor(context)
    is_default = context is None or context is _Defaults.context
    (get_default_context(shutting_down=True) if is_default else context).shutdown()  # type: ignore[union-attr]
    if uninstall_handlers or (uninstall_handlers is None and is_default):
        uninstall_signal_handlers()


def try_shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """As `shutdown`, but it does nothing where there is nothing to shut down."""
    is_default = context is None or context is _Defaults.context
    if is_default and _Defaults.context is None:
        return
    if is_default:
        _end_global_executor(context)
        get_default_context(shutting_down=True).try_shutdown()
    elif context is not None:
        context.try_shutdown()
    if uninstall_handlers or (uninstall_handlers is None and is_default):
        uninstall_signal_handlers()


def get_global_executor() -> Executor:
    """The executor of everything that is given none; it belongs to the default context."""
    with _lock:
        if _Defaults.executor is None:
            from linkwright.standins.rclpy_api.executors import SingleThreadedExecutor

            _Defaults.executor = SingleThreadedExecutor()
        return _Defaults.executor


def create_node(node_name: str, **arguments: Any) -> Node:
    """A node; see `Node` for the arguments.

    Raises:
        NotInitializedError: its context is not initialised.
    """
    from linkwright.standins.rclpy_api.node import Node

    return Node(node_name, **arguments)


def spin_once(node: Node, *, executor: Executor | None = None, timeout_sec: float | None = None) -> None:
    """Wait for one callback of a node and run it.

    Args:
        node: the node.
        executor: what runs it; the global executor when None.
        timeout_sec: the longest wait, in seconds; no limit when None.
    """
    runner = get_global_executor() if executor is None else executor
    added = runner.add_node(node)
    try:
        runner.spin_once(timeout_sec=timeout_sec)
    finally:
        # Within a callback of the node it is the executor's already, and is to stay so.
        if added is not False:
            runner.remove_node(node)


def spin(node: Node, executor: Executor | None = None) -> None:
    """Run the callbacks of a node until its context is shut down.

    Args:
        node: the node.
        executor: what runs them; the global executor when None.
    """
    runner = get_global_executor() if executor is None else executor
    added = runner.add_node(node)
    try:
        runner.spin()
    finally:
        # Within a callback of the node it is the executor's already, and is to stay so.
        if added is not False:
            runner.remove_node(node)


def spin_until_future_complete(
    node: Node, future: Future[Any], executor: Executor | None = None, timeout_sec: float | None = None
) -> None:
    """Run the callbacks of a node until a future is done.

    Args:
        node: the node.
        future: what is waited for.
        executor: what runs them; the global executor when None.
        timeout_sec: the longest wait, in seconds; no limit when None.
    """
    runner = get_global_executor() if executor is None else executor
    added = runner.add_node(node)
    try:
        runner.spin_until_future_complete(future, timeout_sec)
    finally:
        # Within a callback of the node it is the executor's already, and is to stay so.
        if added is not False:
            runner.remove_node(node)


def check_initialized(context: Context, what: str) -> None:
    """Raise NotInitializedError unless a context is ok."""
    if not context.ok():
        raise NotInitializedError(what)


def _end_global_executor(context: Context | None) -> None:
    with _lock:
        executor = _Defaults.executor
        if executor is None or (context is not None and executor.context is not context):
            return
        _Defaults.executor = None
    executor.shutdown(0)
