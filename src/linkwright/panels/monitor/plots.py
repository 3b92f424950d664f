"""Sends samples of numeric fields to pages, in batches, for their plots."""

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
    PlotSeries,
    RequestFields,
    SeriesState,
    SeriesStates,
    TopicFields,
    WatchSeries,
    pack_samples,
)
from linkwright.panels.monitor.field_paths import FieldPath, FieldPathError, find_plot_fields
from linkwright.panels.monitor.past_samples import read_past_samples, read_sample
from linkwright.panels.monitor.topic_tap import RateLimiter, TopicTap
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.panels.timeline import TimelineFeature
from linkwright.rviz.context import ViewerContext

MAX_SENT_SAMPLES = 256
"""The largest number of samples of a series in a frame. 30 frames a second are enough for a topic at 7 kHz."""

_MAX_QUEUED = 4096


class SampleQueue:
    """A queue of samples that is thinned out when it is too long."""

    def __init__(self) -> None:
        self._received: list[float] = []
        self._stamps: list[float] = []
        self._values: list[float] = []

    def __len__(self) -> int:
        return len(self._values)

    def add(self, received: float, stamp: float, value: float) -> None:
        """Add a sample: receive time, stamp (or NaN), both in seconds since the epoch, and value."""
        self._received.append(received)
        self._stamps.append(stamp)
        self._values.append(value)
        if len(self._values) >= _MAX_QUEUED:
            thinned_samples = thin_out(self._to_array(), MAX_SENT_SAMPLES).tolist()
            self._received, self._stamps, self._values = thinned_samples

    def take(self) -> NDArray[np.float64]:
        """Remove and return all samples, shape (3, M), thinned out to fit a frame."""
        samples = thin_out(self._to_array(), MAX_SENT_SAMPLES)
        self._received, self._stamps, self._values = [], [], []
        return samples

    def _to_array(self) -> NDArray[np.float64]:
        return np.array([self._received, self._stamps, self._values], dtype=np.float64)


def thin_out(samples: NDArray[Any], max_count: int) -> NDArray[Any]:
    """Return a limited number of samples with nearly the same plot as all samples.

    The samples are divided into consecutive groups of equal size. The minimum and the maximum of each group are
    selected, in their original order.

    Args:
        samples: array, shape (3, M); the values are in the last row.
        max_count: the maximum number of samples to return; must be even.
    """
    count = samples.shape[1]
    if count <= max_count:
        return samples
    values = samples[-1]
    is_unknown = np.isnan(values)
    boundaries = np.linspace(0, count, max_count // 2 + 1).astype(np.int64)
    selected: set[int] = set()
    for start, stop in pairwise(boundaries):
        group, is_gap = values[start:stop], is_unknown[start:stop]
        selected.add(int(start + np.argmin(np.where(is_gap, np.inf, group))))
        selected.add(int(start + np.argmax(np.where(is_gap, -np.inf, group))))
    return samples[:, sorted(selected)]


_SEND_PERIOD_S = 1 / 30

_MAX_PAST_SAMPLES = 2048
"""The largest number of past samples of a series, about two for each column of pixels."""

_MAX_PAST_BYTES = 64 << 20
"""The largest total size in bytes of the messages that are read for past samples."""

_QUIET_S = 0.1
"""Seconds without a jump of time before past samples are read, because dragging causes many jumps."""

_MAX_PAST_S = 600.0
"""The longest duration of past samples that a page may request, in seconds."""


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

        If there are past samples, they precede the queued samples, and the page restarts the series.
        """
        queued_samples, past, self.past = self.queue.take(), self.past, None
        return queued_samples if past is None else np.hstack([past, queued_samples])

    def clear(self) -> None:
        """Discard the queued and the past samples, because the displayed time has jumped."""
        self.past = None
        self.queue.take()


class _PlottedTopic:
    """A topic and all series that plot its values."""

    def __init__(self, context: ViewerContext, topic: str, on_samples: Callable[[], None]) -> None:
        self._on_samples = on_samples
        self.series: list[_Series] = []
        self.tap = TopicTap(context, topic, self._receive, on_change=self._on_class_change)

    def add(self, series: _Series) -> None:
        """Start adding samples of the topic to a series."""
        self.series.append(series)
        self._check(series)

    def remove(self, series: _Series) -> None:
        """Stop adding samples to a series."""
        self.series.remove(series)

    def _on_class_change(self) -> None:
        for series in self.series:
            self._check(series)
        self._on_samples()

    def _check(self, series: _Series) -> None:
        """Set the error of a series, or clear it if its path leads to a number."""
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
                values[text] = read_sample(series.path, message, info.received_timestamp)
            sample = values[text]
            if sample is not None:
                series.queue.add(*sample)
        self._on_samples()

    def set_past(self, seconds: Callable[[_Series], float], timeline: TimelineFeature) -> None:
        """Add samples from before the displayed time to all series without an error.

        Args:
            seconds: returns the duration in seconds of the past samples that a series needs.
            timeline: provides the recorded messages.
        """
        cls = self.tap.message_class
        valid_series = [series for series in self.series if series.error is None and series.path is not None]
        if cls is None or not valid_series:
            return
        longest_duration = max(map(seconds, valid_series))
        messages = timeline.messages_before({self.tap.topic}, longest_duration, _MAX_PAST_BYTES)
        for series in valid_series:
            assert series.path is not None
            samples = read_past_samples(series.path, cls, messages)
            if samples.shape[1] > 0:
                series.clear()  # the past samples include the queued samples
                series.past = thin_out(samples, _MAX_PAST_SAMPLES)
        self._on_samples()


class _PagePlots:
    """The series that a page plots.

    The frame with their samples is created when the outbox sends it.
    """

    key = "samples"

    def __init__(self) -> None:
        self.series: dict[int, _Series] = {}
        self.seconds = 0.0
        self.sent: list[SeriesState] = []

    def has_samples(self) -> bool:
        """Return whether there are samples to send."""
        return any(series.has_samples() for series in self.series.values())

    def since(self, seen: int) -> tuple[bytes | None, int]:
        """Return a frame with all queued samples. See `Changes`."""
        samples_by_series = [
            (identity, series.take()) for identity, series in self.series.items() if series.has_samples()
        ]
        return pack_samples(samples_by_series) if samples_by_series else None, seen


class PlotsFeature(PageFeature):
    """The feature that sends the values of plots to pages.

    The feature subscribes to a topic only while a page plots a series of the topic.
    """

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._pages: dict[Page, _PagePlots] = {}
        self._channels: dict[str, _PlottedTopic] = {}
        self._field_taps: dict[Page, TopicTap] = {}
        self._sender = RateLimiter(self._send, _SEND_PERIOD_S)
        self._timeline = viewer.add_feature(TimelineFeature)
        self._timeline.on_jump.append(self._on_jump)
        self._read_timer: asyncio.TimerHandle | None = None

    def receive(self, page: Page, message: RequestFields | WatchSeries) -> None:
        """Send the fields of a topic, or replace the series that a page plots."""
        if isinstance(message, WatchSeries):
            self._watch(page, message.series, message.seconds)
        else:
            self._close_field_tap(page)
            if message.topic is not None:
                self._send_fields(page, message.topic)

    def remove_page(self, page: Page) -> None:
        """Discard the page's series."""
        self._close_field_tap(page)
        self._watch(page, [], 0.0)
        self._pages.pop(page, None)

    def close(self) -> None:
        """End all subscriptions."""
        for page in {*self._pages, *self._field_taps}:
            self.remove_page(page)
        self._sender.cancel()
        self._timeline.on_jump.remove(self._on_jump)
        if self._read_timer is not None:
            self._read_timer.cancel()

    # --- series ------------------------------------------------------------------------------------------------

    def _watch(self, page: Page, requested: list[PlotSeries], seconds: float) -> None:
        plots = self._pages.setdefault(page, _PagePlots())
        is_longer = plots.seconds < seconds <= _MAX_PAST_S
        plots.seconds = seconds if 0 < seconds <= _MAX_PAST_S else plots.seconds
        plotted_series = plots.series
        requested_by_id = {series.id: series for series in requested}
        new_series = {
            identity: series for identity, series in requested_by_id.items() if self._is_new(plotted_series, series)
        }
        for identity in [
            identity for identity in plotted_series if identity not in requested_by_id or identity in new_series
        ]:
            self._drop(plotted_series.pop(identity))
        for identity, series in new_series.items():
            plotted_series[identity] = self._add(series)
        if requested and (new_series or is_longer):
            self._schedule_read()
        if requested:
            plots.sent = []
            self._sender.request()

    # --- samples from before the displayed time ----------------------------------------------------------------

    def _on_jump(self) -> None:
        for plots in self._pages.values():
            for series in plots.series.values():
                series.clear()
        self._schedule_read()

    def _schedule_read(self) -> None:
        if self._read_timer is not None:
            self._read_timer.cancel()
        self._read_timer = asyncio.get_running_loop().call_later(_QUIET_S, self._read_past)

    def _read_past(self) -> None:
        self._read_timer = None
        seconds = {id(series): plots.seconds for plots in self._pages.values() for series in plots.series.values()}
        for channel in list(self._channels.values()):
            channel.set_past(lambda series: seconds.get(id(series), 0.0), self._timeline)

    @staticmethod
    def _is_new(plotted_series: dict[int, _Series], series: PlotSeries) -> bool:
        return series.id not in plotted_series or plotted_series[series.id].series != series

    def _add(self, requested: PlotSeries) -> _Series:
        try:
            path = FieldPath(requested.path)
        except FieldPathError as error:
            return _Series(requested, None, str(error))
        series = _Series(requested, path, None)
        channel = self._channels.get(requested.topic)
        if channel is None:
            channel = _PlottedTopic(self.context, requested.topic, self._sender.request)
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

    def _send_fields(self, page: Page, topic: str) -> None:
        """Send the fields that can be plotted, now and after the first message.

        The message has the lengths of arrays.
        """

        def receive(message: Any, _: MessageInfo) -> None:
            page.send(TopicFields(topic, message.TYPE_NAME, find_plot_fields(type(message), message), None))
            self._close_field_tap(page)

        tap = TopicTap(self.context, topic, receive, on_change=lambda: page.send(self._make_fields_message(tap)))
        self._field_taps[page] = tap
        page.send(self._make_fields_message(tap))

    def _make_fields_message(self, tap: TopicTap) -> TopicFields:
        cls = tap.message_class or self._find_class_without_publishers(tap)
        if tap.error is not None or cls is None:
            return TopicFields(tap.topic, "", [], tap.error)
        return TopicFields(tap.topic, cls.TYPE_NAME, find_plot_fields(cls), None)

    def _find_class_without_publishers(self, tap: TopicTap) -> Any:
        """Return the message class of a topic's subscriptions, or None if they differ in class."""
        from linkwright.messages import get_message

        types = self.context.node.graph.topics().get(tap.topic, [])
        try:
            return get_message(types[0]) if len(types) == 1 else None
        except LinkwrightError:
            return None

    def _close_field_tap(self, page: Page) -> None:
        tap = self._field_taps.pop(page, None)
        if tap is not None:
            tap.close()
