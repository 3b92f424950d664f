"""The rclpy node of a launch (``launch_ros.ros_adapters``)."""

from __future__ import annotations

import os
import threading
from collections.abc import Sequence
from typing import Any

from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.event_handlers import OnShutdown

_SPIN_S = 0.2


class ROSAdapter:
    """An rclpy node with an executor that spins in a thread.

    Args:
        argv: the arguments of the rclpy context.
        autostart: whether the node is started immediately.
    """

    def __init__(self, *, argv: Sequence[str] | None = None, autostart: bool = True) -> None:
        self._argv = argv
        self._context: Any = None
        self._node: Any = None
        self._executor: Any = None
        self._thread: threading.Thread | None = None
        self._running = False
        if autostart:
            self.start()

    def start(self) -> None:
        """Create the node, and spin it in a thread.

        Raises:
            RuntimeError: the node is already running.
        """
        if self._running:
            raise RuntimeError("Cannot start a ROS adapter that is already running")
        import rclpy  # type: ignore[import-not-found, unused-ignore]  # a stand-in, or a real ROS 2
        from rclpy.executors import SingleThreadedExecutor  # type: ignore[import-not-found, unused-ignore]  # as above

        self._context = rclpy.context.Context()
        rclpy.init(args=self._argv, context=self._context)
        self._node = rclpy.create_node(f"launch_ros_{os.getpid()}", context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._running = True
        self._thread = threading.Thread(target=self._spin, name="launch_ros-spin")
        self._thread.start()

    def shutdown(self) -> None:
        """Stop spinning, and destroy the node.

        Raises:
            RuntimeError: the node is not running.
        """
        if not self._running:
            raise RuntimeError("Cannot shutdown a ROS adapter that is not running")
        import rclpy

        self._running = False
        self._executor.wake()
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join()
        self._executor.shutdown()
        self._node.destroy_node()
        rclpy.shutdown(context=self._context)
        self._node = self._thread = None

    @property
    def argv(self) -> Sequence[str] | None:
        """The arguments of the rclpy context, or None for the arguments of the process."""
        return self._argv

    @property
    def ros_context(self) -> Any:
        """The rclpy context of the node."""
        return self._context

    @property
    def ros_node(self) -> Any:
        """The node, or None while it is not running."""
        return self._node

    @property
    def ros_executor(self) -> Any:
        """The executor of the node."""
        return self._executor

    def _spin(self) -> None:
        while self._running:
            self._executor.spin_once(timeout_sec=_SPIN_S)


def get_ros_adapter(context: LaunchContext) -> ROSAdapter:
    """Return the adapter of a launch.

    The adapter is created on first use and shut down with the launch.
    """
    try:
        adapter: ROSAdapter = context.locals.ros_adapter
    except AttributeError:
        adapter = ROSAdapter(argv=context.argv)
        context.extend_globals({"ros_adapter": adapter})
        context.register_event_handler(OnShutdown(on_shutdown=lambda *_: adapter.shutdown()))
    return adapter


def get_ros_node(context: LaunchContext) -> Any:
    """Return the node of a launch's adapter."""
    return get_ros_adapter(context).ros_node
