"""The page features of this room that are created on demand."""

from linkwright.page.protocol import displays, editing, export, images, markers, monitor, points, recording, robot
from linkwright.panels.on_demand import OnDemand

ON_DEMAND = (
    OnDemand(
        "linkwright.panels.displays:DisplaysFeature",
        (displays.SetProperty, robot.MeshStatus, markers.MarkerFeedback, images.ImageSize),
    ),
    OnDemand("linkwright.panels.displays:PointsFeature", (points.AskPoint,)),
    OnDemand(
        "linkwright.panels.editing.feature:EditingFeature",
        (editing.ApplyEdit, editing.AskEditableParts, editing.PreviewEdit, editing.RedoEdit, editing.UndoEdit),
    ),
    OnDemand("linkwright.panels.export.feature:ExportFeature", (export.AskExport,)),
    OnDemand("linkwright.panels.monitor.log:LogFeature", (monitor.WatchLog,), ("/rosout",)),
    OnDemand("linkwright.panels.monitor.node_graph:NodeGraphFeature", (monitor.WatchNodeGraph,)),
    OnDemand(
        "linkwright.panels.monitor.parameters:ParametersFeature",
        (monitor.DumpParameters, monitor.SetParameter, monitor.WatchParameters),
    ),
    OnDemand("linkwright.panels.monitor.plots:PlotsFeature", (monitor.AskFields, monitor.WatchSeries)),
    OnDemand("linkwright.panels.monitor.teleop:TeleopFeature", (monitor.AimTeleop, monitor.Drive)),
    OnDemand("linkwright.panels.monitor.topics:TopicsFeature", (monitor.WatchTopics,)),
    OnDemand(
        "linkwright.panels.recording:RecordingFeature",
        (recording.RecordTopics, recording.StopRecording, recording.SaveMinutes),
        until=recording.NOTHING_RECORDED,
        refuses_recordings=True,
    ),
)
