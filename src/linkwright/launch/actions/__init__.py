"""The actions of launch files."""

from linkwright.launch.actions.arguments import DeclareBooleanLaunchArgument, DeclareLaunchArgument
from linkwright.launch.actions.configurations import (
    PopLaunchConfigurations,
    PushLaunchConfigurations,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
    UnsetLaunchConfiguration,
)
from linkwright.launch.actions.environment import (
    AppendEnvironmentVariable,
    PopEnvironment,
    PushEnvironment,
    ReplaceEnvironmentVariables,
    ResetEnvironment,
    SetEnvironmentVariable,
    UnsetEnvironmentVariable,
)
from linkwright.launch.actions.events import EmitEvent, RegisterEventHandler, Shutdown, UnregisterEventHandler
from linkwright.launch.actions.execute import ExecuteLocal, ExecuteProcess
from linkwright.launch.actions.functions import OpaqueCoroutine, OpaqueFunction
from linkwright.launch.actions.group import GroupAction
from linkwright.launch.actions.include import IncludeLaunchDescription, IncludeScopedLaunchDescription
from linkwright.launch.actions.log import Log, LogDebug, LogError, LogInfo, LogWarning
from linkwright.launch.actions.loops import ForEach, ForLoop
from linkwright.launch.actions.timer import TimerAction

__all__ = [
    "AppendEnvironmentVariable",
    "DeclareBooleanLaunchArgument",
    "DeclareLaunchArgument",
    "EmitEvent",
    "ExecuteLocal",
    "ExecuteProcess",
    "ForEach",
    "ForLoop",
    "GroupAction",
    "IncludeLaunchDescription",
    "IncludeScopedLaunchDescription",
    "Log",
    "LogDebug",
    "LogError",
    "LogInfo",
    "LogWarning",
    "OpaqueCoroutine",
    "OpaqueFunction",
    "PopEnvironment",
    "PopLaunchConfigurations",
    "PushEnvironment",
    "PushLaunchConfigurations",
    "RegisterEventHandler",
    "ReplaceEnvironmentVariables",
    "ResetEnvironment",
    "ResetLaunchConfigurations",
    "SetEnvironmentVariable",
    "SetLaunchConfiguration",
    "Shutdown",
    "TimerAction",
    "UnregisterEventHandler",
    "UnsetEnvironmentVariable",
    "UnsetLaunchConfiguration",
]
