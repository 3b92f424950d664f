"""Decode image messages, for all supported encodings and transports."""

from linkwright.images.decoding import BadImageError, DecodedImage, Range, RangeFinder, decode_image, has_range
from linkwright.images.image_files import encoding_of, is_cut_off
from linkwright.images.transports import COMPRESSED, RAW, TRANSPORTS, ImageSource, Unpacker

__all__ = [
    "COMPRESSED",
    "RAW",
    "TRANSPORTS",
    "BadImageError",
    "DecodedImage",
    "ImageSource",
    "Range",
    "RangeFinder",
    "Unpacker",
    "decode_image",
    "encoding_of",
    "has_range",
    "is_cut_off",
]
