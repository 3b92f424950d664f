"""Stands in for ``tf2_ros``."""

from linkwright.graph.transforms.broadcaster import StaticTransformBroadcaster, TransformBroadcaster
from linkwright.graph.transforms.core import BufferCore
from linkwright.graph.transforms.errors import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)
from linkwright.standins.tf2_api.buffer import Buffer
from linkwright.standins.tf2_api.client import BufferClient
from linkwright.standins.tf2_api.conversion import (
    ConvertRegistration,
    NotImplementedException,
    Stamped,
    TransformRegistration,
    TypeException,
    convert,
)
from linkwright.standins.tf2_api.imported_names import imported_there as __getattr__
from linkwright.standins.tf2_api.interface import BufferInterface
from linkwright.standins.tf2_api.listener import StaticTransformListener, TransformListener

__all__ = [
    "Buffer",
    "BufferClient",
    "BufferCore",
    "BufferInterface",
    "ConnectivityException",
    "ConvertRegistration",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "NotImplementedException",
    "Stamped",
    "StaticTransformBroadcaster",
    "StaticTransformListener",
    "TimeoutException",
    "TransformBroadcaster",
    "TransformException",
    "TransformListener",
    "TransformRegistration",
    "TypeException",
    "convert",
]
