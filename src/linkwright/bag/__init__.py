"""Recordings of topics: rosbag2's folders with MCAP or SQLite files."""

from linkwright.bag.player import Player, PlayOptions
from linkwright.bag.reading import BagReader, BagTopic
from linkwright.bag.recorder import Recorder
from linkwright.bag.selection import TopicSelection
from linkwright.bag.summary import summary_text
from linkwright.bag.writing import STORAGES, BagWriter

__all__ = [
    "STORAGES",
    "BagReader",
    "BagTopic",
    "BagWriter",
    "PlayOptions",
    "Player",
    "Recorder",
    "TopicSelection",
    "summary_text",
]
