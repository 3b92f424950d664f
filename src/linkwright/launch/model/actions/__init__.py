"""The actions of launch files."""

from linkwright.launch.model.actions.arguments import DeclareBooleanLaunchArgument, DeclareLaunchArgument
from linkwright.launch.model.actions.configurations import (
    PopLaunchConfigurations,
    PushLaunchConfigurations,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
    UnsetLaunchConfiguration,
)
from linkwright.launch.model.actions.environment import (
    AppendEnvironmentVariable,
    PopEnvironment,
    PushEnvironment,
    ReplaceEnvironmentVariables,
    ResetEnvironment,
    SetEnvironmentVariable,
    UnsetEnvironmentVariable,
)
from linkwright.launch.model.actions.events import EmitEvent, RegisterEventHandler, Shutdown, UnregisterEventHandler
from linkwright.launch.model.actions.execute import ExecuteLocal, ExecuteProcess
from linkwright.launch.model.actions.functions import OpaqueCoroutine, OpaqueFunction
from linkwright.launch.model.actions.group import GroupAction
from linkwright.launch.model.actions.log import Log, LogDebug, LogError, LogInfo, LogWarning
from linkwright.launch.model.actions.loops import ForEach, ForLoop
from linkwright.launch.model.actions.timer import TimerAction

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
