"""The TurtleSim panel, which replaces the window of turtlesim_node."""

from __future__ import annotations

import asyncio
from base64 import b64encode
from dataclasses import dataclass, field
from itertools import count

from linkwright.images.png import png
from linkwright.nodes.turtlesim.simulator import Turtlesim
from linkwright.page.audience import Page
from linkwright.page.protocol.message import ServerMessage
from linkwright.page.protocol.turtlesim import (
    TurtleLines,
    TurtlePose,
    TurtleScene,
    TurtleSimulator,
    TurtleSimulators,
    WatchTurtles,
)
from linkwright.panels.page_feature import FeatureHost, PageFeature

_PERIOD_S = 1.0 / 30.0

_NOTHING_DRAWN = 1
"""The version of a canvas that nothing was drawn on."""


@dataclass
class _Watch:
    """The data that a page has received, by the number of the simulator."""

    scenes: dict[int, TurtleScene] = field(default_factory=dict)
    versions: dict[int, int] = field(default_factory=dict)


class TurtlesimFeature(PageFeature):
    """The feature that shows the turtles of the turtlesim_nodes of this process."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._numbers = count(1)
        self._simulators: dict[int, Turtlesim] = {}
        self._watches: dict[Page, _Watch] = {}
        self._timer: asyncio.TimerHandle | None = None

    def show(self, simulator: Turtlesim) -> None:
        """Show the turtles of a node until it ends."""
        self._simulators[next(self._numbers)] = simulator
        self.context.graph_changes.watch(self._remove_ended)
        self.context.pages.publish(self._make_list())

    def opening_messages(self) -> list[ServerMessage]:
        """Return the list of the nodes."""
        return [self._make_list()]

    def receive(self, page: Page, message: WatchTurtles) -> None:
        """Begin or end to send turtles and lines to a page."""
        self._watches.pop(page, None)
        if message.is_watched:
            self._watches[page] = _Watch()
            if self._timer is None:
                self._send()

    def remove_page(self, page: Page) -> None:
        """Stop sending to a page that was closed."""
        self._watches.pop(page, None)

    def close(self) -> None:
        """Stop sending."""
        self._watches.clear()
        self.context.graph_changes.unwatch(self._remove_ended)
        if self._timer is not None:
            self._timer.cancel()

    def _make_list(self) -> TurtleSimulators:
        return TurtleSimulators(
            [
                TurtleSimulator(number, simulator.node.get_fully_qualified_name())
                for number, simulator in self._simulators.items()
            ]
        )

    def _remove_ended(self) -> None:
        ended = [number for number, simulator in self._simulators.items() if simulator.node.handle.is_destroyed]
        for number in ended:
            del self._simulators[number]
        if ended:
            self.context.pages.publish(self._make_list())

    def _send(self) -> None:
        """Send each page what has changed since the last time."""
        self._timer = None
        if not self._watches:
            return
        self._timer = asyncio.get_running_loop().call_later(_PERIOD_S, self._send)
        for number, simulator in self._simulators.items():
            if simulator.node.handle.is_destroyed:
                continue
            scene = _make_scene(number, simulator)
            for page, watch in self._watches.items():
                if watch.scenes.get(number) != scene:
                    watch.scenes[number] = scene
                    page.send(scene)
                version = watch.versions.get(number, _NOTHING_DRAWN)
                if version != simulator.canvas.version:
                    watch.versions[number] = simulator.canvas.version
                    page.send(_make_lines(number, simulator, version))


def _make_scene(number: int, simulator: Turtlesim) -> TurtleScene:
    turtles = [
        TurtlePose(turtle.name, turtle.velocity_topic, turtle.x, turtle.y, turtle.theta, turtle.shape)
        for turtle in simulator.turtles.values()
    ]
    return TurtleScene(number, "#{:02x}{:02x}{:02x}".format(*simulator.background), turtles)


def _make_lines(number: int, simulator: Turtlesim, version: int) -> TurtleLines:
    """Return the lines in the area that has changed since a version."""
    canvas = simulator.canvas
    left, top, right, bottom = canvas.find_changed_area(version)
    image = b64encode(png(canvas.pixels[top:bottom, left:right])).decode()
    return TurtleLines(number, canvas.version, left, top, image)
