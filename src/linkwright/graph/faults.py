"""The exceptions of the graph, modeled on rclpy's."""

from __future__ import annotations


class RclError(RuntimeError):
    """An error that the C library rcl below rclpy would report (rclpy ``RCLError``)."""


class InvalidHandleError(RuntimeError):
    """Raised when a destroyed object is used (rclpy ``InvalidHandle``)."""

    def __init__(self, text: str = "cannot use Destroyable because destruction was requested") -> None:
        super().__init__(text)


class InterruptedWaitError(Exception):
    """Raised when closing the graph ends a wait or sleep (rclpy ``ROSInterruptException``)."""

    def __init__(self, text: str = "rclpy.shutdown() has been called") -> None:
        super().__init__(text)


class NodeNotFoundError(RclError):
    """Raised when no node has the given name (rclpy ``NodeNameNonExistentError``)."""

    def __init__(self, name: str, namespace: str) -> None:
        super().__init__(f"Cannot get the names and types of node '{name}' in namespace '{namespace}': no such node")
        self.name = name
        self.namespace = namespace


class NotInitializedError(Exception):
    """Raised when a call needs a context that is not initialized or was shut down.

    At run time it has the class name and message of rclpy's exception.
    """

    def __init__(self, message: str | None = None) -> None:
        text = "rclpy.init() has not been called."
        super().__init__(f"{text[:-1]}. msg:{message}" if message else text)


class TimeoutException(Exception):  # noqa: N818  # rclpy's name
    """Raised when a wait exceeds its timeout."""


class ShutdownException(Exception):  # noqa: N818  # rclpy's name
    """Raised when the executor was shut down."""


class ExternalShutdownException(Exception):  # noqa: N818  # rclpy's name
    """Raised when the context was shut down, for example by a signal."""


class ConditionReachedException(Exception):  # noqa: N818  # rclpy's name
    """Raised when the condition that ends a wait is true."""
