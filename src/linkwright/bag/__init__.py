"""Recordings of topics: rosbag2's folders with MCAP or SQLite files."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from linkwright.bag.names import is_recording

if TYPE_CHECKING:
    from linkwright.bag.history import History
    from linkwright.bag.playback import FASTEST, SLOWEST, Output, Playback, Recording
    from linkwright.bag.player import Player, PlayOptions
    from linkwright.bag.publishing import PublishedRecording
    from linkwright.bag.reading import BagReader, BagTopic
    from linkwright.bag.recorder import Recorder
    from linkwright.bag.selection import TopicSelection
    from linkwright.bag.summary import summary_text
    from linkwright.bag.writing import STORAGES, BagWriter

__all__ = [
    "FASTEST",
    "SLOWEST",
    "STORAGES",
    "BagReader",
    "BagTopic",
    "BagWriter",
    "History",
    "Output",
    "PlayOptions",
    "Playback",
    "Player",
    "PublishedRecording",
    "Recorder",
    "Recording",
    "TopicSelection",
    "is_recording",
    "summary_text",
]

_ON_DEMAND = {
    "History": "linkwright.bag.history",
    "FASTEST": "linkwright.bag.playback",
    "Output": "linkwright.bag.playback",
    "Playback": "linkwright.bag.playback",
    "Recording": "linkwright.bag.playback",
    "SLOWEST": "linkwright.bag.playback",
    "PlayOptions": "linkwright.bag.player",
    "Player": "linkwright.bag.player",
    "PublishedRecording": "linkwright.bag.publishing",
    "BagReader": "linkwright.bag.reading",
    "BagTopic": "linkwright.bag.reading",
    "Recorder": "linkwright.bag.recorder",
    "TopicSelection": "linkwright.bag.selection",
    "summary_text": "linkwright.bag.summary",
    "BagWriter": "linkwright.bag.writing",
    "STORAGES": "linkwright.bag.writing",
}


def __getattr__(name: str) -> Any:
    """All that reads, writes or plays: many only ask whether a file is a recording, and loading it takes a while."""
    if name in _ON_DEMAND:
        return getattr(import_module(_ON_DEMAND[name]), name)
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
