"""Images from messages, as browsers draw them."""

from linkwright.viewer.images.compression import ImageCompressor
from linkwright.viewer.images.decoding import BadImageError, Picture, Range, RangeFinder, has_range, picture_of
from linkwright.viewer.images.image_files import encoding_of
from linkwright.viewer.images.transports import COMPRESSED, RAW, TRANSPORTS, ImageSource, Unpacker

__all__ = [
    "COMPRESSED",
    "RAW",
    "TRANSPORTS",
    "BadImageError",
    "ImageCompressor",
    "ImageSource",
    "Picture",
    "Range",
    "RangeFinder",
    "Unpacker",
    "encoding_of",
    "has_range",
    "picture_of",
]
