"""Records topics for pages, one recording at a time, and saves the last minutes.

Files are written to the working directory of the program. The program chooses their names, not the pages.
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

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, display_path, foreign, join_messages, phrase
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

_REPORT_PERIOD_S = 1.0
"""Seconds between two reports of the progress to pages."""

MIN_FREE_BYTES = 256_000_000
"""The number of bytes that recordings from pages leave free on the disk."""

_MAX_FILES = 20


class RecordingFeature(PageFeature):
    """The feature that records topics for pages.

    A recording continues when the page that started it is closed, and is completed when the program ends.

    Attributes:
        folder: the folder for recordings.
        min_free_bytes: the number of bytes to leave free on the disk.
    """

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self.folder = self.context.folder
        self.min_free_bytes = MIN_FREE_BYTES
        self._is_possible = True
        self._running: _CurrentRecording | None = None
        self._saved_fraction: float | None = None
        self._save_task: asyncio.Task[None] | None = None
        self._timer: asyncio.TimerHandle | None = None
        self._problem = ""
        self._files: list[RecordedFile] = []
        self._loop = asyncio.get_running_loop()

    def on_recording_shown(self) -> None:
        """Disable recording permanently, because a recording is shown."""
        self._is_possible = False
        self._publish()

    def opening_messages(self) -> list[ServerMessage]:
        """Return the state of the recording."""
        return [self._make_state()]

    def receive(self, page: Page, message: RecordTopics | StopRecording | SaveMinutes) -> None:
        """Start or stop recording, or save the last minutes."""
        if not self._is_possible:
            return
        match message:
            case RecordTopics(topics) if self._running is None:
                self._try_action(lambda: self._begin(topics))
            case StopRecording():
                self._stop_recording()
            case SaveMinutes(start, end) if self._save_task is None and self.viewer.live is not None:
                if all(time is None or isfinite(time) for time in (start, end)):
                    self._try_action(partial(self._save, self.viewer.live, start, end))

    def close(self) -> None:
        """Complete the current recording, and stop saving the last minutes."""
        self._is_possible = False
        self._stop_recording()
        if self._save_task is not None:
            self._save_task.cancel()
        if self._timer is not None:
            self._timer.cancel()

    # --- recording topics --------------------------------------------------------------------------------------

    def _begin(self, topics: list[str]) -> None:
        from linkwright.bag import BagWriter, Recorder, TopicSelection

        self._check_space(0)
        writer = BagWriter(self._find_free_path("rosbag2"))
        uses_simulated_time = bool(self.context.node.get_parameter("use_sim_time").value)
        node = Node(
            self.context.node.graph,
            "rosbag2_recorder",
            parameters={"use_sim_time": uses_simulated_time},
            start_parameter_services=False,
        )
        selection = TopicSelection(all_topics=not topics, all_services=not topics, names=topics)
        recorder = Recorder(node, selection, writer, wrap_callback=self._guard)
        threshold = JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=False)
        jump_handle = node.get_clock().create_jump_callback(
            threshold, post_callback=lambda _: self._loop.call_soon_threadsafe(self._stop_at_reset, recorder)
        )
        self._running = _CurrentRecording(
            node, writer, recorder, jump_handle, self.context.node.get_clock() if uses_simulated_time else None
        )
        self._schedule_publish()

    def _guard(self, callback: Callable[..., object]) -> Callable[..., object]:
        """Wrap a callback of the recorder's node, so that a failed write ends the recording."""

        def call(*arguments: Any) -> None:
            try:
                callback(*arguments)
            except LinkwrightError as error:
                self._report_errors(error.diagnostics)
                self._loop.call_soon(self._stop_recording)

        return call

    def _stop_at_reset(self, recorder: Recorder) -> None:
        if self._running is not None and self._running.recorder is recorder:
            path = display_path(self._running.writer.path)
            self._report_errors(
                [_make_finding(phrase("recording to '{path}' was stopped because simulated time was reset", path=path))]
            )
            self._stop_recording()

    def _stop_recording(self) -> None:
        recording, self._running = self._running, None
        if recording is None:
            return
        path = recording.writer.path
        recording.jump_handle.unregister()
        try:
            recording.recorder.close()
        except LinkwrightError as error:
            self._report_errors(error.diagnostics)
        recording.node.destroy_node()
        if recording.recorder.message_count:
            self._add_file(path, recording.length, recording.simulated_seconds)
        else:
            shutil.rmtree(path, ignore_errors=True)
            self._report_errors([_make_finding(phrase("no recording was saved, because no messages arrived"))])
        self._publish()

    # --- saving the last minutes -------------------------------------------------------------------------------

    def _save(self, live: LiveHistory, start: float | None, end: float | None) -> None:
        history = live.history
        self._check_space(history.size)
        start_ns = history.start_ns if start is None else round(start * NANOSECONDS_PER_SECOND)
        end_ns = history.end_ns if end is None else round(end * NANOSECONDS_PER_SECOND)
        path = self._find_free_path("last_minutes")
        self._saved_fraction = 0.0
        self._save_task = self._loop.create_task(self._write(live, live.topics(), path, start_ns, end_ns))
        self._save_task.add_done_callback(self._on_saved)
        self._schedule_publish()

    async def _write(
        self, live: LiveHistory, topics: dict[str, SavedTopic], path: Path, start_ns: int, end_ns: int
    ) -> None:
        from linkwright.bag.saving import save_messages

        uses_simulated_time = bool(self.context.node.get_parameter("use_sim_time").value)
        messages = await asyncio.to_thread(
            live.messages_between, topics, start_ns, end_ns, simulated=uses_simulated_time
        )
        if not messages:
            self._report_errors(
                [_make_finding(phrase("no recording was saved, because no messages arrived in that time"))]
            )
            return
        try:
            await asyncio.to_thread(save_messages, path, topics, messages, self._on_progress)
        except LinkwrightError as error:
            self._report_errors(error.diagnostics)
        self._add_file(path, (messages[-1][1] - messages[0][1]) / NANOSECONDS_PER_SECOND)

    def _on_progress(self, fraction: float) -> None:
        self._saved_fraction = fraction

    def _on_saved(self, task: asyncio.Task[None]) -> None:
        self._save_task = self._saved_fraction = None
        error = None if task.cancelled() else task.exception()
        if error is not None:  # If no problem was reported, pages would wait forever.
            self.context.node.get_logger().error(f"The last minutes were not saved: {error!r}")
            self._report_errors(
                [_make_finding(phrase("the last minutes were not saved: {reason}", reason=foreign(repr(error))))]
            )
        self._publish()

    # --- files -------------------------------------------------------------------------------------------------

    def _find_free_path(self, kind: str) -> Path:
        name = f"{kind}_{datetime.now().astimezone():%Y_%m_%d-%H_%M_%S}"
        number = 1
        path = self.folder / name
        while path.exists():
            number += 1
            path = self.folder / f"{name}_{number}"
        return path

    def _check_space(self, required_bytes: int) -> None:
        """Raise if the disk does not have enough free space for a number of bytes.

        Raises:
            LinkwrightError: BAG110, there is not enough space.
        """
        if self._count_free_bytes() < self.min_free_bytes + required_bytes:
            raise LinkwrightError(
                _make_finding(
                    phrase(
                        "there is not enough space for a recording in '{folder}': {free} MB are free, but "
                        "{required} MB are required",
                        folder=display_path(self.folder),
                        free=self._count_free_bytes() // 1_000_000,
                        required=(self.min_free_bytes + required_bytes) // 1_000_000,
                    )
                )
            )

    def _count_free_bytes(self) -> int:
        """Return the number of free bytes on the disk of the recordings.

        The result is ``sys.maxsize`` if the number is unknown. A full disk is then reported when writing.
        """
        try:
            return shutil.disk_usage(self.folder).free
        except OSError:
            return sys.maxsize

    def _add_file(self, path: Path, length: float, simulated_seconds: float | None = None) -> None:
        for file in sorted(path.glob("*.mcap")):
            url = self.context.downloads.offer_repeatedly(file)
            recorded_file = RecordedFile(path.name, str(path), file.stat().st_size, length, url, simulated_seconds)
            self._files = [recorded_file, *self._files[: _MAX_FILES - 1]]
            self.context.node.get_logger().info(f"Recorded to '{display_path(path)}'")

    # --- pages -------------------------------------------------------------------------------------------------

    def _try_action(self, action: Callable[[], object]) -> None:
        self._problem = ""
        try:
            action()
        except LinkwrightError as error:
            self._report_errors(error.diagnostics)
        self._publish()

    def _report_errors(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Show errors in pages and in the terminal."""
        for diagnostic in diagnostics:
            self.context.report(diagnostic)
        self._problem = join_messages(diagnostics)

    def _publish(self) -> None:
        self.context.pages.publish(self._make_state())

    def _schedule_publish(self) -> None:
        if self._timer is None:
            self._timer = self._loop.call_later(_REPORT_PERIOD_S, self._check_and_publish)

    def _check_and_publish(self) -> None:
        self._timer = None
        if self._running is not None and self._count_free_bytes() < self.min_free_bytes:
            message = phrase(
                "recording to '{path}' was stopped because the disk has less than {left} MB left",
                path=display_path(self._running.writer.path),
                left=self.min_free_bytes // 1_000_000,
            )
            self._report_errors([_make_finding(message)])
            self._stop_recording()
        self._publish()
        if self._running is not None or self._save_task is not None:
            self._schedule_publish()

    def _make_state(self) -> RecordingState:
        recording = self._running
        path, length, size = ("", 0.0, 0)
        if recording is not None:
            path, length, size = str(recording.writer.path), recording.length, recording.writer.size
        return RecordingState(self._is_possible, path, length, size, self._saved_fraction, self._problem, self._files)


class _CurrentRecording:
    """A recording in progress.

    `clock` is the simulated clock, or None if time is not simulated.
    """

    def __init__(
        self, node: Node, writer: BagWriter, recorder: Recorder, jump_handle: JumpHandle, clock: Clock | None
    ) -> None:
        self.node = node
        self.writer = writer
        self.recorder = recorder
        self.jump_handle = jump_handle
        self._start_time = time.monotonic()
        self._clock = clock
        self._simulated_start_ns = 0 if clock is None else clock.now().nanoseconds

    @property
    def length(self) -> float:
        """The duration of the recording so far, in seconds."""
        return time.monotonic() - self._start_time

    @property
    def simulated_seconds(self) -> float | None:
        """The simulated seconds since the start.

        None means that time is not simulated, or that it was reset.
        """
        if self._clock is None:
            return None
        elapsed = (self._clock.now().nanoseconds - self._simulated_start_ns) / 1e9
        return elapsed if elapsed >= 0 else None


def _make_finding(message: Phrase) -> Diagnostic:
    return Diagnostic("BAG110", message)
