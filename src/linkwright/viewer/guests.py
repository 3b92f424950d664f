"""Recordings that pages uploaded or made, each with its own graph and viewer.

Their pages are served by the host viewer's server, but they reach neither its graph nor the network.
"""

from __future__ import annotations

import asyncio
import secrets
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.graph import Graph
from linkwright.nodes.options import NodeOptions
from linkwright.viewer.viewer import Viewer

if TYPE_CHECKING:
    from linkwright.bag import BagReader
    from linkwright.page.audience import Audience

PATIENCE = 60.0
"""Seconds without a page after which a recording is no longer shown."""

_MOST = 4
_LOOK = 5.0
_LEFT = 10.0
"""Seconds without a page after which another recording may replace one."""


@dataclass(slots=True)
class _Guest:
    bag: BagReader
    graph: Graph
    viewer: Viewer
    scratch: TemporaryDirectory[str] | None
    left: float


class GuestRecordings:
    """Shows recordings to the pages that uploaded or made them.

    Args:
        host: the viewer whose server serves the pages.
    """

    def __init__(self, host: Viewer) -> None:
        self._host = host
        self._guests: dict[str, _Guest] = {}
        self._looking: asyncio.TimerHandle | None = None
        self._closing: set[asyncio.Task[None]] = set()

    async def open(self, path: Path, scratch: TemporaryDirectory[str] | None) -> str:
        """Show a recording, and return the key by which pages name it.

        The recording is shown until a minute after its last page was closed.

        Args:
            path: the path of the recording's file or folder.
            scratch: the temporary folder of the recording, which is removed afterwards; None for a permanent file.

        Raises:
            LinkwrightError: BAG101, BAG102, BAG107, see `BagReader`; BAG111, the limit of recordings is reached.
        """
        from linkwright.bag import BagReader, Playback  # few viewers show other recordings
        from linkwright.viewer.recorded_robot import published, robot_of
        from linkwright.viewer.recording_config import recording_config

        await self._make_room()
        if len(self._guests) >= _MOST:
            raise LinkwrightError(
                Diagnostic(
                    "BAG111",
                    phrase(
                        "{count} recordings are open already: close the page of one, and wait a minute", count=_MOST
                    ),
                )
            )
        bag = await asyncio.to_thread(BagReader, path, path.name)
        host = self._host.context
        try:
            robot = robot_of(bag, host.library)
            config = recording_config(bag, robot)
            graph = Graph()
            node = graph.create_node("rosbag2_player", start_parameter_services=False)
            output = published(bag, node, robot)
            viewer = Viewer(
                graph,
                library=host.library,
                finder=host.finder,
                config=config,
                title=path.name,
                options=NodeOptions(name="viewer", parameters={"use_sim_time": True}, library=host.library),
                beside=self._host,
            )
            await viewer.start()
            viewer.attach_recording(Playback(node.handle, bag, output, viewer.playback_failed), bag)
        except BaseException:
            bag.close()
            raise
        key = secrets.token_urlsafe(16)
        self._guests[key] = _Guest(bag, graph, viewer, scratch, asyncio.get_running_loop().time())
        self._look_later()
        return key

    def audience(self, key: str) -> Audience | None:
        """Return the pages that show the recording with a key, or None if there is no such recording."""
        guest = self._guests.get(key)
        return None if guest is None else guest.viewer.audience

    async def close(self) -> None:
        """Stop showing recordings."""
        if self._looking is not None:
            self._looking.cancel()
        guests, self._guests = self._guests, {}
        await asyncio.gather(*(_end(guest) for guest in guests.values()), *self._closing)

    async def _make_room(self) -> None:
        """If the limit is reached, close the recording that has had no pages for the longest time."""
        if len(self._guests) < _MOST:
            return
        until = asyncio.get_running_loop().time() - _LEFT
        left = {key: guest.left for key, guest in self._guests.items() if not len(guest.viewer.audience)}
        first = min(left, key=left.__getitem__, default=None)
        if first is not None and left[first] < until:
            await _end(self._guests.pop(first))

    def _look_later(self) -> None:
        if self._looking is None:
            self._looking = asyncio.get_running_loop().call_later(_LOOK, self._look)

    def _look(self) -> None:
        """Close the recordings whose last page was closed a while ago."""
        self._looking = None
        loop = asyncio.get_running_loop()
        for key, guest in list(self._guests.items()):
            if len(guest.viewer.audience):
                guest.left = loop.time()
            elif loop.time() - guest.left > PATIENCE:
                del self._guests[key]
                task = loop.create_task(_end(guest))
                self._closing.add(task)
                task.add_done_callback(self._closing.discard)
        if self._guests:
            self._look_later()


async def _end(guest: _Guest) -> None:
    await guest.viewer.close()
    await guest.graph.close()
    guest.bag.close()
    if guest.scratch is not None:
        guest.scratch.cleanup()
