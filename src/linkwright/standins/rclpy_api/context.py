"""The lifetime of a program in the graph: from ``rclpy.init`` to ``rclpy.shutdown``."""

from __future__ import annotations

import _thread
import atexit
import inspect
import os
import sys
import threading
import weakref
from collections.abc import Callable, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from linkwright.diagnostics import LinkwrightError, print_diagnostics
from linkwright.graph import Graph
from linkwright.graph.command_line.log_setup import LoggingSetup, set_up_logging
from linkwright.graph.command_line.ros_arguments import RosArguments, parse
from linkwright.graph.faults import RclError
from linkwright.standins.rclpy_api import logging
from linkwright.standins.rclpy_api.errors import RCLInvalidROSArgsError, UnknownROSArgsError
from linkwright.standins.rclpy_api.signals import shut_down_on_signal
from linkwright.standins.rclpy_api.state import current_state

if TYPE_CHECKING:
    from typing_extensions import Self

    from linkwright.graph.loop.timer import Rate
    from linkwright.wire.background import BackgroundTransport

_MAX_JOIN_WAIT_S = 3.0


class Context:
    """A graph with its nodes, from initialization to shutdown.

    A context can be initialized only once.

    Args:
        graph: an existing graph, which is closed with the context.
    """

    def __init__(self, graph: Graph | None = None) -> None:
        self._lock = threading.RLock()
        self._callbacks: list[Callable[[], Callable[[], object] | None]] = []
        self._rates: weakref.WeakSet[Rate] = weakref.WeakSet()
        self._initialized = False
        self._ok = False
        self._was_ended_by_signal = False
        self._domain_id: int | None = None
        self._graph = graph
        self._logging: LoggingSetup | None = None
        self._joining_transport: BackgroundTransport | None = None
        self.ros_arguments = RosArguments()

    @property
    def enable_rosout(self) -> bool:
        """Whether nodes publish their log messages on ``/rosout``.

        The command line can disable this.
        """
        return self.ros_arguments.rosout_logs is not False

    @property
    def handle(self) -> Context | None:
        """The context itself, for ``with context.handle``, or None before initialization."""
        return self if self._initialized else None

    @property
    def graph(self) -> Graph:
        """The graph of the context's nodes, which joins the network on first use by a node."""
        with self._lock:
            if self._graph is None:
                self._graph = self._create_graph()
            return self._graph

    def wait_for_network(self) -> None:
        """Wait until the graph has joined the network.

        Later calls return immediately. Without this wait, DDS would delay the first timers.
        """
        transport, self._joining_transport = self._joining_transport, None
        if transport is not None:
            transport.wait_until_ready(_MAX_JOIN_WAIT_S)

    def init(
        self, args: Sequence[str] | None = None, *, initialize_logging: bool = True, domain_id: int | None = None
    ) -> None:
        """Initialize the context.

        Args:
            args: the command line; None for ``sys.argv``.
            initialize_logging: whether to apply the logging options of the command line.
            domain_id: the domain ID of the network; None for the value of ROS_DOMAIN_ID, or 0 if the variable is not
                set.

        Raises:
            RuntimeError: the domain ID is negative, or the context was initialized before.
            UnknownROSArgsError: there are unknown ROS arguments.
            RCLInvalidROSArgsError: a ROS argument is malformed.
            RclError: security is enforced (``ROS_SECURITY_STRATEGY``), which is not supported.
        """
        if domain_id is not None and domain_id < 0:
            raise RuntimeError(f"Domain id ({domain_id}) should not be lower than zero.")
        joins_network = self._graph is None and current_state().create_graph is None
        if joins_network:
            _check_security()
        with self._lock:
            if self._initialized:
                raise RuntimeError("Context.init() must only be called once")
            self.ros_arguments = read_ros_arguments(sys.argv if args is None else args)
            print_diagnostics([finding for _, finding in self.ros_arguments.parameters.skipped_findings], sys.stderr)
            self._domain_id = domain_id
            if initialize_logging and joins_network and not logging.is_configured():
                self._logging = set_up_logging(self.ros_arguments, Path(sys.argv[0]).stem or "python3", logging.LEVELS)
                logging.write_to(self._logging.sink)
            self._initialized = self._ok = True
        current_state().open_contexts.add(self)
        shut_down_on_signal(self)

    def ok(self) -> bool:
        """Return whether the context is initialized and not shut down."""
        return self._ok

    def get_domain_id(self) -> int:
        """Return the domain ID of the network.

        Raises:
            RuntimeError: the context is not initialized.
        """
        if not self._initialized:
            raise RuntimeError("Context must be initialized before it can have a domain id")
        if self._domain_id is not None:
            return self._domain_id
        text = os.environ.get("ROS_DOMAIN_ID", "")
        return int(text) if text.isdigit() else 0

    def on_shutdown(self, callback: Callable[[], object]) -> None:
        """Register a callback for the shutdown, or call it now if the context is already shut down.

        The context keeps only weak references to bound methods.

        Raises:
            TypeError: `callback` is not callable.
        """
        if not callable(callback):
            raise TypeError(f"callback should be a callable, got {type(callback)}")
        with self._lock:
            if not self._initialized or self._ok:
                callback_reference = weakref.WeakMethod(callback) if inspect.ismethod(callback) else lambda: callback
                self._callbacks.append(callback_reference)
                return
        callback()

    def shutdown(self) -> None:
        """Shut the context down: executors stop spinning, and the nodes leave the graph.

        Raises:
            RclError: the context was not initialized, or was already shut down, possibly by a signal.
        """
        if not self._initialized:
            raise RclError("Context must be initialized before it can be shutdown")
        was_ok = self._ok
        self.try_shutdown()
        if not was_ok:
            raise RclError(
                "failed to shutdown: rcl_shutdown already called on the given context. A signal such as Ctrl-C does "
                "this as well; rclpy.try_shutdown() then raises no error"
            )

    def try_shutdown(self) -> None:
        """Shut the context down, unless it is not initialized or already shut down.

        After a signal, this completes the shutdown: the nodes leave the graph.
        """
        if self._ok or self._was_ended_by_signal:
            self._was_ended_by_signal = False
            self._complete_shutdown()

    def shutdown_by_signal(self) -> None:
        """Stop the executors from a signal handler.

        `try_shutdown` must complete the shutdown later. A signal can arrive at any point of the program, so this method
        does only what is safe in a signal handler.
        """
        if self._ok:
            self._was_ended_by_signal = True
            self._ok = False
            if self._graph is not None:
                for node in self._graph.nodes():
                    node.is_valid = False
            self._notify()
            # Waking needs locks that the interrupted code may hold, and the start of a `threading.Thread` as well.
            _thread.start_new_thread(self._wake_rates, ())

    def wake_on_signal(self, rate: Rate) -> None:
        """Wake the threads that sleep on a rate when a signal shuts the context down.

        The context keeps only a weak reference to the rate.
        """
        with self._lock:
            self._rates.add(rate)

    def destroy(self) -> None:
        """Shut the context down if necessary, like `try_shutdown`."""
        self.try_shutdown()

    def __enter__(self) -> Self:
        if not self._initialized:
            self.init()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.try_shutdown()

    def _complete_shutdown(self) -> None:
        self._ok = False
        self._notify()
        with self._lock:
            graph, self._graph = self._graph, None
        if graph is not None:
            graph.close_threadsafe()
        if self._logging is not None:
            logging.shutdown()
            self._logging.close()
            self._logging = None
        current_state().open_contexts.discard(self)

    def _notify(self) -> None:
        callbacks, self._callbacks = self._callbacks, []
        for callback_reference in callbacks:
            callback = callback_reference()
            if callback is not None:
                callback()

    def _wake_rates(self) -> None:
        with self._lock:
            rates = tuple(self._rates)
        for rate in rates:
            rate.wake()

    def _create_graph(self) -> Graph:
        create_graph = current_state().create_graph
        if create_graph is not None:
            return create_graph()
        from linkwright.wire.joining import join

        graph = Graph(threads=True, on_log=logging.write, levels=logging.LEVELS)
        self._joining_transport = join(graph, domain_id=self._domain_id)
        return graph


def _check_security() -> None:
    from linkwright.wire.joining import check_security

    try:
        check_security()
    except LinkwrightError as error:
        raise RclError(f"failed to initialize rcl: {error}") from error


def read_ros_arguments(arguments: Sequence[str]) -> RosArguments:
    """Parse the ROS arguments of a command line.

    Raises:
        UnicodeEncodeError: an argument is not text.
        UnknownROSArgsError: there are unknown ROS arguments.
        RCLInvalidROSArgsError: a ROS argument is malformed.
    """
    for argument in arguments:
        argument.encode()
    try:
        return parse(arguments)
    except LinkwrightError as error:
        text = str(error)
        if "unknown ROS argument" in text:
            unknown_argument = text.partition("'")[2].partition("'")[0]
            raise UnknownROSArgsError(f"Found unknown ROS arguments: {[unknown_argument]}") from error
        raise RCLInvalidROSArgsError(f"Failed to parse ROS arguments: {list(arguments)}: {text}") from error


def _shut_down_all() -> None:
    for context in tuple(current_state().open_contexts):
        context.try_shutdown()


atexit.register(_shut_down_all)
