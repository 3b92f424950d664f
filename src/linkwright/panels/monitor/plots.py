"""Samples of numeric fields for the page's plots, sent in batches."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import MessageInfo
from linkwright.page.audience import Page
from linkwright.page.protocol.monitor import (
    AskFields,
    PlotSeries,
    SeriesState,
    SeriesStates,
    TopicFields,
    WatchSeries,
    pack_samples,
)
from linkwright.panels.monitor.field_paths import FieldPath, FieldPathError, plot_fields
from linkwright.panels.monitor.past_samples import past_samples, sample_of
from linkwright.panels.monitor.topic_tap import Paced, TopicTap
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.panels.timeline import TimelineFeature
from linkwright.rviz.context import ViewerContext

MOST_SENT = 256
"""Samples of a series in one frame; thirty frames a second hold a topic of 7 kHz in full."""

_MOST_WAITING = 4096


class SampleQueue:
    """A queue of samples, which is thinned out when it gets too long."""

    def __init__(self) -> None:
        self._received: list[float] = []
        self._stamps: list[float] = []
        self._values: list[float] = []

    def __len__(self) -> int:
        return len(self._values)

    def add(self, received: float, stamp: float, value: float) -> None:
        """Add a sample: receive time and header stamp (NaN if there is none) in seconds, and the value."""
        self._received.append(received)
        self._stamps.append(stamp)
        self._values.append(value)
        if len(self._values) >= _MOST_WAITING:
            thinned_out = thinned(self._array(), MOST_SENT).tolist()
            self._received, self._stamps, self._values = thinned_out

    def take(self) -> NDArray[np.float64]:
        """Empty the queue, and return its samples, shape (3, M), thinned out to fit a frame."""
        taken = thinned(self._array(), MOST_SENT)
        self._received, self._stamps, self._values = [], [], []
        return taken

    def _array(self) -> NDArray[np.float64]:
        return np.array([self._received, self._stamps, self._values], dtype=np.float64)


def thinned(samples: NDArray[Any], most: int) -> NDArray[Any]:
    """Return a subset of the samples, of limited size, whose plot looks the same.

    The samples are divided into consecutive groups of equal size. The minimum and the maximum of each group are
    selected, in their order.

    Args:
        samples: array, shape (3, M); the values are in the last row.
        most: the maximum number of samples to return, which must be even.
    """
    count = samples.shape[1]
    if count <= most:
        return samples
    values = samples[-1]
    unknown = np.isnan(values)
    edges = np.linspace(0, count, most // 2 + 1).astype(np.int64)
    chosen: set[int] = set()
    for start, stop in pairwise(edges):
        share, gap = values[start:stop], unknown[start:stop]
        chosen.add(int(start + np.argmin(np.where(gap, np.inf, share))))
        chosen.add(int(start + np.argmax(np.where(gap, -np.inf, share))))
    return samples[:, sorted(chosen)]


_PERIOD = 1 / 30

_MOST_PAST = 2048
"""Samples of a series from before the time that is shown: two for each column of pixels."""

_MOST_PAST_BYTES = 64 << 20
"""The most bytes of messages that are read for past samples."""

_QUIET = 0.1
"""Seconds without another jump of time before the past is read: dragging the timeline makes many jumps."""

_LONGEST_PAST = 600.0
"""Seconds of the past that a page may ask for."""


@dataclass(slots=True)
class _Series:
    """A series that a page plots, with its queued samples."""

    series: PlotSeries
    path: FieldPath | None
    error: str | None
    queue: SampleQueue = field(default_factory=SampleQueue)
    past: NDArray[np.float64] | None = None

    def has_samples(self) -> bool:
        """Return whether there are samples to send."""
        return self.past is not None or len(self.queue) > 0

    def take(self) -> NDArray[np.float64]:
        """Return the samples to send, shape (3, M), and remove them from the queue.

        If there are past samples, they precede the queued ones, and the page restarts the series.
        """
        waiting, past, self.past = self.queue.take(), self.past, None
        return waiting if past is None else np.hstack([past, waiting])

    def forget(self) -> None:
        """Discard the queued and the past samples, because the displayed time has jumped."""
        self.past = None
        self.queue.take()


class _Channel:
    """A topic with all the series that plot its values."""

    def __init__(self, context: ViewerContext, topic: str, came: Callable[[], None]) -> None:
        self._came = came
        self.series: list[_Series] = []
        self.tap = TopicTap(context, topic, self._receive, changed=self._class_changed)

    def add(self, series: _Series) -> None:
        """Begin to add samples of the topic to a series."""
        self.series.append(series)
        self._check(series)

    def remove(self, series: _Series) -> None:
        """Stop adding samples to a series."""
        self.series.remove(series)

    def _class_changed(self) -> None:
        for series in self.series:
            self._check(series)
        self._came()

    def _check(self, series: _Series) -> None:
        """Set the error of a series, or clear it if the path leads to a number in the topic's messages."""
        if series.path is None:
            return
        error = self.tap.error
        if error is None and self.tap.message_class is not None:
            try:
                series.path.check(self.tap.message_class)
            except FieldPathError as problem:
                error = str(problem)
        series.error = error

    def _receive(self, message: Any, info: MessageInfo) -> None:
        values: dict[str, tuple[float, float, float] | None] = {}
        for series in self.series:
            if series.error is not None or series.path is None:
                continue
            text = series.path.text
            if text not in values:
                values[text] = sample_of(series.path, message, info.received_timestamp)
            sample = values[text]
            if sample is not None:
                series.queue.add(*sample)
        self._came()

    def set_past(self, seconds: Callable[[_Series], float], timeline: TimelineFeature) -> None:
        """Add the samples from before the displayed time to the series without errors.

        Args:
            seconds: returns how many seconds of samples a series needs.
            timeline: provides the recorded messages.
        """
        cls = self.tap.message_class
        feeding = [series for series in self.series if series.error is None and series.path is not None]
        if cls is None or not feeding:
            return
        longest = max(map(seconds, feeding))
        messages = timeline.before({self.tap.topic}, longest, _MOST_PAST_BYTES)
        for series in feeding:
            assert series.path is not None
            samples = past_samples(series.path, cls, messages)
            if samples.shape[1] > 0:
                series.forget()  # the past samples include the queued ones
                series.past = thinned(samples, _MOST_PAST)
        self._came()


class _Plots:
    """The series of a page. The frame with their samples is created when the outbox sends it."""

    key = "samples"

    def __init__(self) -> None:
        self.series: dict[int, _Series] = {}
        self.seconds = 0.0
        self.sent: list[SeriesState] = []

    def has_samples(self) -> bool:
        """Return whether there are samples to send."""
        return any(series.has_samples() for series in self.series.values())

    def since(self, seen: int) -> tuple[bytes | None, int]:
        """Return a frame with all queued samples; see `Changes`."""
        ready = [(identity, series.take()) for identity, series in self.series.items() if series.has_samples()]
        return pack_samples(ready) if ready else None, seen


class PlotsFeature(PageFeature):
    """Sends pages the values that they plot; subscribes to a topic while a page plots a series of it."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._pages: dict[Page, _Plots] = {}
        self._channels: dict[str, _Channel] = {}
        self._questions: dict[Page, TopicTap] = {}
        self._turn = Paced(self._send, _PERIOD)
        self._timeline = viewer.add_feature(TimelineFeature)
        self._timeline.jumped.append(self._jumped)
        self._reading: asyncio.TimerHandle | None = None

    def receive(self, page: Page, message: AskFields | WatchSeries) -> None:
        """Send the fields of a topic, or replace the series that a page plots."""
        if isinstance(message, WatchSeries):
            self._watch(page, message.series, message.seconds)
        else:
            self._stop_asking(page)
            if message.topic is not None:
                self._ask(page, message.topic)

    def page_closed(self, page: Page) -> None:
        """Discard the page's series."""
        self._stop_asking(page)
        self._watch(page, [], 0.0)
        self._pages.pop(page, None)

    def close(self) -> None:
        """End all subscriptions."""
        for page in {*self._pages, *self._questions}:
            self.page_closed(page)
        self._turn.cancel()
        self._timeline.jumped.remove(self._jumped)
        if self._reading is not None:
            self._reading.cancel()

    # --- series ------------------------------------------------------------------------------------------------

    def _watch(self, page: Page, requested: list[PlotSeries], seconds: float) -> None:
        plots = self._pages.setdefault(page, _Plots())
        longer = plots.seconds < seconds <= _LONGEST_PAST
        plots.seconds = seconds if 0 < seconds <= _LONGEST_PAST else plots.seconds
        have = plots.series
        asked = {series.id: series for series in requested}
        new = {identity: series for identity, series in asked.items() if self._is_new(have, series)}
        for identity in [identity for identity in have if identity not in asked or identity in new]:
            self._drop(have.pop(identity))
        for identity, series in new.items():
            have[identity] = self._add(series)
        if requested and (new or longer):
            self._read_past_soon()
        if requested:
            plots.sent = []
            self._turn.ask()

    # --- samples from before the displayed time ----------------------------------------------------------------

    def _jumped(self) -> None:
        for plots in self._pages.values():
            for series in plots.series.values():
                series.forget()
        self._read_past_soon()

    def _read_past_soon(self) -> None:
        if self._reading is not None:
            self._reading.cancel()
        self._reading = asyncio.get_running_loop().call_later(_QUIET, self._read_past)

    def _read_past(self) -> None:
        self._reading = None
        seconds = {id(series): plots.seconds for plots in self._pages.values() for series in plots.series.values()}
        for channel in list(self._channels.values()):
            channel.set_past(lambda series: seconds.get(id(series), 0.0), self._timeline)

    @staticmethod
    def _is_new(have: dict[int, _Series], series: PlotSeries) -> bool:
        return series.id not in have or have[series.id].series != series

    def _add(self, requested: PlotSeries) -> _Series:
        try:
            path = FieldPath(requested.path)
        except FieldPathError as error:
            return _Series(requested, None, str(error))
        series = _Series(requested, path, None)
        channel = self._channels.get(requested.topic)
        if channel is None:
            channel = _Channel(self.context, requested.topic, self._turn.ask)
            self._channels[requested.topic] = channel
        channel.add(series)
        return series

    def _drop(self, series: _Series) -> None:
        if series.path is None:
            return
        topic = series.series.topic
        channel = self._channels[topic]
        channel.remove(series)
        if not channel.series:
            del self._channels[topic]
            channel.tap.close()

    def _send(self) -> None:
        for page, plots in self._pages.items():
            states = [SeriesState(identity, series.error) for identity, series in plots.series.items()]
            if states != plots.sent:
                plots.sent = states
                page.send(SeriesStates(states))
            if plots.has_samples():
                page.outbox.put(plots.key, plots)

    # --- fields that can be plotted ----------------------------------------------------------------------------

    def _ask(self, page: Page, topic: str) -> None:
        """Send the fields that can be plotted, and send them again when a message shows the array lengths."""

        def receive(message: Any, _: MessageInfo) -> None:
            page.send(TopicFields(topic, message.TYPE_NAME, plot_fields(type(message), message), None))
            self._stop_asking(page)

        tap = TopicTap(self.context, topic, receive, changed=lambda: page.send(self._answer(tap)))
        self._questions[page] = tap
        page.send(self._answer(tap))

    def _answer(self, tap: TopicTap) -> TopicFields:
        cls = tap.message_class or self._class_without_publishers(tap)
        if tap.error is not None or cls is None:
            return TopicFields(tap.topic, "", [], tap.error)
        return TopicFields(tap.topic, cls.TYPE_NAME, plot_fields(cls), None)

    def _class_without_publishers(self, tap: TopicTap) -> Any:
        """Return the message class that a topic's subscriptions expect, or None if they differ."""
        from linkwright.messages import get_message

        types = self.context.node.graph.topics().get(tap.topic, [])
        try:
            return get_message(types[0]) if len(types) == 1 else None
        except LinkwrightError:
            return None

    def _stop_asking(self, page: Page) -> None:
        tap = self._questions.pop(page, None)
        if tap is not None:
            tap.close()
