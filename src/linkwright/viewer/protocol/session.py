"""The connection itself."""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.record import record


@record
class Hello:
    """First message on every connection."""

    protocol: int
    version: str
    title: str
    type: Literal["hello"] = "hello"


@record
class Received:
    """How many messages of this connection the page has; sent after the first one and after each large one."""

    count: int
    type: Literal["received"] = "received"
