"""std_msgs: the header of stamped messages, and plain text."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from linkwright.messages.time import Time


@dataclass(slots=True)
class Header:
    """When, and in which frame, the data of a message was taken."""

    TYPE_NAME: ClassVar[str] = "std_msgs/msg/Header"

    stamp: Time = field(default_factory=Time)
    frame_id: str = ""


@dataclass(slots=True)
class String:
    """A text; the topic ``robot_description`` carries one."""

    TYPE_NAME: ClassVar[str] = "std_msgs/msg/String"

    data: str = ""
