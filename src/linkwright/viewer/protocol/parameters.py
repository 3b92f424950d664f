"""Parameters of nodes. Values travel as texts, one an element: 64-bit integers and infinities stay what they are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

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


@dataclass(slots=True)
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


@dataclass(slots=True)
class ParameterNodes:
    """Full names of the nodes whose parameters can be asked for."""

    nodes: list[str]
    type: Literal["parameter_nodes"] = "parameter_nodes"


@dataclass(slots=True)
class NodeParameters:
    """The parameters of a node, sorted by name; sent when it is watched and on every change. `error`: no answer."""

    node: str
    parameters: list[ParameterRow]
    error: str | None
    type: Literal["node_parameters"] = "node_parameters"


@dataclass(slots=True)
class ParameterResult:
    """What came of `SetParameter`; `reason` is the node's."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("node", "name")

    node: str
    name: str
    successful: bool
    reason: str
    type: Literal["parameter_result"] = "parameter_result"


@dataclass(slots=True)
class ParameterDump:
    """Answers `DumpParameters`: a parameter file, and what to call it."""

    node: str
    file: str
    text: str
    error: str | None
    type: Literal["parameter_dump"] = "parameter_dump"


@dataclass(slots=True)
class WatchParameters:
    """What the page wants to know of parameters from now on: the list of nodes, and the parameters of one."""

    listed: bool
    node: str | None
    type: Literal["watch_parameters"] = "watch_parameters"


@dataclass(slots=True)
class SetParameter:
    """The user edited a parameter."""

    node: str
    name: str
    kind: ParameterKind
    values: list[str]
    type: Literal["set_parameter"] = "set_parameter"


@dataclass(slots=True)
class DumpParameters:
    """The user wants the parameters of a node as a file."""

    node: str
    type: Literal["dump_parameters"] = "dump_parameters"
