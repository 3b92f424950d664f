"""A viewer in the test's own process, so that a test controls every published message."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from linkwright.descriptions import DescriptionLibrary
from linkwright.graph import STATIC_TF_PUBLISHER_QOS, Graph
from linkwright.messages import TFMessage, get_message
from linkwright.packages import PackageFinder
from linkwright.rviz import RvizConfig
from linkwright.viewer import Viewer
from tests.waiting import wait_until

Result = TypeVar("Result")

POLL_PERIOD_S = 0.05
"""The pause in seconds between two checks of a browser; each check costs four processes some milliseconds."""

FILE = """\
Visualization Manager:
  Displays:
{displays}
  Global Options:
    Background Color: 48; 48; 48
    Fixed Frame: base
    Frame Rate: 30
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Distance: {distance}
      Focal Point: {{X: 0, Y: 0, Z: 0}}
      Pitch: {pitch}
      Yaw: {yaw}
"""


def configuration(displays: str, *, distance: float = 10.0, pitch: float = 0.6, yaw: float = 0.8) -> str:
    """Return a .rviz file with an Orbit view around the frame ``base``.

    `displays` are its entries as YAML.
    """
    entries = "".join(f"    {line}\n" for line in displays.strip("\n").splitlines())
    return FILE.format(displays=entries.rstrip("\n"), distance=distance, pitch=pitch, yaw=yaw)


class LiveViewer:
    """A graph with a viewer and a node to publish with, in a separate thread.

    Attributes:
        url: the URL of the page.
        node: the node with which the test publishes and subscribes; use it only in `run`.
        viewer: the viewer; use it only in `run`.
    """

    url: str
    node: Any
    viewer: Viewer

    def __init__(self, config: str, *, packages: dict[str, Path] | None = None) -> None:
        self._config = config
        self._packages = packages or {}
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        self._publishers: dict[str, Any] = {}
        self.run(self._start)

    def run(self, function: Callable[[], Result]) -> Result:
        """Run a function or coroutine function in the viewer's loop, and return its result."""

        async def call() -> Any:
            result = function()
            return await result if asyncio.iscoroutine(result) else result

        return asyncio.run_coroutine_threadsafe(call(), self._loop).result(timeout=60)

    def publish(self, topic: str, message: Any, qos: Any = 10) -> None:
        """Publish a message, and keep the publisher."""

        def send() -> None:
            if topic not in self._publishers:
                self._publishers[topic] = self.node.create_publisher(type(message), topic, qos)
            self._publishers[topic].publish(message)

        self.run(send)

    def place(self, child: str, *pose: float, parent: str = "base") -> None:
        """Publish a static transform: x y z, or x y z qx qy qz qw."""
        full_pose = (*pose, 0.0, 0.0, 0.0, 1.0) if len(pose) == 3 else pose
        transform = get_message("geometry_msgs/msg/TransformStamped")()
        transform.header.frame_id, transform.child_frame_id = parent, child
        for target, names, values in (
            (transform.transform.translation, "xyz", full_pose[:3]),
            (transform.transform.rotation, "xyzw", full_pose[3:]),
        ):
            for name, value in zip(names, values, strict=True):
                setattr(target, name, float(value))
        self.publish("/tf_static", TFMessage(transforms=[transform]), STATIC_TF_PUBLISHER_QOS)

    def settle(self, page: Any) -> None:
        """Wait until the only open page has received and drawn everything."""

        def last_number() -> int | None:
            (viewer_page,) = self.viewer._audience._pages
            is_sending = viewer_page._opening or viewer_page.outbox or viewer_page._reduced
            return None if is_sending else viewer_page.line._number

        def is_settled() -> bool:
            number = self.run(last_number)
            expression = "([number]) => window.linkwright?.received === number && window.linkwright.settled"
            return number is not None and page.evaluate(expression, [number]) and self.run(last_number) == number

        wait_until(is_settled, 60, pause=POLL_PERIOD_S)

    def status(self, name: str) -> dict[str, tuple[str, str]]:
        """Return the status rows of a display: name -> level, text."""

        def read() -> dict[str, tuple[str, str]]:
            display = next(display for display in self.viewer.displays if display.config.name == name)
            return {row.name: (row.level, row.text) for row in display.status}

        return self.run(read)

    def close(self) -> None:
        """Close the viewer, and end the thread."""

        async def end() -> None:
            await self.viewer.close()
            await self._graph.close()

        self.run(end)
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(timeout=60)
        self._loop.close()

    async def _start(self) -> None:
        self._graph = Graph()
        self.node = self._graph.create_node("test_publisher")
        self.viewer = Viewer(
            self._graph,
            library=DescriptionLibrary(),
            finder=PackageFinder(start=Path("/nonexistent"), environment={}, extra=self._packages),
            config=RvizConfig.parse(self._config),
            port=0,
        )
        await self.viewer.start()
        self.url = self.viewer.url
