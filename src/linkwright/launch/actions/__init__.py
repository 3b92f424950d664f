"""The actions of launch files."""

from linkwright.launch.actions.arguments import DeclareLaunchArgument
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
    ResetEnvironment,
    SetEnvironmentVariable,
    UnsetEnvironmentVariable,
)
from linkwright.launch.actions.events import EmitEvent, RegisterEventHandler, Shutdown, UnregisterEventHandler
from linkwright.launch.actions.execute import ExecuteProcess
from linkwright.launch.actions.functions import LogInfo, OpaqueFunction
from linkwright.launch.actions.group import GroupAction
from linkwright.launch.actions.include import IncludeLaunchDescription
from linkwright.launch.actions.timer import TimerAction

__all__ = [
    "AppendEnvironmentVariable",
    "DeclareLaunchArgument",
    "EmitEvent",
    "ExecuteProcess",
    "GroupAction",
    "IncludeLaunchDescription",
    "LogInfo",
    "OpaqueFunction",
    "PopEnvironment",
    "PopLaunchConfigurations",
    "PushEnvironment",
    "PushLaunchConfigurations",
    "RegisterEventHandler",
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
