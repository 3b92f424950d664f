"""Recordings of topics: rosbag2 folders with MCAP or SQLite files."""

from typing import TYPE_CHECKING

from linkwright.bag.names import is_recording
from linkwright.loading.deferred import deferred

if TYPE_CHECKING:
    from linkwright.bag.history import History
    from linkwright.bag.playback import FASTEST, SLOWEST, Output, Playback, Recording
    from linkwright.bag.player import Player, PlayOptions
    from linkwright.bag.player_services import PlayerServices
    from linkwright.bag.publishing import PublishedRecording
    from linkwright.bag.reading import BagReader, BagTopic
    from linkwright.bag.recorder import Recorder
    from linkwright.bag.recorder_services import RecorderServices
    from linkwright.bag.selection import TopicSelection
    from linkwright.bag.summary import format_summary, summarize_bag
    from linkwright.bag.writing import COMPRESSIONS, STORAGES, BagWriter

__all__ = [
    "COMPRESSIONS",
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
    "PlayerServices",
    "PublishedRecording",
    "Recorder",
    "RecorderServices",
    "Recording",
    "TopicSelection",
    "format_summary",
    "is_recording",
    "summarize_bag",
]

__getattr__ = deferred(
    __name__,
    {
        "history": ("History",),
        "playback": ("FASTEST", "SLOWEST", "Output", "Playback", "Recording"),
        "player": ("PlayOptions", "Player"),
        "player_services": ("PlayerServices",),
        "publishing": ("PublishedRecording",),
        "reading": ("BagReader", "BagTopic"),
        "recorder": ("Recorder",),
        "recorder_services": ("RecorderServices",),
        "selection": ("TopicSelection",),
        "summary": ("format_summary", "summarize_bag"),
        "writing": ("COMPRESSIONS", "STORAGES", "BagWriter"),
    },
)
"""Lazy imports of the names that many callers do not need besides `is_recording`."""
