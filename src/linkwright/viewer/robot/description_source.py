"""Where a RobotModel display has its description from: a topic of the graph, or a file."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from linkwright.descriptions import examine
from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.graph import DurabilityPolicy
from linkwright.messages import String
from linkwright.viewer.config.property_store import PropertyStore, qos_of
from linkwright.viewer.config.schema import PropertySpec, topic_spec
from linkwright.viewer.context import ViewerContext

SOURCE = "Description Source"
FILE = "Description File"
TOPIC = "Description Topic"

DESCRIPTION_SPECS = (
    PropertySpec(SOURCE, "enum", "Topic", "Where the description comes from.", options=("Topic", "File")),
    PropertySpec(
        FILE,
        "string",
        "",
        "A URDF or xacro file: a path or a package:// address.",
        when=((SOURCE,), "File"),
    ),
    topic_spec(
        TOPIC,
        "/robot_description",
        "The topic that carries the description, as std_msgs/msg/String.",
        depth=1,
        durability="Transient Local",
        durability_help="Whether a description published before counts too. It always does here: most files say "
        "Volatile, and then it would be chance whether the robot is seen.",
        when=((SOURCE,), "Topic"),
    ),
)


class DescriptionSource:
    """Follows the source that a display's properties name.

    Args:
        context: of the viewer; its library is told of files read, so that the robot knows its places in them.
        properties: of the display, with `DESCRIPTION_SPECS`.
        on_text: called with each description.
        on_refusal: called with what is wrong when there is none to be had.
    """

    def __init__(
        self,
        context: ViewerContext,
        properties: PropertyStore,
        on_text: Callable[[str], None],
        on_refusal: Callable[[Sequence[Diagnostic]], None],
    ) -> None:
        self._context = context
        self._properties = properties
        self._on_text = on_text
        self._on_refusal = on_refusal
        self._subscriptions: list[Any] = []
        self._reading: asyncio.Task[None] | None = None

    def follow(self) -> str | None:
        """Follow the source named now instead of the one before; returns RViz's words for why that failed, or None."""
        self.close()
        if self._properties.text(SOURCE) == "File":
            return self._read_file(self._properties.text(FILE).strip())
        return self._subscribe(self._properties.text(TOPIC).strip())

    def close(self) -> None:
        """Leave the source."""
        for subscription in self._subscriptions:
            with suppress(ValueError):  # the node may have been destroyed before
                self._context.node.destroy_subscription(subscription)
        self._subscriptions.clear()
        if self._reading is not None:
            self._reading.cancel()
            self._reading = None

    def _subscribe(self, topic: str) -> str | None:
        if not topic:
            return "Error subscribing: Empty topic name"
        asked = qos_of(self._properties, TOPIC)
        # Transient local first, then what the file asks for, for publishers that do not offer it.
        profiles = [qos_of(self._properties, TOPIC, lasting=True)]
        if asked.durability is not DurabilityPolicy.TRANSIENT_LOCAL:
            profiles.append(asked)
        try:
            for profile in profiles:
                self._subscriptions.append(
                    self._context.node.create_subscription(String, topic, self._received, profile)
                )
        except LinkwrightError as error:
            return f"Error subscribing: {error.diagnostics[0].message}"
        return None

    def _received(self, message: String) -> None:
        self._on_text(message.data)

    def _read_file(self, address: str) -> str | None:
        if not address:
            return "No description file is named"
        self._reading = asyncio.get_running_loop().create_task(self._read(address))
        return None

    async def _read(self, address: str) -> None:
        try:
            path: Path = self._context.finder.resolve(address)
            description = await asyncio.to_thread(examine, path, packages=self._context.finder, xacro=True)
        except LinkwrightError as error:
            self._on_refusal(error.diagnostics)
            return
        self._on_text(self._context.library.remember(description))
