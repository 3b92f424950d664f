"""The substitutions of launch files."""

from linkwright.launch.model.substitutions.command import Command
from linkwright.launch.model.substitutions.configuration import (
    AnonName,
    EnvironmentVariable,
    LaunchConfiguration,
    LaunchLogDir,
    LocalSubstitution,
    ThisLaunchFile,
    ThisLaunchFileDir,
)
from linkwright.launch.model.substitutions.expression import PythonExpression
from linkwright.launch.model.substitutions.logic import (
    AllSubstitution,
    AndSubstitution,
    AnySubstitution,
    EqualsSubstitution,
    IfElseSubstitution,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
)
from linkwright.launch.model.substitutions.loops import ForEachVar, ForLoopIndex
from linkwright.launch.model.substitutions.paths import (
    FileContent,
    FindExecutable,
    FindLaunchfile,
    PathJoinSubstitution,
    PathSubstitution,
)
from linkwright.launch.model.substitutions.strings import (
    IsEmptySubstitution,
    NotEmptySubstitution,
    StringJoinSubstitution,
    StringStripSubstitution,
)

__all__ = [
    "AllSubstitution",
    "AndSubstitution",
    "AnonName",
    "AnySubstitution",
    "Command",
    "EnvironmentVariable",
    "EqualsSubstitution",
    "FileContent",
    "FindExecutable",
    "FindLaunchfile",
    "ForEachVar",
    "ForLoopIndex",
    "IfElseSubstitution",
    "IsEmptySubstitution",
    "LaunchConfiguration",
    "LaunchLogDir",
    "LocalSubstitution",
    "NotEmptySubstitution",
    "NotEqualsSubstitution",
    "NotSubstitution",
    "OrSubstitution",
    "PathJoinSubstitution",
    "PathSubstitution",
    "PythonExpression",
    "StringJoinSubstitution",
    "StringStripSubstitution",
    "ThisLaunchFile",
    "ThisLaunchFileDir",
]
