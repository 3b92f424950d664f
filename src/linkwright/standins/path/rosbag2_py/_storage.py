"""Stands in for ``rosbag2_py._storage``, which programs of the tutorials name."""

from linkwright.standins.recordings import (
    BagMetadata,
    ConverterOptions,
    StorageFilter,
    StorageOptions,
    TopicInformation,
    TopicMetadata,
)

__all__ = [
    "BagMetadata",
    "ConverterOptions",
    "StorageFilter",
    "StorageOptions",
    "TopicInformation",
    "TopicMetadata",
]
