"""Stands in for ``rosbag2_py``."""

from linkwright.standins.imported_names import submodules_of
from linkwright.standins.recordings import (
    BagMetadata,
    ConverterOptions,
    Info,
    SequentialCompressionWriter,
    SequentialReader,
    SequentialWriter,
    StorageFilter,
    StorageOptions,
    TopicInformation,
    TopicMetadata,
    get_registered_readers,
    get_registered_writers,
)
from linkwright.standins.recordings import SequentialReader as SequentialCompressionReader

__all__ = [
    "BagMetadata",
    "ConverterOptions",
    "Info",
    "SequentialCompressionReader",
    "SequentialCompressionWriter",
    "SequentialReader",
    "SequentialWriter",
    "StorageFilter",
    "StorageOptions",
    "TopicInformation",
    "TopicMetadata",
    "get_registered_readers",
    "get_registered_writers",
]

__getattr__ = submodules_of(__name__)
