"""MCAP files that hold more than ROS 2."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest

from linkwright.bag import BagReader
from linkwright.cli import main
from linkwright.diagnostics import LinkwrightError
from linkwright.messages import deserialize, get_message, serialize

String = get_message("std_msgs/msg/String")
MCAP_MAGIC = b"\x89MCAP0\r\n"
START_NS = 1_000_000_000


def string_field(value: str | bytes) -> bytes:
    data = value.encode() if isinstance(value, str) else value
    return struct.pack("<I", len(data)) + data


def mcap_record(kind: int, body: bytes) -> bytes:
    return struct.pack("<BQ", kind, len(body)) + body


def channel_record(number: int, topic: str, encoding: str) -> bytes:
    return mcap_record(
        0x04, struct.pack("<HH", number, number) + string_field(topic) + string_field(encoding) + string_field("")
    )


def schema_record(number: int, name: str, language: str, data: bytes) -> bytes:
    return mcap_record(
        0x03, struct.pack("<H", number) + string_field(name) + string_field(language) + string_field(data)
    )


def message_record(number: int, stamp_ns: int, data: bytes) -> bytes:
    return mcap_record(0x05, struct.pack("<HIQQ", number, 0, stamp_ns, stamp_ns) + data)


SUPPORTED_CHANNELS = schema_record(1, "std_msgs/msg/String", "ros2msg", b"string data") + channel_record(
    1, "/chatter", "cdr"
)
UNSUPPORTED_CHANNELS = (
    schema_record(2, "thing", "jsonschema", b'{"type":"object"}')
    + channel_record(2, "/thing", "json")
    + schema_record(3, "foxglove.Pose", "protobuf", bytes(range(128, 250)))  # not text
    + channel_record(3, "/pose", "protobuf")
)


def write_file(path: Path, declared: bytes, kind: str, profile: str = "") -> Path:
    """Write a file of five messages on each of three channels.

    Args:
        path: the path of the file.
        declared: the records of its schemas and channels.
        kind: ``indexed``; ``unindexed``, a chunk without a summary; ``loose``, without chunks; ``cut off``.
        profile: the profile in its header.
    """
    stamps = [START_NS + number * 1000 for number in range(5)]
    parts = [
        message_record(channel, stamp, (serialize(String(data=f"{stamp}")), b"{}", b"\x01")[channel - 1])
        for stamp in stamps
        for channel in (1, 2, 3)
    ]
    data = declared + b"".join(parts)
    head = MCAP_MAGIC + mcap_record(0x01, string_field(profile) + string_field("another program"))
    span = struct.pack("<QQ", stamps[0], stamps[-1])
    chunk = mcap_record(
        0x06, span + struct.pack("<QI", len(data), 0) + string_field("") + struct.pack("<Q", len(data)) + data
    )
    summary, summary_at = b"", 0
    body = data if kind == "loose" else chunk
    if kind == "indexed":
        places, offsets = b"", b""
        for number in (1, 2, 3):
            offsets += struct.pack("<HQ", number, len(head) + len(chunk) + len(places))
            entries = struct.pack("<QQ", stamps[0], len(declared)) * 5
            places += mcap_record(0x07, struct.pack("<H", number) + string_field(entries))
        body += places
        counts = b"".join(struct.pack("<HQ", number, 5) for number in (1, 2, 3))
        index = (
            span + struct.pack("<QQ", len(head), len(chunk)) + string_field(offsets) + struct.pack("<Q", len(places))
        )
        index += string_field("") + struct.pack("<QQ", len(data), len(data))
        statistics = struct.pack("<QHIIII", 15, 3, 3, 0, 0, 1) + span + string_field(counts)
        summary = declared + mcap_record(0x08, index) + mcap_record(0x0B, statistics)
    end = mcap_record(0x0F, bytes(4))
    summary_at = len(head) + len(body) + len(end) if summary else 0
    end += summary + mcap_record(0x02, struct.pack("<QQI", summary_at, 0, 0)) + MCAP_MAGIC
    path.write_bytes(head + body + (end if kind != "cut off" else b"\x05\x99"))
    return path


@pytest.mark.parametrize("profile", ["", "ros2", "x"])
@pytest.mark.parametrize("kind", ["indexed", "unindexed", "loose", "cut off"])
def test_bag_reader_reads_ros2_topics_and_names_others(tmp_path: Path, kind: str, profile: str) -> None:
    with BagReader(write_file(tmp_path / "x.mcap", SUPPORTED_CHANNELS + UNSUPPORTED_CHANNELS, kind, profile)) as bag:
        assert [(topic.name, topic.type_name, topic.count) for topic in bag.topics] == [
            ("/chatter", "std_msgs/msg/String", 5)
        ]
        messages = list(bag.messages())
        assert [deserialize(data, String).data for _, _, data in messages] == [str(stamp) for _, stamp, _ in messages]
        assert len(messages) == 5
        finding = bag.findings[-1]
        assert finding.code == "BAG112"
        assert finding.message.endswith("not ROS 2 messages: /pose (protobuf), /thing (json)")
        assert len(bag.findings) == (2 if kind == "cut off" else 1)
        with pytest.raises(LinkwrightError, match="no topic '/pose'"):
            bag.messages(["/pose"])


def test_mcap_without_ros2_topics_is_reported_as_one_error(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_file(tmp_path / "x.mcap", UNSUPPORTED_CHANNELS, "indexed")
    assert main(["bag", "info", str(path)]) == 1
    output = capsys.readouterr()
    assert output.out == ""
    assert "error[BAG102]" in output.err
    assert "is not a ROS 2 recording: /pose (protobuf), /thing (json)" in output.err


def test_ros1_bag_error_explains_conversion_to_ros2(tmp_path: Path) -> None:
    path = tmp_path / "old.bag"
    path.write_bytes(b"#ROSBAG V2.0\n")
    with pytest.raises(LinkwrightError) as error:
        BagReader(path)
    (finding,) = error.value.diagnostics
    assert "rosbags-convert" in str(finding.hint)
