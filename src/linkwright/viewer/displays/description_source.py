"""Where a RobotModel display has its description from: a topic of the graph, or a file."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.graph import (
    DurabilityPolicy,
    HistoryPolicy,
    Node,
    QoSProfile,
    ReliabilityPolicy,
)
from linkwright.messages import String
from linkwright.urdf import DescriptionLibrary
from linkwright.viewer.property_store import PropertyStore
from linkwright.viewer.schema import PropertySpec
from linkwright.workspace import PackageFinder

SOURCE = "Description Source"
FILE = "Description File"
TOPIC = "Description Topic"

_SYSTEM_DEFAULT = "System Default"

DESCRIPTION_SPECS = (
    PropertySpec(SOURCE, "enum", "Topic", "Where the description comes from.", options=("Topic", "File")),
    PropertySpec(
        FILE,
        "string",
        "",
        "A URDF or xacro file: a path or a package:// address.",
        when=((SOURCE,), "File"),
    ),
    PropertySpec(
        TOPIC,
        "string",
        "/robot_description",
        "The topic that carries the description, as std_msgs/msg/String.",
        when=((SOURCE,), "Topic"),
        children=(
            PropertySpec("Depth", "int", 1, "How many messages may wait.", minimum=1, maximum=1000),
            PropertySpec(
                "History Policy",
                "enum",
                "Keep Last",
                "Whether only the last messages wait, or all.",
                options=("Keep Last", "Keep All", _SYSTEM_DEFAULT),
            ),
            PropertySpec(
                "Reliability Policy",
                "enum",
                "Reliable",
                "Whether every message must arrive.",
                options=("Reliable", "Best Effort", _SYSTEM_DEFAULT),
            ),
            PropertySpec(
                "Durability Policy",
                "enum",
                "Transient Local",
                "Whether a description published before counts too. It always does here: most files say Volatile, "
                "and then it would be chance whether the robot is seen.",
                options=("Volatile", "Transient Local", _SYSTEM_DEFAULT),
            ),
        ),
    ),
)


class DescriptionSource:
    """Follows the source that a display's properties name.

    Args:
        node: to subscribe with.
        library: told of files read, so that the robot knows its places in them.
        finder: for ``package://`` addresses and xacro's ``$(find)``.
        properties: of the display, with `DESCRIPTION_SPECS`.
        on_text: called with each description.
        on_refusal: called with what is wrong when there is none to be had.
    """

    def __init__(
        self,
        node: Node,
        library: DescriptionLibrary,
        finder: PackageFinder,
        properties: PropertyStore,
        on_text: Callable[[str], None],
        on_refusal: Callable[[Sequence[Diagnostic]], None],
    ) -> None:
        self._node = node
        self._library = library
        self._finder = finder
        self._properties = properties
        self._on_text = on_text
        self._on_refusal = on_refusal
        self._subscriptions: list[Any] = []
        self._reading: asyncio.Task[None] | None = None

    def follow(self) -> str | None:
        """Begin with the source named now, and leave the one before; RViz's words for why there is none, or None."""
        self.close()
        if self._properties.text(SOURCE) == "File":
            return self._read_file(self._properties.text(FILE).strip())
        return self._subscribe(self._properties.text(TOPIC).strip())

    def close(self) -> None:
        """Leave the source."""
        for subscription in self._subscriptions:
            with suppress(ValueError):  # the node may have been destroyed before
                self._node.destroy_subscription(subscription)
        self._subscriptions.clear()
        if self._reading is not None:
            self._reading.cancel()
            self._reading = None

    def _subscribe(self, topic: str) -> str | None:
        if not topic:
            return "Error subscribing: Empty topic name"
        durabilities = [DurabilityPolicy.TRANSIENT_LOCAL]
        if self._properties.text(TOPIC, "Durability Policy") != "Transient Local":
            durabilities.append(DurabilityPolicy.VOLATILE)  # for publishers that offer no more
        try:
            for durability in durabilities:
                self._subscriptions.append(
                    self._node.create_subscription(String, topic, self._received, self._qos(durability))
                )
        except LinkwrightError as error:
            return f"Error subscribing: {error.diagnostics[0].message}"
        return None

    def _qos(self, durability: DurabilityPolicy) -> QoSProfile:
        get = self._properties.text
        best_effort = get(TOPIC, "Reliability Policy") == "Best Effort"
        keep_all = get(TOPIC, "History Policy") == "Keep All"
        return QoSProfile(
            depth=int(self._properties.number(TOPIC, "Depth")),
            reliability=ReliabilityPolicy.BEST_EFFORT if best_effort else ReliabilityPolicy.RELIABLE,
            durability=durability,
            history=HistoryPolicy.KEEP_ALL if keep_all else HistoryPolicy.KEEP_LAST,
        )

    def _received(self, message: String) -> None:
        self._on_text(message.data)

    def _read_file(self, address: str) -> str | None:
        if not address:
            return "No description file is named"
        self._reading = asyncio.get_running_loop().create_task(self._read(address))
        return None

    async def _read(self, address: str) -> None:
        from linkwright.xacro import expand

        try:
            path: Path = self._finder.resolve(address)
            expansion = await asyncio.to_thread(expand, path, packages=self._finder)
        except LinkwrightError as error:
            self._on_refusal(error.diagnostics)
            return
        text = str(expansion)
        self._library.remember(text, expansion.document, expansion.story)
        self._on_text(text)
