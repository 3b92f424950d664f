"""The texts in keys, tokens and attachments, compared with those of rmw_zenoh_cpp."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.graph.endpoints.base import EndpointKind
from linkwright.graph.names.rules import NodeIdentity
from linkwright.graph.qos.compatibility import resolve_defaults
from linkwright.graph.qos.profile import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from linkwright.graph.time.values import Duration
from linkwright.wire.zenoh import attachment, qos_text, tokens
from linkwright.wire.zenoh.tokens import Token

SESSION = "aac3178e146ba6f1fc6e6a4085e77f21"
HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"


@pytest.mark.parametrize(
    ("profile", "text"),
    [
        (QoSProfile(10), "::,10:,:,:,,"),
        (QoSProfile(42), "::,:,:,:,,"),
        (QoSProfile(5, reliability=ReliabilityPolicy.BEST_EFFORT), "2::,5:,:,:,,"),
        (QoSProfile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL), ":1:,1:,:,:,,"),
        (QoSProfile(7, deadline=Duration(seconds=1), lifespan=Duration(nanoseconds=5)), "::,7:1,0:0,5:,,"),
        (
            QoSProfile(7, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC, liveliness_lease_duration=Duration(seconds=2.5)),
            "::,7:,:,:3,2,500000000",
        ),
    ],
)
def test_qos_text_matches_rmw_zenoh(profile, text):
    assert qos_text.write(profile) == text
    assert qos_text.read(text) == resolve_defaults(profile)


def test_qos_text_of_keep_all_history():
    text = qos_text.write(QoSProfile(history=HistoryPolicy.KEEP_ALL))
    assert text == "::2,10:,:,:,,"
    assert qos_text.read(text).history is HistoryPolicy.KEEP_ALL


@pytest.mark.parametrize("text", ["", "::", "a::,10:,:,:,,", "::,10:,:,:,,:", "9::,10:,:,:,,"])
def test_malformed_qos_text_is_rejected(text):
    with pytest.raises(ValueError):
        qos_text.read(text)


def test_tokens_match_rmw_zenoh():
    node = NodeIdentity("talker", "/")
    assert Token(2, SESSION, "0", "0", node).key == f"@ros2_lv/2/{SESSION}/0/0/NN/%/%/talker"
    far_node = NodeIdentity("talker", "/far/away", "/safe")
    token = Token(
        2,
        SESSION,
        "0",
        "11",
        far_node,
        EndpointKind.PUBLISHER,
        "/far/chatter",
        "std_msgs::msg::dds_::String_",
        HASH,
        "::,7:,:,:,,",
    )
    assert token.key == (
        f"@ros2_lv/2/{SESSION}/0/11/MP/%safe/%far%away/talker/%far%chatter/std_msgs::msg::dds_::String_/{HASH}/::,7:,:,:,,"
    )
    assert token.data_key == f"2/far/chatter/std_msgs::msg::dds_::String_/{HASH}"
    assert tokens.read(token.key) == token


def test_additional_token_chunks_are_ignored():
    key = f"@ros2_lv/2/{SESSION}/0/11/MS/%/%/talker/%chatter/std_msgs::msg::dds_::String_/{HASH}/::,7:,:,:,,"
    assert tokens.read(key + "/backends:cpu:") == tokens.read(key)


@pytest.mark.parametrize(
    "key",
    [
        "@ros2_lv",
        "@ros2_lv/x/a/0/0/NN/%/%/talker",
        "@other/2/a/0/0/NN/%/%/talker",
        "@ros2_lv/2/a/0/0/XX/%/%/talker",
        "@ros2_lv/2/a/0/1/MP/%/%/talker/%chatter",
        f"@ros2_lv/2/a/0/1/MP/%/%/talker/%chatter/t/{HASH}/nonsense",
    ],
)
def test_keys_that_are_not_ros_tokens_are_ignored(key):
    assert tokens.read(key) is None


@given(st.text(max_size=60))
def test_arbitrary_text_does_not_break_token_parser(text):
    tokens.read(text)
    tokens.read("@ros2_lv/2/a/0/1/MP/%/%/talker/%chatter/t/h/" + text)


def test_gid_is_hash_of_token():
    import xxhash

    token = Token(0, SESSION, "0", "0", NodeIdentity("talker", "/"))
    number = xxhash.xxh3_128_intdigest(token.key.encode())
    assert token.gid == number.to_bytes(16, "little")  # the low half, then the high one, as rmw_zenoh_cpp has them


def test_attachment_has_33_bytes():
    data = attachment.write(1, 2, bytes(range(16)))
    assert data == b"\1" + bytes(7) + b"\2" + bytes(7) + b"\x10" + bytes(range(16))
    assert attachment.read(data) == (1, 2, bytes(range(16)))


@pytest.mark.parametrize("data", [None, b"", bytes(33), bytes(32), attachment.write(1, 2, bytes(16)) + b"\0"])
def test_malformed_attachment_is_not_read(data):
    assert attachment.read(data) is None
