"""Stands in for ``tf2_ros.buffer_interface``."""

from linkwright.standins.tf2_api.conversion import (
    ConvertRegistration,
    NotImplementedException,
    Stamped,
    TransformRegistration,
    TypeException,
    convert,
)
from linkwright.standins.tf2_api.interface import BufferInterface

__all__ = [
    "BufferInterface",
    "ConvertRegistration",
    "NotImplementedException",
    "Stamped",
    "TransformRegistration",
    "TypeException",
    "convert",
]
