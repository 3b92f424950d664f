"""The type aliases of ``launch_ros`` for parameters and remappings."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from linkwright.launch.model.substitution import SomeSubstitutionsType, Substitution
from linkwright.launch.ros import Parameter as ParameterDescription
from linkwright.launch.ros import ParameterFile
from linkwright.launch.ros import ParameterValue as ParameterValueDescription

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

SomeRemapRule = tuple[SomeSubstitutionsType, SomeSubstitutionsType]
SomeRemapRules = Iterable[SomeRemapRule]
RemapRule = tuple[Sequence[Substitution], Sequence[Substitution]]
RemapRules = Sequence[RemapRule]
