"""The live panels: topics, plots, the node graph, parameters, the log and the teleop pad.

A frame with the samples of plots is four uint32 (kind 3, number of series N, 0, 0), and then for each series two uint32
(its ID, number of samples M) and 3 x M float64: the receive times and the stamps in the headers, both in seconds since
the epoch (NaN without a header), and the values. All numbers are little endian.

Parameter values are sent as texts, one for each element, which preserves 64-bit integers and infinities.
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
    """A topic of the graph. `types` has several items if nodes use different types for it."""

    name: str
    types: list[str]
    publishers: int
    subscribers: int


class TopicTraffic(Record):
    """The traffic of a measured topic: the rate in Hz, and bytes per second.

    Both values are None until the topic has been measured for long enough. `error` is the reason why the topic cannot
    be measured or shown.
    """

    topic: str
    rate: float | None
    bandwidth: float | None
    error: str | None


class MessageField(Record):
    """A field of a message with its value as text.

    `omitted` is the number of omitted elements or fields.
    """

    name: str
    kind: str
    value: str
    children: list[MessageField] = field(default_factory=list)
    omitted: int = 0


class TopicList(ServerMessage):
    """All topics, sorted by name."""

    topics: list[TopicRow]


class TopicFigures(ServerMessage):
    """The traffic of every topic that the page measures, sent once per second."""

    traffic: list[TopicTraffic]


class TopicMessage(ServerMessage):
    """The last message of an opened topic, sent at most a few times per second.

    `received` is in seconds since the epoch.
    """

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("topic",)

    topic: str
    received: float
    fields: list[MessageField]


class WatchTopics(PageMessage):
    """The topics that the page measures, shows with messages, and lists from now on."""

    wants_list: bool
    measured_topics: list[str]
    opened_topics: list[str]


SAMPLES_KIND = 3
_HEADER = struct.Struct("<IIII")
_SERIES = struct.Struct("<II")


class PlotField(Record):
    """A field that can be plotted, with its path in the message.

    `kind` is the type of the values of the field.
    """

    path: str
    kind: str


class PlotSeries(Record):
    """A series that a page plots, with an ID chosen by the page."""

    id: int
    topic: str
    path: str


class SeriesState(Record):
    """The state of a series: the reason why it cannot have values, or None.

    `error` is None if the series has values or is waiting for its first message.
    """

    id: int
    error: str | None


class TopicFields(ServerMessage):
    """The fields of a topic that can be plotted. Response to `RequestFields`.

    The message is sent again when the lengths of arrays are known.
    """

    topic: str
    kind: str
    fields: list[PlotField]
    error: str | None


class SeriesStates(ServerMessage):
    """The states of a page's series."""

    states: list[SeriesState]


class RequestFields(PageMessage):
    """A request for the fields of a topic.

    `topic` is None once the user has chosen a field, so that the server stops reading the topic.
    """

    topic: str | None


class WatchSeries(PageMessage):
    """All series that the page plots from now on, and the shown duration in seconds."""

    series: list[PlotSeries]
    seconds: float = 30.0


def pack_samples(series: Sequence[tuple[int, NDArray[Any]]]) -> bytes:
    """Return a binary frame with the samples of plots, in the layout that this module describes.

    Args:
        series: the IDs of series, each with an array of shape (3, M): receive times in s, stamps in s, values.
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
    """All nodes and topics, sent when the panel is opened and after each change."""

    nodes: list[str]
    topics: list[GraphTopic]


class WatchNodeGraph(PageMessage):
    """Whether the page receives the node graph from now on."""

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
    """A parameter of a node.

    `minimum`, `maximum` and `step` are the range of the parameter as text. They are empty if there is no range.
    """

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
    """The full names of the nodes that have parameter services."""

    nodes: list[str]


class NodeParameters(ServerMessage):
    """The parameters of a node, sorted by name.

    They are sent when the page selects the node, and on every change.

    `error` is the reason why the parameters are not known, or None.
    """

    node: str
    parameters: list[ParameterRow]
    error: str | None


class ParameterResult(ServerMessage):
    """The outcome of `SetParameter`. `reason` is the reason why the parameter was not set."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("node", "name")

    node: str
    name: str
    successful: bool
    reason: str


class ParameterDump(ServerMessage):
    """The text and the name of a parameter file. Response to `DumpParameters`."""

    node: str
    file: str
    text: str
    error: str | None


class WatchParameters(PageMessage):
    """Whether the page receives the list of nodes from now on, and whose parameters it shows."""

    wants_list: bool
    node: str | None


class SetParameter(PageMessage):
    """A parameter value that the user has entered."""

    node: str
    name: str
    kind: ParameterKind
    values: list[str]


class DumpParameters(PageMessage):
    """A request for the parameters of a node as a file."""

    node: str


class LogLine(Record):
    """A log record.

    `level` is as in rcl_interfaces/msg/Log: 10 debug, 20 info, 30 warning, 40 error, 50 fatal. `time` is in seconds
    since the epoch.
    """

    level: int
    node: str
    message: str
    time: float
    file: str
    function: str
    line: int


class LogLines(ServerMessage):
    """New log records in the order of arrival.

    `missed` is the number of records that could not be sent.
    """

    lines: list[LogLine]
    missed: int


class WatchLog(PageMessage):
    """Whether the page receives new log records from now on."""

    watched: bool


TwistKind = Literal["auto", "Twist", "TwistStamped"]


class TeleopTarget(Record):
    """The topic and the message type of a teleop pad.

    `auto` selects the type of the topic's subscriptions, by default Twist.
    """

    topic: str
    kind: TwistKind
    frame_id: str


class TeleopState(ServerMessage):
    """The state of a teleop pad: message type, subscribers, and the reason for a failure."""

    topic: str
    kind: str
    subscribers: int
    error: str | None


class CommandVisualTools(PageMessage):
    """A button of the panel of rviz_visual_tools; ``open`` gets ready for the buttons that follow."""

    command: Literal["open", "next", "continue", "break", "stop"]


class AimTeleop(PageMessage):
    """The topic and type of the page's teleop pad, or None when the pad is closed."""

    target: TeleopTarget | None


class Drive(PageMessage):
    """A velocity to publish now: m/s along x, y, z and rad/s about x, y, z.

    The page sends the velocity repeatedly while the user holds the control. If no velocity arrives for a while, or the
    page closes, zero is published.
    """

    linear: list[float]
    angular: list[float]
