"""Parameters of nodes. Values travel as texts, one an element: 64-bit integers and infinities stay what they are."""

from __future__ import annotations

from typing import ClassVar, Literal

from linkwright.viewer.protocol.record import record

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


@record
class ParameterRow:
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


@record
class ParameterNodes:
    """Full names of the nodes whose parameters can be asked for."""

    nodes: list[str]
    type: Literal["parameter_nodes"] = "parameter_nodes"


@record
class NodeParameters:
    """The parameters of a node, sorted by name; sent when it is watched and on every change. `error`: no answer."""

    node: str
    parameters: list[ParameterRow]
    error: str | None
    type: Literal["node_parameters"] = "node_parameters"


@record
class ParameterResult:
    """What came of `SetParameter`; `reason` is the node's."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("node", "name")

    node: str
    name: str
    successful: bool
    reason: str
    type: Literal["parameter_result"] = "parameter_result"


@record
class ParameterDump:
    """Answers `DumpParameters`: a parameter file, and what to call it."""

    node: str
    file: str
    text: str
    error: str | None
    type: Literal["parameter_dump"] = "parameter_dump"


@record
class WatchParameters:
    """What the page wants to know of parameters from now on: the list of nodes, and the parameters of one."""

    listed: bool
    node: str | None
    type: Literal["watch_parameters"] = "watch_parameters"


@record
class SetParameter:
    """The user edited a parameter."""

    node: str
    name: str
    kind: ParameterKind
    values: list[str]
    type: Literal["set_parameter"] = "set_parameter"


@record
class DumpParameters:
    """The user wants the parameters of a node as a file."""

    node: str
    type: Literal["dump_parameters"] = "dump_parameters"
