"""The declarations of the page features of this package that are created on demand."""

from linkwright.page.protocol.time import NOTHING_RECORDED
from linkwright.panels.page_feature import OnDemand, list_message_paths

_CALLS = "linkwright.page.protocol.calls"
_CONTROLLERS = "linkwright.page.protocol.controllers"
_EDITING = "linkwright.page.protocol.editing"
_MOTIONS = "linkwright.page.protocol.motion_planning"
_MONITOR = "linkwright.page.protocol.monitor"
_RECORDING = "linkwright.page.protocol.time"
_SOURCES = "linkwright.page.protocol.source_editor"
_TERMINAL = "linkwright.page.protocol.terminal"
_TURTLES = "linkwright.page.protocol.turtlesim"

ON_DEMAND = (
    OnDemand(
        "linkwright.panels.displays:DisplaysFeature",
        (
            "linkwright.page.protocol.configuration:SetProperty",
            "linkwright.page.protocol.robot:MeshStatus",
            "linkwright.page.protocol.markers:MarkerFeedback",
            "linkwright.page.protocol.images:ImageSize",
            *list_message_paths(
                _MOTIONS,
                "AddSceneObject",
                "AttachSceneObject",
                "SelectSceneObject",
                "ChoosePlanner",
                "ChooseQueryState",
                "CommandMotion",
                "MoveSceneObject",
                "RemoveSceneObject",
                "SetQueryJoint",
            ),
        ),
    ),
    OnDemand("linkwright.panels.displays:PointsFeature", ("linkwright.page.protocol.points:RequestPoint",)),
    OnDemand(
        "linkwright.panels.editing.feature:EditingFeature",
        list_message_paths(_EDITING, "ApplyEdit", "PreviewEdit", "RedoEdit", "RequestEditableParts", "UndoEdit"),
    ),
    OnDemand("linkwright.panels.export.feature:ExportFeature", ("linkwright.page.protocol.export:RequestExport",)),
    OnDemand(
        "linkwright.panels.monitor.controllers:ControllersFeature",
        list_message_paths(_CONTROLLERS, "ChangeController", "ChangeHardware", "WatchControllers"),
    ),
    OnDemand("linkwright.panels.monitor.log:LogFeature", list_message_paths(_MONITOR, "WatchLog"), ("/rosout",)),
    OnDemand("linkwright.panels.monitor.node_graph:NodeGraphFeature", list_message_paths(_MONITOR, "WatchNodeGraph")),
    OnDemand(
        "linkwright.panels.monitor.parameters:ParametersFeature",
        list_message_paths(_MONITOR, "DumpParameters", "SetParameter", "WatchParameters"),
    ),
    OnDemand(
        "linkwright.panels.monitor.plots:PlotsFeature", list_message_paths(_MONITOR, "RequestFields", "WatchSeries")
    ),
    OnDemand(
        "linkwright.panels.monitor.publishers:PublishersFeature",
        list_message_paths(_CALLS, "PublishOnce", "RequestTemplate", "RequestTypes", "SetPublishers"),
    ),
    OnDemand(
        "linkwright.panels.monitor.services:ServicesFeature",
        list_message_paths(_CALLS, "CallService", "ChooseService", "WatchServices"),
    ),
    OnDemand("linkwright.panels.monitor.teleop:TeleopFeature", list_message_paths(_MONITOR, "AimTeleop", "Drive")),
    OnDemand(
        "linkwright.panels.monitor.visual_tools:VisualToolsFeature", list_message_paths(_MONITOR, "CommandVisualTools")
    ),
    OnDemand("linkwright.panels.monitor.topics:TopicsFeature", list_message_paths(_MONITOR, "WatchTopics")),
    OnDemand(
        "linkwright.panels.monitor.trajectories:TrajectoriesFeature",
        list_message_paths(_CONTROLLERS, "MoveJoints", "WatchTrajectory"),
    ),
    OnDemand(
        "linkwright.panels.source_editor.feature:SourceEditorFeature",
        list_message_paths(
            _SOURCES,
            "CloseSourceFile",
            "CreateSourceFile",
            "LanguageServerInput",
            "OpenEditor",
            "RequestSourceFile",
            "RequestSourceFolder",
            "ShowUnsavedText",
            "WriteSourceFile",
        ),
    ),
    OnDemand(
        "linkwright.panels.terminal.feature:TerminalFeature",
        list_message_paths(
            _TERMINAL,
            "AcknowledgeTerminal",
            "CloseTerminal",
            "HideTerminal",
            "OpenTerminal",
            "ResizeTerminal",
            "RestartTerminal",
            "ShowTerminal",
            "WatchProgramPages",
            "WriteTerminal",
        ),
    ),
    OnDemand("linkwright.panels.turtlesim:TurtlesimFeature", list_message_paths(_TURTLES, "WatchTurtles")),
    OnDemand(
        "linkwright.panels.recording:RecordingFeature",
        list_message_paths(_RECORDING, "RecordTopics", "StopRecording", "SaveMinutes"),
        until=NOTHING_RECORDED,
        refuses_recordings=True,
    ),
)
