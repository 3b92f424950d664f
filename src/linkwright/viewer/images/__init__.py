"""Images from messages, as browsers draw them."""

from linkwright.viewer.images.compression import ImageCompressor
from linkwright.viewer.images.decoding import BadImageError, Picture, has_range, picture_of
from linkwright.viewer.images.ranges import Range, RangeFinder

__all__ = ["BadImageError", "ImageCompressor", "Picture", "Range", "RangeFinder", "has_range", "picture_of"]
