"""Parameters of nodes. Values travel as texts, one an element: 64-bit integers and infinities stay what they are."""

from __future__ import annotations

from typing import ClassVar, Literal

from linkwright.viewer.protocol.message import PageMessage, Record, ServerMessage

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
    """Full names of the nodes whose parameters can be asked for."""

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
    """Answers `DumpParameters`: a parameter file, and what to call it."""

    node: str
    file: str
    text: str
    error: str | None


class WatchParameters(PageMessage):
    """What the page wants to know of parameters from now on: the list of nodes, and the parameters of one."""

    listed: bool
    node: str | None


class SetParameter(PageMessage):
    """The user edited a parameter."""

    node: str
    name: str
    kind: ParameterKind
    values: list[str]


class DumpParameters(PageMessage):
    """The user wants the parameters of a node as a file."""

    node: str
