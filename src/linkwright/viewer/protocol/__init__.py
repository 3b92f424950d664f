"""What the server and the page say to each other, declared once.

Control messages are JSON objects with a ``type``; the TypeScript types in ``frontend/src/protocol/`` are generated from
this package by ``tools/protocol_types.py``. Transforms travel as one binary frame, packed by `pack_transforms`, and so
does what displays draw of messages, packed by `pack_data`. Lengths are metres, angles radians, quaternions x, y, z, w,
colours 0 to 1.

The page opens one WebSocket at ``/ws`` (same origin; the cookie set with the page lets it in). `Hello` comes first,
then `Tree`, the `RobotScene` of every RobotModel, `ViewState`, `Joints`, `JointPositions`, `Diagnostics`, `FrameTable`
and the last transforms; after that whatever changes, where only the newest of a kind waits for a slow page. A binary
frame whose revision is not that of the last `FrameTable` is to be dropped.

Of messages that wait for a slow page only the newest of a class is sent, or, where a class has ``NEWEST_OF``, the
newest for each value of the fields named there.

Property ids are ``global/<name>`` or ``<display id>/<name>/<name>...``: the names of the rows on the way, joined by
``/``; in a name ``%`` is written ``%25`` and ``/`` is ``%2F``. The page asks for a change with `SetProperty` and takes
it as made when `PropertyChanged` (or new rows) comes back; a refused value is answered with the one that stands.
"""

from __future__ import annotations

from linkwright.viewer.protocol.configuration import (
    AddDisplay,
    AskConfigurationText,
    AskFolder,
    AskTopics,
    Configuration,
    ConfigurationRefused,
    ConfigurationSaved,
    ConfigurationText,
    DisplayClass,
    DisplayClasses,
    DuplicateDisplays,
    EditKind,
    EditName,
    Folder,
    GroupDisplays,
    LoadConfiguration,
    MoveDisplays,
    NewConfiguration,
    OpenConfiguration,
    Question,
    Redo,
    RemoveDisplays,
    RenameDisplay,
    RevertConfiguration,
    SaveConfiguration,
    TopicChoice,
    TopicChoices,
    Undo,
)
from linkwright.viewer.protocol.data import (
    DATA_KIND,
    Bytes,
    DisplayForgotten,
    Floats,
    pack_data,
)
from linkwright.viewer.protocol.description import (
    AskDescription,
    AskDescriptionText,
    AskInertia,
    CallSite,
    Description,
    DescriptionChanged,
    DescriptionText,
    InertiaFinding,
    InertiaFindings,
    JointDetails,
    JointMimic,
    LinkDetails,
    LinkInertia,
    SourceRange,
    Written,
)
from linkwright.viewer.protocol.diagnostics import DiagnosticItem, DiagnosticNote, Diagnostics
from linkwright.viewer.protocol.displays import (
    Display,
    DisplayProperties,
    DisplayStatus,
    PropertyChanged,
    SetProperty,
    Tree,
)
from linkwright.viewer.protocol.export import AskExport, ExportFailed, ExportReady
from linkwright.viewer.protocol.frames import TRANSFORMS_KIND, FrameTable, pack_transforms, unpack_transforms
from linkwright.viewer.protocol.geometry import EffortRings, PointMarks, PolygonLine, PoseMarks, RangeCone, Screw
from linkwright.viewer.protocol.images import CameraModel, ImageFrame, OccupancyMap
from linkwright.viewer.protocol.interactive_markers import (
    FeedbackEvent,
    InteractionMode,
    InteractiveControl,
    InteractiveMarkerMoved,
    InteractiveMarkerShape,
    MarkerFeedback,
    MarkerMenuEntry,
    OrientationMode,
)
from linkwright.viewer.protocol.joints import (
    CenterJoints,
    JointControl,
    JointPositions,
    Joints,
    RandomizeJoints,
    SetJoint,
    SetJoints,
)
from linkwright.viewer.protocol.log import LogLine, LogLines, WatchLog
from linkwright.viewer.protocol.markers import MarkerKind, MarkerMesh, MarkersChanged, MarkerShape
from linkwright.viewer.protocol.node_graph import GraphTopic, NodeGraph, WatchNodeGraph
from linkwright.viewer.protocol.panels import PanelName, Panels, ShowPanels
from linkwright.viewer.protocol.parameters import (
    DumpParameters,
    NodeParameters,
    ParameterDump,
    ParameterKind,
    ParameterNodes,
    ParameterResult,
    ParameterRow,
    SetParameter,
    WatchParameters,
)
from linkwright.viewer.protocol.parts import (
    Place,
    Property,
    PropertyKind,
    PropertyValue,
    RowDetails,
    StatusLevel,
    StatusRow,
    TopicOffer,
)
from linkwright.viewer.protocol.plots import (
    SAMPLES_KIND,
    AskFields,
    PlotField,
    PlotSeries,
    SeriesState,
    SeriesStates,
    TopicFields,
    WatchSeries,
    pack_samples,
)
from linkwright.viewer.protocol.points import AskPoint, CellGrid, CloudPoints, PointFields
from linkwright.viewer.protocol.robot import (
    AskStory,
    JointScene,
    LinkScene,
    LinkStory,
    MeshStatus,
    RobotScene,
    Shape,
    ShapeKind,
)
from linkwright.viewer.protocol.session import Hello, Received
from linkwright.viewer.protocol.teleop import AimTeleop, Drive, TeleopState, TeleopTarget, TwistKind
from linkwright.viewer.protocol.time import (
    Clock,
    ResetTime,
    SetTime,
    SyncMode,
    TimeReset,
    TimeState,
    WatchClock,
)
from linkwright.viewer.protocol.tools import (
    AddTool,
    PointChosen,
    PoseChosen,
    RemoveTool,
    SetToolProperty,
    Tool,
    ToolClass,
    ToolPropertyChanged,
    Tools,
)
from linkwright.viewer.protocol.topics import (
    MessageField,
    TopicFigures,
    TopicList,
    TopicMessage,
    TopicRow,
    TopicTraffic,
    WatchTopics,
)
from linkwright.viewer.protocol.views import (
    ChangeSavedView,
    RemoveSavedView,
    SavedView,
    SavedViews,
    SaveView,
    View,
    ViewChanged,
    ViewClass,
    ViewClasses,
    ViewState,
)

PROTOCOL_VERSION = 3
"""Raised on every change that an older page would misread; the page reloads itself when it differs."""

ServerMessage = (
    Hello
    | ExportReady
    | ExportFailed
    | Tree
    | DisplayProperties
    | PropertyChanged
    | DisplayStatus
    | DisplayForgotten
    | RobotScene
    | FrameTable
    | ViewState
    | Joints
    | JointPositions
    | Diagnostics
    | LinkStory
    | Description
    | DescriptionChanged
    | DescriptionText
    | InertiaFindings
    | TimeState
    | Clock
    | TimeReset
    | Tools
    | ToolPropertyChanged
    | ViewClasses
    | SavedViews
    | Configuration
    | ConfigurationRefused
    | ConfigurationSaved
    | ConfigurationText
    | DisplayClasses
    | Folder
    | TopicChoices
    | TopicList
    | TopicFigures
    | TopicMessage
    | TopicFields
    | SeriesStates
    | NodeGraph
    | ParameterNodes
    | NodeParameters
    | ParameterResult
    | ParameterDump
    | LogLines
    | TeleopState
    | PointFields
    | Panels
)

PageMessage = (
    SetProperty
    | Received
    | AskExport
    | SetJoint
    | RandomizeJoints
    | CenterJoints
    | ViewChanged
    | MarkerFeedback
    | MeshStatus
    | AskStory
    | SetJoints
    | AskDescription
    | AskDescriptionText
    | AskInertia
    | SetTime
    | ResetTime
    | WatchClock
    | SetToolProperty
    | AddTool
    | RemoveTool
    | PoseChosen
    | PointChosen
    | SaveView
    | ChangeSavedView
    | RemoveSavedView
    | AddDisplay
    | AskConfigurationText
    | AskFolder
    | AskTopics
    | DuplicateDisplays
    | GroupDisplays
    | LoadConfiguration
    | MoveDisplays
    | NewConfiguration
    | OpenConfiguration
    | Redo
    | RemoveDisplays
    | RenameDisplay
    | RevertConfiguration
    | SaveConfiguration
    | Undo
    | WatchTopics
    | AskFields
    | WatchSeries
    | WatchNodeGraph
    | WatchParameters
    | SetParameter
    | DumpParameters
    | WatchLog
    | AimTeleop
    | Drive
    | AskPoint
    | ShowPanels
)

DataContent = (
    PointMarks
    | PoseMarks
    | PolygonLine
    | RangeCone
    | Screw
    | EffortRings
    | CloudPoints
    | CellGrid
    | ImageFrame
    | OccupancyMap
    | InteractiveMarkerShape
    | InteractiveMarkerMoved
    | MarkersChanged
)
"""What displays draw: the content of `pack_data`."""

__all__ = [
    "DATA_KIND",
    "PROTOCOL_VERSION",
    "SAMPLES_KIND",
    "TRANSFORMS_KIND",
    "AddDisplay",
    "AddTool",
    "AimTeleop",
    "AskConfigurationText",
    "AskDescription",
    "AskDescriptionText",
    "AskExport",
    "AskFields",
    "AskFolder",
    "AskInertia",
    "AskPoint",
    "AskStory",
    "AskTopics",
    "Bytes",
    "CallSite",
    "CameraModel",
    "CellGrid",
    "CenterJoints",
    "ChangeSavedView",
    "Clock",
    "CloudPoints",
    "Configuration",
    "ConfigurationRefused",
    "ConfigurationSaved",
    "ConfigurationText",
    "DataContent",
    "Description",
    "DescriptionChanged",
    "DescriptionText",
    "DiagnosticItem",
    "DiagnosticNote",
    "Diagnostics",
    "Display",
    "DisplayClass",
    "DisplayClasses",
    "DisplayForgotten",
    "DisplayProperties",
    "DisplayStatus",
    "Drive",
    "DumpParameters",
    "DuplicateDisplays",
    "EditKind",
    "EditName",
    "EffortRings",
    "ExportFailed",
    "ExportReady",
    "FeedbackEvent",
    "Floats",
    "Folder",
    "FrameTable",
    "GraphTopic",
    "GroupDisplays",
    "Hello",
    "ImageFrame",
    "InertiaFinding",
    "InertiaFindings",
    "InteractionMode",
    "InteractiveControl",
    "InteractiveMarkerMoved",
    "InteractiveMarkerShape",
    "JointControl",
    "JointDetails",
    "JointMimic",
    "JointPositions",
    "JointScene",
    "Joints",
    "LinkDetails",
    "LinkInertia",
    "LinkScene",
    "LinkStory",
    "LoadConfiguration",
    "LogLine",
    "LogLines",
    "MarkerFeedback",
    "MarkerKind",
    "MarkerMenuEntry",
    "MarkerMesh",
    "MarkerShape",
    "MarkersChanged",
    "MeshStatus",
    "MessageField",
    "MoveDisplays",
    "NewConfiguration",
    "NodeGraph",
    "NodeParameters",
    "OccupancyMap",
    "OpenConfiguration",
    "OrientationMode",
    "PageMessage",
    "PanelName",
    "Panels",
    "ParameterDump",
    "ParameterKind",
    "ParameterNodes",
    "ParameterResult",
    "ParameterRow",
    "Place",
    "PlotField",
    "PlotSeries",
    "PointChosen",
    "PointFields",
    "PointMarks",
    "PolygonLine",
    "PoseChosen",
    "PoseMarks",
    "Property",
    "PropertyChanged",
    "PropertyKind",
    "PropertyValue",
    "Question",
    "RandomizeJoints",
    "RangeCone",
    "Received",
    "Redo",
    "RemoveDisplays",
    "RemoveSavedView",
    "RemoveTool",
    "RenameDisplay",
    "ResetTime",
    "RevertConfiguration",
    "RobotScene",
    "RowDetails",
    "SaveConfiguration",
    "SaveView",
    "SavedView",
    "SavedViews",
    "Screw",
    "SeriesState",
    "SeriesStates",
    "ServerMessage",
    "SetJoint",
    "SetJoints",
    "SetParameter",
    "SetProperty",
    "SetTime",
    "SetToolProperty",
    "Shape",
    "ShapeKind",
    "ShowPanels",
    "SourceRange",
    "StatusLevel",
    "StatusRow",
    "SyncMode",
    "TeleopState",
    "TeleopTarget",
    "TimeReset",
    "TimeState",
    "Tool",
    "ToolClass",
    "ToolPropertyChanged",
    "Tools",
    "TopicChoice",
    "TopicChoices",
    "TopicFields",
    "TopicFigures",
    "TopicList",
    "TopicMessage",
    "TopicOffer",
    "TopicRow",
    "TopicTraffic",
    "Tree",
    "TwistKind",
    "Undo",
    "View",
    "ViewChanged",
    "ViewClass",
    "ViewClasses",
    "ViewState",
    "WatchClock",
    "WatchLog",
    "WatchNodeGraph",
    "WatchParameters",
    "WatchSeries",
    "WatchTopics",
    "Written",
    "pack_data",
    "pack_samples",
    "pack_transforms",
    "unpack_transforms",
]
