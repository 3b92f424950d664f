"""Shows recordings that pages uploaded or made, each with a separate graph and viewer.

The server of the host viewer serves the pages, but the recordings reach neither its graph nor the network.
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

IDLE_TIMEOUT_S = 60.0
"""Seconds without a page after which a recording is no longer shown."""

_MAX_RECORDINGS = 4
_CHECK_PERIOD_S = 5.0
_MIN_IDLE_TIME_S = 10.0
"""Seconds without a page after which a recording may be replaced by another recording."""


@dataclass(slots=True)
class _OpenRecording:
    """A recording that pages show, with the time in seconds when a page last showed it."""

    bag: BagReader
    graph: Graph
    viewer: Viewer
    temporary_folder: TemporaryDirectory[str] | None
    last_page_time: float


class GuestRecordings:
    """The recordings shown to the pages that uploaded or made them.

    Args:
        host: the viewer whose server serves the pages.
    """

    def __init__(self, host: Viewer) -> None:
        self._host = host
        self._recordings: dict[str, _OpenRecording] = {}
        self._check_timer: asyncio.TimerHandle | None = None
        self._closing_tasks: set[asyncio.Task[None]] = set()

    async def open(self, path: Path, temporary_folder: TemporaryDirectory[str] | None) -> str:
        """Show a recording, and return the key with which pages refer to it.

        The recording is shown until a minute after its last page was closed.

        Args:
            path: the file or folder of the recording.
            temporary_folder: the folder of the recording, which is removed with it; None for a permanent file.

        Raises:
            LinkwrightError: BAG101, BAG102, BAG107, see `BagReader`; BAG111, the limit of recordings is reached.
        """
        from linkwright.bag import BagReader, Playback  # imported here, because few viewers show other recordings
        from linkwright.viewer.recorded_robot import publish_recording, read_robot
        from linkwright.viewer.recording_config import create_recording_config

        await self._close_longest_idle()
        if len(self._recordings) >= _MAX_RECORDINGS:
            raise LinkwrightError(
                Diagnostic(
                    "BAG111",
                    phrase(
                        "{count} recordings are already open: close the page of one of them, and wait a minute",
                        count=_MAX_RECORDINGS,
                    ),
                )
            )
        bag = await asyncio.to_thread(BagReader, path, path.name)
        host_context = self._host.context
        try:
            robot = read_robot(bag, host_context.library)
            config = create_recording_config(bag, robot)
            graph = Graph()
            node = graph.create_node("rosbag2_player", start_parameter_services=False)
            output = publish_recording(bag, node, robot)
            viewer = Viewer(
                graph,
                library=host_context.library,
                finder=host_context.finder,
                config=config,
                title=path.name,
                options=NodeOptions(name="viewer", parameters={"use_sim_time": True}, library=host_context.library),
                beside=self._host,
            )
            await viewer.start()
            viewer.attach_recording(Playback(node.handle, bag, output, viewer.on_playback_error), bag)
        except BaseException:
            bag.close()
            raise
        key = secrets.token_urlsafe(16)
        self._recordings[key] = _OpenRecording(bag, graph, viewer, temporary_folder, asyncio.get_running_loop().time())
        self._schedule_check()
        return key

    def audience(self, key: str) -> Audience | None:
        """Return the pages that show the recording with a key, or None if there is none."""
        recording = self._recordings.get(key)
        return None if recording is None else recording.viewer.audience

    async def close(self) -> None:
        """Stop showing recordings."""
        if self._check_timer is not None:
            self._check_timer.cancel()
        recordings, self._recordings = self._recordings, {}
        await asyncio.gather(*(_close_recording(recording) for recording in recordings.values()), *self._closing_tasks)

    async def _close_longest_idle(self) -> None:
        """If the limit is reached, close the recording that has had no pages for the longest time."""
        if len(self._recordings) < _MAX_RECORDINGS:
            return
        idle_since_limit = asyncio.get_running_loop().time() - _MIN_IDLE_TIME_S
        last_page_times = {
            key: recording.last_page_time
            for key, recording in self._recordings.items()
            if not len(recording.viewer.audience)
        }
        longest_idle_key = min(last_page_times, key=last_page_times.__getitem__, default=None)
        if longest_idle_key is not None and last_page_times[longest_idle_key] < idle_since_limit:
            await _close_recording(self._recordings.pop(longest_idle_key))

    def _schedule_check(self) -> None:
        if self._check_timer is None:
            self._check_timer = asyncio.get_running_loop().call_later(_CHECK_PERIOD_S, self._close_idle)

    def _close_idle(self) -> None:
        """Close the recordings whose last page was closed a while ago."""
        self._check_timer = None
        loop = asyncio.get_running_loop()
        for key, recording in list(self._recordings.items()):
            if len(recording.viewer.audience):
                recording.last_page_time = loop.time()
            elif loop.time() - recording.last_page_time > IDLE_TIMEOUT_S:
                del self._recordings[key]
                task = loop.create_task(_close_recording(recording))
                self._closing_tasks.add(task)
                task.add_done_callback(self._closing_tasks.discard)
        if self._recordings:
            self._schedule_check()


async def _close_recording(recording: _OpenRecording) -> None:
    await recording.viewer.close()
    await recording.graph.close()
    recording.bag.close()
    if recording.temporary_folder is not None:
        recording.temporary_folder.cleanup()
