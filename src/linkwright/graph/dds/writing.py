"""Gives bytes to a writer."""

from __future__ import annotations

import ctypes as c

from linkwright.graph.dds.cyclone import Sample, load


def write(writer: int, data: bytes) -> int:
    """Write a sample; may wait for slow readers, with Python's global lock released.

    Args:
        writer: the writer.
        data: CDR with its header; it is filled up to a multiple of four as RTPS wants.

    Returns:
        Zero, or Cyclone's return code.
    """
    if len(data) & 3:
        data += bytes(-len(data) & 3)
    code: int = load().dds_write(writer, c.byref(Sample(data, len(data))))
    return code
