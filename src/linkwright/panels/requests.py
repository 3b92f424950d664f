"""The declarations of the page features of this package that are created on demand."""

from linkwright.page.protocol.time import NOTHING_RECORDED
from linkwright.panels.page_feature import OnDemand, messages

_EDITING = "linkwright.page.protocol.editing"
_MONITOR = "linkwright.page.protocol.monitor"
_RECORDING = "linkwright.page.protocol.time"
_SOURCES = "linkwright.page.protocol.source_editor"
_TERMINAL = "linkwright.page.protocol.terminal"

ON_DEMAND = (
    OnDemand(
        "linkwright.panels.displays:DisplaysFeature",
        (
            "linkwright.page.protocol.configuration:SetProperty",
            "linkwright.page.protocol.robot:MeshStatus",
            "linkwright.page.protocol.markers:MarkerFeedback",
            "linkwright.page.protocol.images:ImageSize",
        ),
    ),
    OnDemand("linkwright.panels.displays:PointsFeature", ("linkwright.page.protocol.points:RequestPoint",)),
    OnDemand(
        "linkwright.panels.editing.feature:EditingFeature",
        messages(_EDITING, "ApplyEdit", "PreviewEdit", "RedoEdit", "RequestEditableParts", "UndoEdit"),
    ),
    OnDemand("linkwright.panels.export.feature:ExportFeature", ("linkwright.page.protocol.export:RequestExport",)),
    OnDemand("linkwright.panels.monitor.log:LogFeature", messages(_MONITOR, "WatchLog"), ("/rosout",)),
    OnDemand("linkwright.panels.monitor.node_graph:NodeGraphFeature", messages(_MONITOR, "WatchNodeGraph")),
    OnDemand(
        "linkwright.panels.monitor.parameters:ParametersFeature",
        messages(_MONITOR, "DumpParameters", "SetParameter", "WatchParameters"),
    ),
    OnDemand("linkwright.panels.monitor.plots:PlotsFeature", messages(_MONITOR, "RequestFields", "WatchSeries")),
    OnDemand("linkwright.panels.monitor.teleop:TeleopFeature", messages(_MONITOR, "AimTeleop", "Drive")),
    OnDemand("linkwright.panels.monitor.topics:TopicsFeature", messages(_MONITOR, "WatchTopics")),
    OnDemand(
        "linkwright.panels.source_editor.feature:SourceEditorFeature",
        messages(
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
        messages(
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
    OnDemand(
        "linkwright.panels.recording:RecordingFeature",
        messages(_RECORDING, "RecordTopics", "StopRecording", "SaveMinutes"),
        until=NOTHING_RECORDED,
        refuses_recordings=True,
    ),
)
