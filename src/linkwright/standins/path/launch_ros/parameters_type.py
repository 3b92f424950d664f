"""Stands in for ``launch_ros.parameters_type``."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution

from linkwright.launch.ros import Parameter as ParameterDescription
from linkwright.launch.ros import ParameterFile
from linkwright.launch.ros import ParameterValue as ParameterValueDescription
from linkwright.standins.launch_names import imported_there as __getattr__

SingleValueType = str | int | float | bool
MultiValueType = Sequence[str] | Sequence[int] | Sequence[float] | Sequence[bool] | bytes

SomeParameterFile = SomeSubstitutionsType | Path | ParameterFile
SomeParameterName = Sequence[Substitution | str]
SomeParameterValue = (
    ParameterValueDescription
    | SomeSubstitutionsType
    | Sequence[SomeSubstitutionsType]
    | SingleValueType
    | MultiValueType
)
SomeParametersDict = Mapping[SomeParameterName, Any]
SomeParameters = Sequence[SomeParameterFile | ParameterDescription | Mapping[SomeParameterName, SomeParameterValue]]

ParameterName = Sequence[Substitution]
ParameterValue = Sequence[Substitution] | Sequence[Sequence[Substitution]] | SingleValueType | MultiValueType
ParametersDict = dict[ParameterName, ParameterValue]
Parameters = Sequence[ParameterFile | ParametersDict | ParameterDescription]

EvaluatedParameterValue = SingleValueType | MultiValueType
EvaluatedParameters = Sequence[Path | ParameterDescription | dict[str, EvaluatedParameterValue]]

__all__ = [
    "EvaluatedParameterValue",
    "EvaluatedParameters",
    "MultiValueType",
    "ParameterDescription",
    "ParameterFile",
    "ParameterName",
    "ParameterValue",
    "ParameterValueDescription",
    "Parameters",
    "ParametersDict",
    "SingleValueType",
    "SomeParameterFile",
    "SomeParameterName",
    "SomeParameterValue",
    "SomeParameters",
    "SomeParametersDict",
]
