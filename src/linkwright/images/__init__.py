"""Pixels of image messages, of every encoding and transport that is read here."""

from linkwright.images.decoding import BadImageError, Picture, Range, RangeFinder, has_range, picture_of
from linkwright.images.image_files import encoding_of, is_cut_off
from linkwright.images.transports import COMPRESSED, RAW, TRANSPORTS, ImageSource, Unpacker

__all__ = [
    "COMPRESSED",
    "RAW",
    "TRANSPORTS",
    "BadImageError",
    "ImageSource",
    "Picture",
    "Range",
    "RangeFinder",
    "Unpacker",
    "encoding_of",
    "has_range",
    "is_cut_off",
    "picture_of",
]
