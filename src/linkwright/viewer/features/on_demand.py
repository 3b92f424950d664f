"""Features that do nothing before a page asks for them; their modules are imported with the first question."""

from __future__ import annotations

from importlib import import_module
from typing import Any, ClassVar

from linkwright.viewer.features.page_feature import FeatureHost, PageFeature
from linkwright.viewer.protocol.editing import ApplyEdit, AskEditableParts, PreviewEdit, RedoEdit, UndoEdit
from linkwright.viewer.protocol.export import AskExport
from linkwright.viewer.protocol.monitor import (
    AimTeleop,
    AskFields,
    Drive,
    DumpParameters,
    SetParameter,
    WatchLog,
    WatchNodeGraph,
    WatchParameters,
    WatchSeries,
    WatchTopics,
)
from linkwright.viewer.protocol.navigation import CommandNavigation, WatchNavigation
from linkwright.viewer.protocol.voice import SayCommand, SoundBlock, Talk, WatchVoice
from linkwright.viewer.protocol.voice_words import (
    AskWordsFile,
    BeginTake,
    EndTake,
    ImportWords,
    RemoveWord,
    RenameWord,
    WatchWords,
)
from linkwright.viewer.web.audience import Page

_ANSWERED_BY: dict[type, str] = {
    AimTeleop: "monitor.teleop:TeleopFeature",
    AskExport: "export.feature:ExportFeature",
    CommandNavigation: "monitor.navigation:NavigationFeature",
    AskFields: "monitor.plots:PlotsFeature",
    Drive: "monitor.teleop:TeleopFeature",
    DumpParameters: "monitor.parameters:ParametersFeature",
    SayCommand: "voice.feature:VoiceFeature",
    SetParameter: "monitor.parameters:ParametersFeature",
    SoundBlock: "voice.feature:VoiceFeature",
    Talk: "voice.feature:VoiceFeature",
    WatchLog: "monitor.log:LogFeature",
    WatchNavigation: "monitor.navigation:NavigationFeature",
    WatchNodeGraph: "monitor.node_graph:NodeGraphFeature",
    WatchParameters: "monitor.parameters:ParametersFeature",
    WatchSeries: "monitor.plots:PlotsFeature",
    WatchTopics: "monitor.topics:TopicsFeature",
    WatchVoice: "voice.feature:VoiceFeature",
    **dict.fromkeys(
        (ApplyEdit, AskEditableParts, PreviewEdit, RedoEdit, UndoEdit),
        "editing.feature:EditingFeature",
    ),
    **dict.fromkeys(
        (AskWordsFile, BeginTake, EndTake, ImportWords, RemoveWord, RenameWord, WatchWords),
        "voice.feature:VoiceFeature",
    ),
}
"""Module and class, below this package."""


class OnDemandFeatures(PageFeature):
    """The live panels, the Voice panel, editing and the export.

    They speak only to pages that have asked, so they are told of questions, of pages that go, and of the end.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = tuple(_ANSWERED_BY)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._made: dict[str, PageFeature] = {}

    def receive(self, page: Page, message: Any) -> None:
        """Hand a question to its feature."""
        where = _ANSWERED_BY[type(message)]
        if where not in self._made:
            module, _, name = where.partition(":")
            self._made[where] = getattr(import_module(f"{__package__}.{module}"), name)(self.viewer)
        self._made[where].receive(page, message)

    def page_gone(self, page: Page) -> None:
        """Have the page forgotten."""
        for feature in self._made.values():
            feature.page_gone(page)

    def close(self) -> None:
        """End them for good."""
        for feature in self._made.values():
            feature.close()
