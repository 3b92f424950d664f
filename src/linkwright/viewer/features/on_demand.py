"""Features that are created on demand: when a page asks for one, or one of their topics is published.

Their modules are imported then. Until then pages receive default messages in their place.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any, ClassVar

from linkwright.viewer.features.page_feature import FeatureHost, PageFeature
from linkwright.viewer.protocol import (
    displays,
    editing,
    export,
    images,
    markers,
    modelling,
    monitor,
    navigation,
    points,
    recording,
    robot,
    simulation,
    voice,
    voice_words,
)
from linkwright.viewer.protocol.message import ServerMessage
from linkwright.viewer.web.audience import Page

_SIMULATION = "simulation:SimulationFeature"
_MODELLING = "modelling.feature:ModellingFeature"
_RECORDING = "recording:RecordingFeature"
_LOG = "monitor.log:LogFeature"
_VOICE = "voice.feature:VoiceFeature"
_OUTCOME = "monitor.goal_outcome:GoalOutcomeFeature"

_ANSWERED_BY: dict[str, tuple[type, ...]] = {
    "displays:DisplaysFeature": (displays.SetProperty, robot.MeshStatus, markers.MarkerFeedback, images.PictureSize),
    "displays:PointsFeature": (points.AskPoint,),
    "editing.feature:EditingFeature": (
        editing.ApplyEdit,
        editing.AskEditableParts,
        editing.PreviewEdit,
        editing.RedoEdit,
        editing.UndoEdit,
    ),
    "export.feature:ExportFeature": (export.AskExport,),
    _MODELLING: (
        modelling.AddThing,
        modelling.AskModels,
        modelling.ChangeThings,
        modelling.CopyThings,
        modelling.DeleteThings,
        modelling.GroupThings,
        modelling.RedoWorld,
        modelling.SaveWorld,
        modelling.SetModelling,
        modelling.UndoWorld,
        modelling.UngroupThing,
    ),
    _LOG: (monitor.WatchLog,),
    _OUTCOME: (),
    "monitor.navigation:NavigationFeature": (navigation.CommandNavigation, navigation.WatchNavigation),
    "monitor.node_graph:NodeGraphFeature": (monitor.WatchNodeGraph,),
    "monitor.parameters:ParametersFeature": (monitor.DumpParameters, monitor.SetParameter, monitor.WatchParameters),
    "monitor.plots:PlotsFeature": (monitor.AskFields, monitor.WatchSeries),
    "monitor.teleop:TeleopFeature": (monitor.AimTeleop, monitor.Drive),
    "monitor.topics:TopicsFeature": (monitor.WatchTopics,),
    _RECORDING: (recording.RecordTopics, recording.StopRecording, recording.SaveMinutes),
    _SIMULATION: (
        simulation.ControlSimulation,
        simulation.SpawnModel,
        simulation.DeleteModel,
        simulation.DragModel,
        simulation.PushLink,
    ),
    _VOICE: (
        voice_words.AskWordsFile,
        voice_words.BeginTake,
        voice_words.EndTake,
        voice_words.ImportWords,
        voice_words.RemoveWord,
        voice_words.RenameWord,
        voice.SayCommand,
        voice.SoundBlock,
        voice.Talk,
        voice.WatchVoice,
        voice_words.WatchWords,
    ),
}
"""The messages that each feature handles, by its module and class below this package."""

_WOKEN_BY = {
    "/simulation_state": _SIMULATION,
    "/world_description": _MODELLING,
    "/navigate_to_pose/_action/status": _OUTCOME,
    "/rosout": _LOG,
    "/voice/command": _VOICE,
}
"""Topics whose publishers make a feature necessary."""

_WHILE_NOT_MADE: dict[str, ServerMessage] = {
    _MODELLING: modelling.NO_WORLD,
    _RECORDING: recording.NOTHING_RECORDED,
    _SIMULATION: simulation.NO_SIMULATION,
}
"""The message that pages receive while a feature does not exist."""


class OnDemandFeatures(PageFeature):
    """Creates each of them once, and forwards the message that asked for it; later messages go to it directly."""

    RECEIVES: ClassVar[tuple[type, ...]] = tuple(message for asked in _ANSWERED_BY.values() for message in asked)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._made: set[str] = set()
        self._asleep = dict(_WOKEN_BY)
        self._listening = False

    def opening(self) -> list[ServerMessage]:
        """Return the messages of features that are not made yet; watches their topics while there are pages."""
        if not self._listening and self._asleep:
            self._listening = True
            self.context.graph_changes.listen(self._review)
        self._review()
        return [message for where, message in _WHILE_NOT_MADE.items() if where not in self._made]

    def receive(self, page: Page, message: Any) -> None:
        """Create the feature that handles the message, and forward it."""
        self._make(next(where for where, asked in _ANSWERED_BY.items() if type(message) in asked)).receive(
            page, message
        )

    def recording_shown(self) -> None:
        """Create the features that refuse work beside a recording; they are notified next."""
        for where in (_SIMULATION, _RECORDING):
            self._make(where)

    def page_gone(self, page: Page) -> None:
        """Stop watching after the last page."""
        if self._listening and len(self.context.pages) == 0:
            self._stop()

    def close(self) -> None:
        """Create no more features."""
        self._stop()

    def _stop(self) -> None:
        self._listening = False
        self.context.graph_changes.ignore(self._review)

    def _review(self) -> None:
        """Create the features whose topics are published now."""
        for topic, where in list(self._asleep.items()):
            if self.context.node.count_publishers(topic):
                self._make(where)

    def _make(self, where: str) -> PageFeature:
        module, _, name = where.partition(":")
        feature: PageFeature = self.viewer.add_feature(
            getattr(import_module(f"{__package__}.{module}"), name), _ANSWERED_BY[where]
        )
        if where not in self._made:
            self._made.add(where)
            self._asleep = {topic: each for topic, each in self._asleep.items() if each != where}
            for message in feature.opening():
                self.context.pages.publish(message)
            if not self._asleep:
                self._stop()
        return feature
