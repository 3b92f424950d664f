"""Pieces of a binary frame: one that would keep a line busy for long goes in many, and others go between them."""

from __future__ import annotations

import struct

PIECE_KIND = 4
_HEADER = struct.Struct("<IIII")


def pack_piece(frame: bytes, number: int, offset: int, size: int) -> bytes:
    """A binary frame with a part of another.

    It is four uint32, little endian (kind 4, number, offset, length of the whole frame), and the bytes from the offset
    on. The page takes the whole frame as received when it has the last piece; a piece with the offset 0 begins another.

    Args:
        frame: the whole.
        number: the same for all pieces of the frame, and another for those of the next.
        offset: where the piece begins, bytes.
        size: of the piece at most, bytes.
    """
    return _HEADER.pack(PIECE_KIND, number, offset, len(frame)) + frame[offset : offset + size]
