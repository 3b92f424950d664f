"""Recording for pages: one recording at a time, shared by all pages, and saving the last minutes.

Files are written to the program's working directory, under names that the program chooses; pages cannot choose them.
"""

from __future__ import annotations

import asyncio
import shutil
import sys
import time
from collections.abc import Callable, Iterable
from datetime import datetime
from functools import partial
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, display_path, foreign, in_one_line, phrase
from linkwright.graph import Clock, Duration, JumpThreshold, Node
from linkwright.page.audience import Page
from linkwright.page.protocol.message import ServerMessage
from linkwright.page.protocol.time import (
    RecordedFile,
    RecordingState,
    RecordTopics,
    SaveMinutes,
    StopRecording,
)
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from linkwright.bag import BagWriter, Recorder
    from linkwright.bag.saving import SavedTopic
    from linkwright.graph.time.clock import JumpHandle
    from linkwright.panels.live_history import LiveHistory

_PERIOD = 1.0
"""Seconds between two reports of the progress to pages."""

LEFT_FREE = 256_000_000
"""Bytes of the disk that recordings from pages leave free."""

_MOST_FILES = 20


class RecordingFeature(PageFeature):
    """Records topics for pages.

    A recording continues when the page that started it is closed, and is completed when the program ends.

    Attributes:
        folder: the folder for recordings.
        left_free: the number of bytes to leave free on the disk.
    """

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self.folder = self.context.folder
        self.left_free = LEFT_FREE
        self._possible = True
        self._running: _CurrentRecording | None = None
        self._saved: float | None = None
        self._saving: asyncio.Task[None] | None = None
        self._timer: asyncio.TimerHandle | None = None
        self._problem = ""
        self._files: list[RecordedFile] = []
        self._loop = asyncio.get_running_loop()

    def recording_shown(self) -> None:
        """Refuse to record from now on, because a recording is shown."""
        self._possible = False
        self._publish()

    def opening(self) -> list[ServerMessage]:
        """Return the state of the recording."""
        return [self._state()]

    def receive(self, page: Page, message: RecordTopics | StopRecording | SaveMinutes) -> None:
        """Start or stop recording, or save the last minutes."""
        if not self._possible:
            return
        match message:
            case RecordTopics(topics) if self._running is None:
                self._attempt(lambda: self._begin(topics))
            case StopRecording():
                self._end()
            case SaveMinutes(start, end) if self._saving is None and self.viewer.live is not None:
                if all(time is None or isfinite(time) for time in (start, end)):
                    self._attempt(partial(self._save, self.viewer.live, start, end))

    def close(self) -> None:
        """Complete the current recording, if there is one."""
        self._possible = False
        self._end()
        if self._saving is not None:
            self._saving.cancel()
        if self._timer is not None:
            self._timer.cancel()

    # --- recording topics --------------------------------------------------------------------------------------

    def _begin(self, topics: list[str]) -> None:
        from linkwright.bag import BagWriter, Recorder, TopicSelection

        self._check_room(0)
        writer = BagWriter(self._free_path("rosbag2"))
        simulated = bool(self.context.node.get_parameter("use_sim_time").value)
        node = Node(
            self.context.node.graph,
            "rosbag2_recorder",
            parameters={"use_sim_time": simulated},
            start_parameter_services=False,
        )
        selection = TopicSelection(everything=not topics, every_service=not topics, names=topics)
        recorder = Recorder(node, selection, writer, guarded=self._guard)
        threshold = JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=False)
        jumps = node.get_clock().create_jump_callback(
            threshold, post_callback=lambda _: self._loop.call_soon_threadsafe(self._end_at_reset, recorder)
        )
        self._running = _CurrentRecording(
            node, writer, recorder, jumps, self.context.node.get_clock() if simulated else None
        )
        self._publish_later()

    def _guard(self, callback: Callable[..., object]) -> Callable[..., object]:
        """Wrap a callback of the recorder's node so that a failed write ends the recording."""

        def call(*arguments: Any) -> None:
            try:
                callback(*arguments)
            except LinkwrightError as error:
                self._refused(error.diagnostics)
                self._loop.call_soon(self._end)

        return call

    def _end_at_reset(self, recorder: Recorder) -> None:
        if self._running is not None and self._running.recorder is recorder:
            path = display_path(self._running.writer.path)
            self._refused([_finding(phrase("recording to '{path}' stops: simulated time was reset", path=path))])
            self._end()

    def _end(self) -> None:
        running, self._running = self._running, None
        if running is None:
            return
        path = running.writer.path
        running.jumps.unregister()
        try:
            running.recorder.close()
        except LinkwrightError as error:
            self._refused(error.diagnostics)
        running.node.destroy_node()
        if running.recorder.message_count:
            self._add_file(path, running.length, running.simulated)
        else:
            shutil.rmtree(path, ignore_errors=True)
            self._refused([_finding(phrase("no messages arrived, so there is no recording"))])
        self._publish()

    # --- saving the last minutes -------------------------------------------------------------------------------

    def _save(self, live: LiveHistory, start: float | None, end: float | None) -> None:
        history = live.history
        self._check_room(history.size)
        start_ns = history.start_ns if start is None else round(start * NANOSECONDS_PER_SECOND)
        end_ns = history.end_ns if end is None else round(end * NANOSECONDS_PER_SECOND)
        path = self._free_path("last_minutes")
        self._saved = 0.0
        self._saving = self._loop.create_task(self._write(live, live.topics(), path, start_ns, end_ns))
        self._saving.add_done_callback(self._written)
        self._publish_later()

    async def _write(
        self, live: LiveHistory, topics: dict[str, SavedTopic], path: Path, start_ns: int, end_ns: int
    ) -> None:
        from linkwright.bag.saving import save_messages

        simulated = bool(self.context.node.get_parameter("use_sim_time").value)
        messages = await asyncio.to_thread(live.part, topics, start_ns, end_ns, simulated=simulated)
        if not messages:
            self._refused([_finding(phrase("no messages arrived in that time, so there is no recording"))])
            return
        try:
            await asyncio.to_thread(save_messages, path, topics, messages, self._note)
        except LinkwrightError as error:
            self._refused(error.diagnostics)
        self._add_file(path, (messages[-1][1] - messages[0][1]) / NANOSECONDS_PER_SECOND)

    def _note(self, part: float) -> None:
        self._saved = part

    def _written(self, task: asyncio.Task[None]) -> None:
        self._saving = self._saved = None
        error = None if task.cancelled() else task.exception()
        if error is not None:  # otherwise, pages would wait forever
            self.context.node.get_logger().error(f"The last minutes were not saved: {error!r}")
            self._refused([_finding(phrase("the last minutes were not saved: {reason}", reason=foreign(repr(error))))])
        self._publish()

    # --- files -------------------------------------------------------------------------------------------------

    def _free_path(self, kind: str) -> Path:
        name = f"{kind}_{datetime.now().astimezone():%Y_%m_%d-%H_%M_%S}"
        taken = 1
        path = self.folder / name
        while path.exists():
            taken += 1
            path = self.folder / f"{name}_{taken}"
        return path

    def _check_room(self, needed: int) -> None:
        """Check that the disk has enough free space for a number of bytes.

        Raises:
            LinkwrightError: BAG110, there is not enough space.
        """
        if self._free() < self.left_free + needed:
            raise LinkwrightError(
                _finding(
                    phrase(
                        "there is not enough space for a recording in '{folder}': {free} MB are free, {least} "
                        "MB are required",
                        folder=display_path(self.folder),
                        free=self._free() // 1_000_000,
                        least=(self.left_free + needed) // 1_000_000,
                    )
                )
            )

    def _free(self) -> int:
        """Return the number of free bytes on the disk of the recordings.

        The result is ``sys.maxsize`` if it is unknown, because writing then reports a full disk.
        """
        try:
            return shutil.disk_usage(self.folder).free
        except OSError:
            return sys.maxsize

    def _add_file(self, path: Path, length: float, simulated: float | None = None) -> None:
        for file in sorted(path.glob("*.mcap")):
            url = self.context.downloads.keep(file)
            made = RecordedFile(path.name, str(path), file.stat().st_size, length, url, simulated)
            self._files = [made, *self._files[: _MOST_FILES - 1]]
            self.context.node.get_logger().info(f"Recorded to '{display_path(path)}'")

    # --- pages -------------------------------------------------------------------------------------------------

    def _attempt(self, what: Callable[[], object]) -> None:
        self._problem = ""
        try:
            what()
        except LinkwrightError as error:
            self._refused(error.diagnostics)
        self._publish()

    def _refused(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Show errors in pages and in the terminal."""
        for diagnostic in diagnostics:
            self.context.report(diagnostic)
        self._problem = in_one_line(diagnostics)

    def _publish(self) -> None:
        self.context.pages.publish(self._state())

    def _publish_later(self) -> None:
        if self._timer is None:
            self._timer = self._loop.call_later(_PERIOD, self._look)

    def _look(self) -> None:
        self._timer = None
        if self._running is not None and self._free() < self.left_free:
            full = phrase(
                "recording to '{path}' stops: the disk has less than {left} MB left",
                path=display_path(self._running.writer.path),
                left=self.left_free // 1_000_000,
            )
            self._refused([_finding(full)])
            self._end()
        self._publish()
        if self._running is not None or self._saving is not None:
            self._publish_later()

    def _state(self) -> RecordingState:
        running = self._running
        path, length, size = ("", 0.0, 0)
        if running is not None:
            path, length, size = str(running.writer.path), running.length, running.writer.size
        return RecordingState(self._possible, path, length, size, self._saved, self._problem, self._files)


class _CurrentRecording:
    """A recording in progress; `clock` is the simulation's clock, or None."""

    def __init__(
        self, node: Node, writer: BagWriter, recorder: Recorder, jumps: JumpHandle, clock: Clock | None
    ) -> None:
        self.node = node
        self.writer = writer
        self.recorder = recorder
        self.jumps = jumps
        self._began = time.monotonic()
        self._clock = clock
        self._simulated_from = 0 if clock is None else clock.now().nanoseconds

    @property
    def length(self) -> float:
        """The seconds since the start of the recording."""
        return time.monotonic() - self._began

    @property
    def simulated(self) -> float | None:
        """The simulated seconds since the start; None if time is not simulated, or was reset."""
        if self._clock is None:
            return None
        passed = (self._clock.now().nanoseconds - self._simulated_from) / 1e9
        return passed if passed >= 0 else None


def _finding(message: Phrase) -> Diagnostic:
    return Diagnostic("BAG110", message)
