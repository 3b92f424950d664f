"""Samples of numeric fields for the page's plots, in batches."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import MessageInfo
from linkwright.viewer.context import ViewerContext
from linkwright.viewer.features.monitor.field_list import plot_fields
from linkwright.viewer.features.monitor.field_paths import FieldPath, FieldPathError
from linkwright.viewer.features.monitor.pacing import Paced
from linkwright.viewer.features.monitor.samples import SampleQueue
from linkwright.viewer.features.monitor.topic_tap import TopicTap
from linkwright.viewer.features.page_feature import FeatureHost, PageFeature
from linkwright.viewer.protocol.plots import (
    AskFields,
    PlotSeries,
    SeriesState,
    SeriesStates,
    TopicFields,
    WatchSeries,
    pack_samples,
)
from linkwright.viewer.web.audience import Page

_PERIOD = 1 / 30
_NANO = 1e-9


@dataclass(slots=True)
class _Series:
    """One series of one page."""

    wanted: PlotSeries
    path: FieldPath | None
    error: str | None
    queue: SampleQueue = field(default_factory=SampleQueue)


class _Channel:
    """One topic with all the series that take numbers from it."""

    def __init__(self, context: ViewerContext, topic: str, came: Callable[[], None]) -> None:
        self._came = came
        self.series: list[_Series] = []
        self.changed = False
        self.tap = TopicTap(context, topic, self._take, changed=self._class_changed)

    def add(self, series: _Series) -> None:
        """Feed a series from the topic."""
        self.series.append(series)
        self._check(series)

    def remove(self, series: _Series) -> None:
        """Stop feeding a series."""
        self.series.remove(series)

    def _class_changed(self) -> None:
        for series in self.series:
            self._check(series)
        self._came()

    def _check(self, series: _Series) -> None:
        """Find out whether the path leads to a number of the topic's messages."""
        if series.path is None:
            return
        error = self.tap.error
        if error is None and self.tap.message_class is not None:
            try:
                series.path.check(self.tap.message_class)
            except FieldPathError as problem:
                error = str(problem)
        series.error = error

    def _take(self, message: Any, info: MessageInfo) -> None:
        received = info.received_timestamp * _NANO
        header = getattr(message, "header", None)
        stamp = getattr(header, "stamp", None)
        stamped = math.nan if stamp is None else stamp.nanoseconds * _NANO
        values: dict[str, float | None] = {}
        for series in self.series:
            if series.error is not None or series.path is None:
                continue
            text = series.path.text
            if text not in values:
                values[text] = series.path.value(message)
            value = values[text]
            if value is not None:
                series.queue.add(received, stamped, value)
        self._came()


class _Plots:
    """What one page plots. The frame with its samples is made when its turn in the outbox comes."""

    key = "samples"

    def __init__(self) -> None:
        self.series: dict[int, _Series] = {}
        self.told: list[SeriesState] = []

    def has_samples(self) -> bool:
        """Whether there is something to send."""
        return any(len(series.queue) for series in self.series.values())

    def since(self, seen: int) -> tuple[bytes | None, int]:
        """The frame with all samples that wait; see `Changes`."""
        ready = [(identity, series.queue.take()) for identity, series in self.series.items() if len(series.queue)]
        return pack_samples(ready) if ready else None, seen


class PlotsFeature(PageFeature):
    """Sends pages the numbers that they plot; a topic is subscribed to while a page has a series of it."""

    RECEIVES = (AskFields, WatchSeries)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._pages: dict[Page, _Plots] = {}
        self._channels: dict[str, _Channel] = {}
        self._questions: dict[Page, TopicTap] = {}
        self._turn = Paced(self._send, _PERIOD)

    def receive(self, page: Page, message: AskFields | WatchSeries) -> None:
        """Do what a page asks for."""
        if isinstance(message, WatchSeries):
            self._watch(page, message.series)
        else:
            self._stop_asking(page)
            if message.topic is not None:
                self._ask(page, message.topic)

    def page_gone(self, page: Page) -> None:
        """Forget the page's series."""
        self._stop_asking(page)
        self._watch(page, [])
        self._pages.pop(page, None)

    def close(self) -> None:
        """End all subscriptions."""
        for page in {*self._pages, *self._questions}:
            self.page_gone(page)
        self._turn.cancel()

    # --- series ------------------------------------------------------------------------------------------------

    def _watch(self, page: Page, wanted: list[PlotSeries]) -> None:
        plots = self._pages.setdefault(page, _Plots())
        have = plots.series
        asked = {series.id: series for series in wanted}
        new = {identity: series for identity, series in asked.items() if self._is_new(have, series)}
        for identity in [identity for identity in have if identity not in asked or identity in new]:
            self._drop(have.pop(identity))
        for identity, series in new.items():
            have[identity] = self._add(series)
        if wanted:
            plots.told = []
            self._turn.ask()

    @staticmethod
    def _is_new(have: dict[int, _Series], series: PlotSeries) -> bool:
        return series.id not in have or have[series.id].wanted != series

    def _add(self, wanted: PlotSeries) -> _Series:
        try:
            path = FieldPath(wanted.path)
        except FieldPathError as error:
            return _Series(wanted, None, str(error))
        series = _Series(wanted, path, None)
        channel = self._channels.get(wanted.topic)
        if channel is None:
            channel = _Channel(self.context, wanted.topic, self._turn.ask)
            self._channels[wanted.topic] = channel
        channel.add(series)
        return series

    def _drop(self, series: _Series) -> None:
        if series.path is None:
            return
        topic = series.wanted.topic
        channel = self._channels[topic]
        channel.remove(series)
        if not channel.series:
            del self._channels[topic]
            channel.tap.close()

    def _send(self) -> None:
        for page, plots in self._pages.items():
            states = [SeriesState(identity, series.error) for identity, series in plots.series.items()]
            if states != plots.told:
                plots.told = states
                page.send(SeriesStates(states))
            if plots.has_samples():
                page.outbox.put(plots.key, plots)

    # --- what can be plotted -----------------------------------------------------------------------------------

    def _ask(self, page: Page, topic: str) -> None:
        """Answer what can be plotted of a topic, and again with what its first message tells of arrays."""

        def take(message: Any, _: MessageInfo) -> None:
            page.send(TopicFields(topic, message.TYPE_NAME, plot_fields(type(message), message), None))
            self._stop_asking(page)

        tap = TopicTap(self.context, topic, take, changed=lambda: page.send(self._answer(tap)))
        self._questions[page] = tap
        page.send(self._answer(tap))

    def _answer(self, tap: TopicTap) -> TopicFields:
        cls = tap.message_class or self._class_without_publishers(tap)
        if tap.error is not None or cls is None:
            return TopicFields(tap.topic, "", [], tap.error)
        return TopicFields(tap.topic, cls.TYPE_NAME, plot_fields(cls), None)

    def _class_without_publishers(self, tap: TopicTap) -> Any:
        """The class of a topic that only has subscribers so far; None when they do not tell."""
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
