"""The exceptions of the graph, modelled on those of rclpy."""

from __future__ import annotations


class RclError(RuntimeError):
    """An error that the C library below rclpy would report (rclpy ``RCLError``)."""


class InvalidHandleError(RuntimeError):
    """A destroyed object is used (rclpy ``InvalidHandle``)."""

    def __init__(self, text: str = "cannot use Destroyable because destruction was requested") -> None:
        super().__init__(text)


class InterruptedWaitError(Exception):
    """A wait or sleep was ended because the graph is closed (rclpy ``ROSInterruptException``)."""

    def __init__(self, text: str = "rclpy.shutdown() has been called") -> None:
        super().__init__(text)


class NodeNotFoundError(RclError):
    """There is no node of a name (rclpy ``NodeNameNonExistentError``)."""

    def __init__(self, name: str, namespace: str) -> None:
        super().__init__(f"Cannot get the names and types of node '{name}' in namespace '{namespace}': there is none")
        self.name = name
        self.namespace = namespace


class NotInitializedError(Exception):
    """A call needs a context, which is not initialised, or was shut down; name and text are rclpy's."""

    def __init__(self, message: str | None = None) -> None:
        text = "rclpy.init() has not been called."
        super().__init__(f"{text[:-1]}. msg:{message}" if message else text)


class TimeoutException(Exception):  # noqa: N818  # rclpy's name
    """The time given has passed."""


class ShutdownException(Exception):  # noqa: N818  # rclpy's name
    """The executor was shut down."""


class ExternalShutdownException(Exception):  # noqa: N818  # rclpy's name
    """The context was shut down, by a signal for one."""


class ConditionReachedException(Exception):  # noqa: N818  # rclpy's name
    """The condition that was waited for holds."""
