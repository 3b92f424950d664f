"""The live panels: topics, plots, the node graph, parameters, the log and the teleop pad.

A frame of a plot's samples is four uint32 (kind 3, number of series N, 0, 0); then for each series two uint32 (its id,
number of samples M) and float64 3 x M: when each was received and the stamp of its header, both in seconds since the
epoch (NaN where there is no header), and the values. All is little endian.

Values of parameters travel as texts, one an element: 64-bit integers and infinities stay what they are.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import Any, ClassVar, Literal

import numpy as np
from msgspec import field
from numpy.typing import NDArray

from linkwright.page.protocol.message import PageMessage, Record, ServerMessage


class TopicRow(Record):
    """A topic of the graph; several `types` are an error of its users."""

    name: str
    types: list[str]
    publishers: int
    subscribers: int


class TopicTraffic(Record):
    """The traffic of a measured topic: hertz and bytes a second. `error` is why it cannot be measured or shown.

    Both figures are None before there are two messages.
    """

    topic: str
    rate: float | None
    bandwidth: float | None
    error: str | None


class MessageField(Record):
    """A field of a message with its value as text; `omitted` counts elements or fields that are left out."""

    name: str
    kind: str
    value: str
    children: list[MessageField] = field(default_factory=list)
    omitted: int = 0


class TopicList(ServerMessage):
    """All topics, sorted by name."""

    topics: list[TopicRow]


class TopicFigures(ServerMessage):
    """The figures of every topic that the page measures, once a second."""

    traffic: list[TopicTraffic]


class TopicMessage(ServerMessage):
    """The last message of an opened topic, a few times a second at most; `received` is seconds since the epoch."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("topic",)

    topic: str
    received: float
    fields: list[MessageField]


class WatchTopics(PageMessage):
    """Follow topics from now on: their list, the traffic of some, the messages of some."""

    listed: bool
    measured: list[str]
    opened: list[str]


SAMPLES_KIND = 3
_HEADER = struct.Struct("<IIII")
_SERIES = struct.Struct("<II")


class PlotField(Record):
    """A field that can be plotted, in the notation behind the topic's name; `kind` is the type of its values."""

    path: str
    kind: str


class PlotSeries(Record):
    """A series that a page plots; the page chooses the id, which is unique in it."""

    id: int
    topic: str
    path: str


class SeriesState(Record):
    """Why a series has no values; None if it has some, or waits for a first message."""

    id: int
    error: str | None


class TopicFields(ServerMessage):
    """The fields of a topic that can be plotted; answers `AskFields`, and again once the length of arrays is known."""

    topic: str
    kind: str
    fields: list[PlotField]
    error: str | None


class SeriesStates(ServerMessage):
    """The states of the series of a page."""

    states: list[SeriesState]


class AskFields(PageMessage):
    """The user chooses from the fields of a topic; None after the choice."""

    topic: str | None


class WatchSeries(PageMessage):
    """All series that the page plots from now on, and the seconds of the past that it shows."""

    series: list[PlotSeries]
    seconds: float = 30.0


def pack_samples(series: Sequence[tuple[int, NDArray[Any]]]) -> bytes:
    """Return a binary frame of samples.

    Args:
        series: ids, each with an array of shape (3, M): received (s), stamp (s), value.
    """
    parts = [_HEADER.pack(SAMPLES_KIND, len(series), 0, 0)]
    for identity, samples in series:
        parts += [_SERIES.pack(identity, samples.shape[1]), np.ascontiguousarray(samples, dtype="<f8").tobytes()]
    return b"".join(parts)


class GraphTopic(Record):
    """A topic with the full names of its publishers and subscribers."""

    name: str
    types: list[str]
    publishers: list[str]
    subscribers: list[str]


class NodeGraph(ServerMessage):
    """All nodes and topics; sent when the panel opens and when they change."""

    nodes: list[str]
    topics: list[GraphTopic]


class WatchNodeGraph(PageMessage):
    """Whether the page subscribes to the node graph."""

    watched: bool


ParameterKind = Literal[
    "not_set",
    "bool",
    "integer",
    "double",
    "string",
    "byte_array",
    "bool_array",
    "integer_array",
    "double_array",
    "string_array",
]


class ParameterRow(Record):
    """A parameter. `minimum`, `maximum` and `step` are those of its range, as text; empty where there is none."""

    name: str
    kind: ParameterKind
    values: list[str]
    description: str
    constraints: str
    read_only: bool
    minimum: str
    maximum: str
    step: str


class ParameterNodes(ServerMessage):
    """Full names of the nodes that offer their parameters."""

    nodes: list[str]


class NodeParameters(ServerMessage):
    """The parameters of a node, sorted by name; sent when it is watched and on every change. `error`: no answer."""

    node: str
    parameters: list[ParameterRow]
    error: str | None


class ParameterResult(ServerMessage):
    """The outcome of `SetParameter`; `reason` is the node's."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("node", "name")

    node: str
    name: str
    successful: bool
    reason: str


class ParameterDump(ServerMessage):
    """Answers `DumpParameters`: a parameter file, and its name."""

    node: str
    file: str
    text: str
    error: str | None


class WatchParameters(PageMessage):
    """Follow parameters from now on: the list of nodes, and the parameters of one."""

    listed: bool
    node: str | None


class SetParameter(PageMessage):
    """The user edited a parameter."""

    node: str
    name: str
    kind: ParameterKind
    values: list[str]


class DumpParameters(PageMessage):
    """Ask for the parameters of a node as a file."""

    node: str


class LogLine(Record):
    """A record. `level` is rcl_interfaces/msg/Log's: 10 debug, 20 info, 30 warning, 40 error, 50 fatal; `time` in s."""

    level: int
    node: str
    message: str
    time: float
    file: str
    function: str
    line: int


class LogLines(ServerMessage):
    """New records in the order of arrival; `missed` counts those that were too many to send."""

    lines: list[LogLine]
    missed: int


class WatchLog(PageMessage):
    """Whether the page subscribes to new log records."""

    watched: bool


TwistKind = Literal["auto", "Twist", "TwistStamped"]


class TeleopTarget(Record):
    """The topic and type of a pad; `auto` is the type of the topic's subscribers, or Twist without any."""

    topic: str
    kind: TwistKind
    frame_id: str


class TeleopState(ServerMessage):
    """The state of a pad: its type, the number of subscribers, and why it does not publish, if so."""

    topic: str
    kind: str
    subscribers: int
    error: str | None


class AimTeleop(PageMessage):
    """The page opens its pad, or changes its target; None closes it."""

    target: TeleopTarget | None


class Drive(PageMessage):
    """A velocity to publish now: m/s along x, y, z and rad/s around x, y, z. Repeated while one is held.

    Without one for a while, or when the page closes, zero is published.
    """

    linear: list[float]
    angular: list[float]
