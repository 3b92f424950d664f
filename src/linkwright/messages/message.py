"""What every message class has."""

from __future__ import annotations

from typing import ClassVar, Protocol


class Message(Protocol):
    """A ROS 2 message: an object with the fields of its ``.msg`` file and the name of its type.

    A published message is handed to every subscriber of the process as it is, without a copy: whoever receives one
    reads it and does not change it.
    """

    TYPE_NAME: ClassVar[str]
    """Package, kind and name, such as ``sensor_msgs/msg/JointState``."""
