"""The discovery messages of rmw_dds_common: their layout, and malformed ones."""

from __future__ import annotations

import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.wire.dds.discovery_info import (
    GID_SIZE,
    OLD_GID_SIZE,
    NodeEntities,
    ParticipantEntities,
    decode,
    encode,
)

gids = st.binary(min_size=16, max_size=16)
texts = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=12)
nodes = st.builds(NodeEntities, texts, texts, st.lists(gids, max_size=3), st.lists(gids, max_size=3))
participants = st.builds(ParticipantEntities, gids, st.lists(nodes, max_size=3))


@given(participants, st.sampled_from([GID_SIZE, OLD_GID_SIZE]))
def test_discovery_info_round_trips(info, gid_size):
    assert decode(encode(info, gid_size)) == info


@given(st.binary(max_size=200))
def test_arbitrary_bytes_do_not_raise(data):
    decode(b"\0\1\0\0" + data)


@pytest.mark.parametrize("data", [b"", b"\0", b"\0\1\0\0", b"\0\1\0\0" + bytes(15)])
def test_short_samples_are_rejected(data):
    assert decode(data) is None


def test_layout_matches_rmw_dds_common():
    gid, second_gid = bytes(range(16)), bytes(range(16, 32))
    info = ParticipantEntities(gid, [NodeEntities("/", "abc", [second_gid], [])])
    body = struct.pack("<I", 1)
    body += struct.pack("<I", 2) + b"/\0" + bytes(2)
    body += struct.pack("<I", 4) + b"abc\0"
    assert encode(info, 16) == b"\0\1\0\0" + gid + body + struct.pack("<I", 1) + second_gid + struct.pack("<I", 0)
    padded_gid = second_gid + bytes(8)
    assert encode(info, 24) == b"\0\1\0\0" + gid + bytes(8) + body + struct.pack("<I", 1) + padded_gid + struct.pack(
        "<I", 0
    )


def test_big_endian_samples_are_read():
    data = bytes(range(16)) + struct.pack(">I", 1) + struct.pack(">I", 2) + b"/\0\0\0"
    data += struct.pack(">I", 2) + b"a\0\0\0" + struct.pack(">II", 0, 0)
    assert decode(b"\0\0\0\0" + data) == ParticipantEntities(bytes(range(16)), [NodeEntities("/", "a", [], [])])
