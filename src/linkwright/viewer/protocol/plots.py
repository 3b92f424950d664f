"""Plots of numeric fields: what can be plotted of a topic, and the samples, which travel as binary frames.

A frame of samples is four uint32 (kind 3, number of series N, 0, 0); then for each series two uint32 (its id, number of
samples M) and float64 3 x M: when each was received and the stamp of its header, both in seconds since the epoch (NaN
where there is no header), and the values. All is little endian.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.viewer.protocol.message import PageMessage, Record, ServerMessage

SAMPLES_KIND = 3
_HEADER = struct.Struct("<IIII")
_SERIES = struct.Struct("<II")


class PlotField(Record):
    """A field that can be plotted, as it is written behind the topic's name; `kind` is the type of its values."""

    path: str
    kind: str


class PlotSeries(Record):
    """A series that a page plots; the page chooses the id, which no other series of it has."""

    id: int
    topic: str
    path: str


class SeriesState(Record):
    """Why a series has no values; None when it has, or when it waits for a first message."""

    id: int
    error: str | None


class TopicFields(ServerMessage):
    """What can be plotted of a topic; answers `AskFields`, and once more when a message tells how long arrays are."""

    topic: str
    kind: str
    fields: list[PlotField]
    error: str | None


class SeriesStates(ServerMessage):
    """How the series of the page are."""

    states: list[SeriesState]


class AskFields(PageMessage):
    """The user chooses from the fields of a topic; None when the choice is over."""

    topic: str | None


class WatchSeries(PageMessage):
    """All series that the page plots from now on."""

    series: list[PlotSeries]


def pack_samples(series: Sequence[tuple[int, NDArray[Any]]]) -> bytes:
    """One binary frame.

    Args:
        series: ids, each with an array of shape (3, M): received (s), stamp (s), value.
    """
    parts = [_HEADER.pack(SAMPLES_KIND, len(series), 0, 0)]
    for identity, samples in series:
        parts += [_SERIES.pack(identity, samples.shape[1]), np.ascontiguousarray(samples, dtype="<f8").tobytes()]
    return b"".join(parts)
