"""Recordings: round trips, and reports about damaged, missing and foreign files."""

from __future__ import annotations

import sqlite3
import subprocess
import sys
from collections.abc import Iterable, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
import yaml
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from linkwright.bag import STORAGES, BagReader, BagWriter, TopicSelection, summarize_bag
from linkwright.bag.names import belong_together
from linkwright.bag.qos import (
    choose_playing_profile,
    choose_recording_profile,
    from_library,
    parse_overrides,
    to_library,
)
from linkwright.cli import main
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import (
    DEFAULT_QOS,
    DESCRIPTION_QOS,
    SENSOR_DATA_QOS,
    DurabilityPolicy,
    Duration,
    HistoryPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from linkwright.messages import JointState, String, deserialize, serialize

START_NS = 1_700_000_000_000_000_000


def write_recording(folder: Path, storage: str = "mcap", count: int = 3, name: str = "bag", **options: bool) -> Path:
    """Write a recording of two topics."""
    path = folder / name
    with BagWriter(path, storage, **options) as writer:
        writer.add_topic("/chatter", "std_msgs/msg/String", [DESCRIPTION_QOS])
        writer.add_topic("/joint_states", "sensor_msgs/msg/JointState", [DEFAULT_QOS, SENSOR_DATA_QOS])
        for number in range(count):
            writer.write("/chatter", START_NS + number * 1_000_000_000, serialize(String(data=f"number {number}")))
        writer.write("/joint_states", START_NS + 500_000_000, serialize(JointState(name=["a"], position=[0.5])))
    return path


def diagnostic_code(error: pytest.ExceptionInfo[LinkwrightError]) -> str:
    (diagnostic,) = error.value.diagnostics
    return diagnostic.code


@pytest.mark.parametrize("storage", STORAGES)
@pytest.mark.parametrize("key", ["offered_qos_profiles", "type_description_hash"])
def test_metadata_contradicting_files_hides_no_messages(tmp_path: Path, storage: str, key: str) -> None:
    path = write_recording(tmp_path, storage) / "metadata.yaml"
    document = yaml.safe_load(path.read_text(encoding="utf-8"))
    for topic in document["rosbag2_bagfile_information"]["topics_with_message_count"]:
        topic["topic_metadata"][key] = "RIHS01_0" if "hash" in key else ""
    path.write_text(yaml.safe_dump(document), encoding="utf-8")
    with BagReader(path.parent) as bag:
        assert len(list(bag.messages())) == 4
        assert bag.state_at(["/joint_states"], START_NS + 10**9)


@pytest.mark.parametrize("storage", STORAGES)
def test_bag_reader_returns_messages_ordered_by_time(tmp_path: Path, storage: str) -> None:
    with BagReader(write_recording(tmp_path, storage)) as bag:
        assert bag.storage == storage
        assert [(topic.name, topic.type_name, topic.count) for topic in bag.topics] == [
            ("/chatter", "std_msgs/msg/String", 3),
            ("/joint_states", "sensor_msgs/msg/JointState", 1),
        ]
        assert bag.topics[0].offered_qos == (DESCRIPTION_QOS,)
        assert bag.topics[1].offered_qos == (DEFAULT_QOS, SENSOR_DATA_QOS)
        assert (bag.start_ns, bag.end_ns) == (START_NS, START_NS + 2_000_000_000)
        messages = list(bag.messages())
    assert [(topic, stamp - START_NS) for topic, stamp, _ in messages] == [
        ("/chatter", 0),
        ("/joint_states", 500_000_000),
        ("/chatter", 1_000_000_000),
        ("/chatter", 2_000_000_000),
    ]
    assert messages[0][2][:4] == b"\x00\x01\x00\x00"


@pytest.mark.parametrize("storage", STORAGES)
def test_rosbags_library_reads_types_and_content(tmp_path: Path, storage: str) -> None:
    path = write_recording(tmp_path, storage)
    with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
        texts = [
            reader.deserialize(data, connection.msgtype).data
            for connection, _, data in reader.messages()
            if connection.topic == "/chatter"
        ]
        hashes = {connection.topic: connection.digest for connection in reader.connections}
    assert texts == ["number 0", "number 1", "number 2"]
    assert hashes["/chatter"] == "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"


def test_compressed_recording_is_smaller_with_equal_messages(tmp_path: Path) -> None:
    (tmp_path / "plain").mkdir()
    (tmp_path / "small").mkdir()
    plain, compressed = (
        write_recording(tmp_path / "plain", count=400),
        write_recording(tmp_path / "small", count=400, compression="storage"),
    )
    with BagReader(plain) as plain_bag, BagReader(compressed) as small_bag:
        assert list(plain_bag.messages()) == list(small_bag.messages())
        assert small_bag.files[0].stat().st_size < plain_bag.files[0].stat().st_size / 2


def test_messages_can_be_filtered_by_topic_and_start_time(tmp_path: Path) -> None:
    with BagReader(write_recording(tmp_path)) as bag:
        assert [stamp - START_NS for _, stamp, _ in bag.messages(["/chatter"], START_NS + 1)] == [
            1_000_000_000,
            2_000_000_000,
        ]


@pytest.mark.parametrize("options", [*({"storage": storage} for storage in STORAGES), {"single_file": True}])
def test_recording_of_killed_process_is_read_from_file(tmp_path: Path, options: dict[str, Any]) -> None:
    path = tmp_path / "bag.mcap"
    program = f"""
import os
from linkwright.bag import BagWriter
from linkwright.messages import String, serialize
writer = BagWriter({str(path)!r}, **{options!r})
writer.add_topic("/chatter", "std_msgs/msg/String")
for number in range(5):
    writer.write("/chatter", {START_NS} + number, serialize(String(data=str(number))))
writer.flush()
os._exit(1)
"""
    subprocess.run([sys.executable, "-c", program], check=False, timeout=60)
    assert not (path / "metadata.yaml").exists()
    assert path.is_file() == ("single_file" in options)
    with BagReader(path) as bag:
        assert len(list(bag.messages())) == 5


def test_single_file_recording_has_no_folder(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "new", name="run.mcap", single_file=True)
    assert [file.name for file in path.parent.iterdir()] == ["run.mcap"]
    with BagReader(path) as bag, BagReader(write_recording(tmp_path)) as folder:
        assert not bag.findings
        assert list(bag.messages()) == list(folder.messages())
        assert bag.topics == folder.topics
        assert "Files:             run.mcap" in summarize_bag(bag)
    with pytest.raises(LinkwrightError) as error:
        BagWriter(path, single_file=True)
    assert diagnostic_code(error) == "BAG105"
    assert str(error.value.diagnostics[0].hint) == "choose another file"


def write_parts(folder: Path, storage: str, names: Sequence[str]) -> list[Path]:
    """Write files without metadata, each with three messages of a topic.

    Each file starts a second after the previous one.
    """
    files = []
    for number, name in enumerate(names):
        with BagWriter(folder / f"part{number}", storage) as writer:
            writer.add_topic("/chatter", "std_msgs/msg/String", [DEFAULT_QOS])
            if number == 1:
                writer.add_topic("/other", "std_msgs/msg/String", [DEFAULT_QOS])
                writer.write("/other", START_NS, serialize(String(data="early")))
            for step in range(3):
                # The last message of a file is later than the first message of the next file.
                stamp = START_NS + number * 1_000_000_000 + step * 400_000_000
                writer.write("/chatter", stamp, serialize(String(data=f"{number}.{step}")))
        (file,) = (path for path in (folder / f"part{number}").iterdir() if path.name != "metadata.yaml")
        files.append(folder / "drive" / f"{name}{file.suffix}")
        files[-1].parent.mkdir(exist_ok=True)
        file.rename(files[-1])
    return files


def message_texts(messages: Iterable[tuple[str, int, bytes]]) -> list[str]:
    return [deserialize(data, String).data for _, _, data in messages]


@pytest.mark.parametrize("storage", STORAGES)
def test_numbered_files_without_metadata_form_one_recording(tmp_path: Path, storage: str) -> None:
    files = write_parts(tmp_path, storage, ["drive_10", "drive_9", "drive_11"])
    with BagReader(tmp_path / "drive") as bag:
        assert {topic.name: topic.count for topic in bag.topics} == {"/chatter": 9, "/other": 1}
        assert (bag.start_ns, bag.end_ns) == (START_NS, START_NS + 2_800_000_000)
        messages = list(bag.messages())
        assert message_texts(messages) == ["0.0", "early", "0.1", "0.2", "1.0", "1.1", "1.2", "2.0", "2.1", "2.2"]
        assert [stamp for _, stamp, _ in messages] == sorted(stamp for _, stamp, _ in messages)
        assert message_texts(bag.messages(["/chatter"], START_NS + 1_700_000_000)) == ["1.2", "2.0", "2.1", "2.2"]
        assert message_texts(bag.state_at(["/chatter", "/other"], START_NS + 1_900_000_000)) == ["early", "1.2"]
        assert bag.time_before(["/chatter"], START_NS + 1_000_000_000) == START_NS + 800_000_000
        assert sum(bag.counts(10)["/chatter"]) == 9
        assert sorted(bag.files) == sorted(files)
        assert summarize_bag(bag).count("Type: std_msgs/msg/String | Count: 9") == 1


def test_empty_part_is_skipped_with_warning(tmp_path: Path) -> None:
    write_parts(tmp_path, "mcap", ["drive_0", "drive_1"])
    (tmp_path / "drive" / "drive_2.mcap").touch()
    with BagReader(tmp_path / "drive") as bag:
        assert [finding.code for finding in bag.findings] == ["BAG109"]
        assert len(list(bag.messages())) == 7


def test_differently_named_files_form_one_recording_only_if_listed(tmp_path: Path) -> None:
    files = write_parts(tmp_path, "mcap", ["morning", "noon"])
    with pytest.raises(
        LinkwrightError, match=r"show that they belong to different recordings: morning.mcap, noon.mcap"
    ) as caught:
        BagReader(tmp_path / "drive")
    (diagnostic,) = caught.value.diagnostics
    assert "linkwright view FILE FILE" in str(diagnostic.hint)
    with BagReader(files[0], files=files) as bag:
        assert len(list(bag.messages())) == 7


def test_damaged_part_is_named(tmp_path: Path) -> None:
    files = write_parts(tmp_path, "mcap", ["drive_0", "drive_1"])
    files[1].write_bytes(b"nothing of the kind")
    with pytest.raises(LinkwrightError, match=r"'drive_1.mcap' cannot be read") as caught:
        BagReader(tmp_path / "drive")
    assert diagnostic_code(caught) == "BAG102"


@pytest.mark.parametrize(
    ("names", "are"),
    [
        (["a_0.mcap", "a_1.mcap"], True),
        (["a_3.db3.zstd", "a_4.db3.zstd"], True),
        (["a_0.mcap", "a_2.mcap"], False),
        (["a_0.mcap", "b_1.mcap"], False),
        (["a_0.mcap", "a_1.db3"], False),
        (["day_12_00_00.mcap", "day_12_00_01.mcap"], False),
        (["a.mcap", "b.mcap"], False),
    ],
)
def test_belong_together_matches_file_names(names: list[str], are: bool) -> None:
    assert belong_together([Path(name) for name in names]) is are


def test_empty_recording_can_be_read(tmp_path: Path) -> None:
    BagWriter(tmp_path / "bag").close()
    with BagReader(tmp_path / "bag") as bag:
        assert list(bag.messages()) == []
        assert "Messages:          0" in summarize_bag(bag)


def test_summary_lists_files_and_topics(tmp_path: Path) -> None:
    with BagReader(write_recording(tmp_path)) as bag:
        lines = summarize_bag(bag).splitlines()
        assert summarize_bag(bag, topic_names_only=True) == "/chatter\n/joint_states\n"
    assert lines[0] == ""
    assert lines[1] == "Files:             bag_0.mcap"
    assert lines[3] == "Storage id:        mcap"
    assert lines[4] == "Duration:          2.000000000s"
    assert lines[5].endswith("(1700000000.000000000)")
    assert lines[7] == "Messages:          4"
    assert lines[8] == (
        "Topic information: Topic: /chatter | Type: std_msgs/msg/String | Count: 3 | Serialization Format: cdr"
    )
    assert lines[9].startswith(" " * 19 + "Topic: /joint_states | ")


def test_missing_recording_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(LinkwrightError) as error:
        BagReader(tmp_path / "none")
    assert diagnostic_code(error) == "BAG101"


def test_folder_without_recording_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(LinkwrightError, match=r"neither a metadata\.yaml nor recording files"):
        BagReader(tmp_path)


@pytest.mark.parametrize("content", [b"", b"\x89MCAP", b"not a recording at all", b"\x89MCAP0\r\n" + bytes(100)])
def test_damaged_file_is_an_error(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "broken.mcap"
    path.write_bytes(content)
    with pytest.raises(LinkwrightError) as error:
        BagReader(path)
    assert diagnostic_code(error) == "BAG102"


@pytest.mark.parametrize(("cut", "left"), [(1, 300), (700, 300), (3000, 300), (10_000, 100), (20_000, 0)])
def test_truncated_file_gives_complete_chunks(tmp_path: Path, cut: int, left: int) -> None:
    path = tmp_path / "bag"
    with BagWriter(path) as writer:
        writer.add_topic("/chatter", "std_msgs/msg/String")
        for number in range(300):
            writer.write("/chatter", START_NS + number, serialize(String(data=f"number {number}")))
            if number % 100 == 99:
                writer.flush()
    file = path / "bag_0.mcap"
    data = file.read_bytes()
    file.write_bytes(data[:-cut])
    with BagReader(path) as bag:
        stamps = [stamp - START_NS for _, stamp, _ in bag.messages()]
        assert [finding.code for finding in bag.findings] == ["BAG109"]
    assert stamps == list(range(left))


def test_bag_info_warns_about_truncated_recording(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_recording(tmp_path)
    assert main(["bag", "info", str(path)]) == 0
    assert capsys.readouterr().err == ""
    with BagReader(path) as bag:
        assert not bag.findings
    file = path / "bag_0.mcap"
    file.write_bytes(file.read_bytes()[:-100])
    assert main(["bag", "info", str(path)]) == 0
    assert "warning[BAG109]" in capsys.readouterr().err


def test_existing_folder_is_not_overwritten(tmp_path: Path) -> None:
    write_recording(tmp_path)
    with pytest.raises(LinkwrightError) as error:
        BagWriter(tmp_path / "bag")
    assert diagnostic_code(error) == "BAG105"


def test_unknown_topic_error_suggests_nearest(tmp_path: Path) -> None:
    with BagReader(write_recording(tmp_path)) as bag, pytest.raises(LinkwrightError) as error:
        bag.messages(["/chater"])
    assert diagnostic_code(error) == "BAG103"
    assert "/chatter" in (error.value.diagnostics[0].hint or "")


@pytest.mark.parametrize(
    ("selection", "selected"),
    [
        (TopicSelection(all_topics=True), ["/a", "/b/c"]),
        (TopicSelection(all_topics=True, include_hidden=True), ["/a", "/b/c", "/b/_hidden"]),
        (TopicSelection(names=["/a", "/b/_hidden"]), ["/a", "/b/_hidden"]),
        (TopicSelection(types=["std_msgs/msg/String"]), ["/a"]),
        (TopicSelection(pattern="^/b"), ["/b/c"]),
        (TopicSelection(all_topics=True, without_pattern="b"), ["/a"]),
        (TopicSelection(all_topics=True, without_names=["/a"]), ["/b/c"]),
        (TopicSelection(all_topics=True, without_types=["std_msgs/msg/String"]), ["/b/c"]),
        (TopicSelection(names=["/a"], without_pattern="a"), []),
        (TopicSelection(all_services=True), ["/s/_service_event"]),
        (TopicSelection(services=["/s"]), ["/s/_service_event"]),
        (TopicSelection(all_services=True, without_services=["/s"]), []),
        (TopicSelection(pattern="^/[sa]$"), ["/a", "/s/_service_event"]),
    ],
)
def test_topic_selection_filters_topics(selection: TopicSelection, selected: list[str]) -> None:
    topics = [
        ("/a", "std_msgs/msg/String"),
        ("/b/c", "std_msgs/msg/Int32"),
        ("/b/_hidden", "std_msgs/msg/Int32"),
        ("/s/_service_event", "std_srvs/srv/Empty_Event"),
    ]
    assert [name for name, kind in topics if selection.selects(name, kind)] == selected
    assert not selection.is_empty


def test_invalid_topic_pattern_is_reported() -> None:
    with pytest.raises(LinkwrightError) as error:
        TopicSelection(pattern="(")
    assert diagnostic_code(error) == "BAG104"


def test_qos_profiles_survive_recording() -> None:
    qos = QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        reliability=ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
        deadline=Duration(seconds=1.5),
        lifespan=Duration(nanoseconds=7),
    )
    round_trip = from_library(to_library(qos))
    for policy in ("history", "reliability", "durability", "deadline", "lifespan", "liveliness"):
        assert getattr(round_trip, policy) == getattr(qos, policy)


def test_recording_qos_requests_no_more_than_publishers_offer() -> None:
    assert choose_recording_profile([DEFAULT_QOS, SENSOR_DATA_QOS]).reliability is ReliabilityPolicy.BEST_EFFORT
    assert choose_recording_profile([DEFAULT_QOS]).reliability is ReliabilityPolicy.RELIABLE
    assert choose_recording_profile([DESCRIPTION_QOS]).durability is DurabilityPolicy.TRANSIENT_LOCAL
    assert choose_recording_profile([DESCRIPTION_QOS, DEFAULT_QOS]).durability is DurabilityPolicy.VOLATILE


def test_playing_qos_matches_recorded_qos_if_publishers_agree() -> None:
    assert choose_playing_profile([DESCRIPTION_QOS, DESCRIPTION_QOS]) == DESCRIPTION_QOS
    assert choose_playing_profile([DESCRIPTION_QOS, SENSOR_DATA_QOS]) == QoSProfile(depth=10)


def test_playing_qos_uses_largest_recorded_history() -> None:
    """History and depth do not affect compatibility (as in rosbag2)."""
    profiles = [QoSProfile(depth=20), QoSProfile(depth=50, lifespan=Duration(seconds=1.0)), QoSProfile(depth=1)]
    assert choose_playing_profile(profiles) == profiles[1]
    keep_all = QoSProfile(history=HistoryPolicy.KEEP_ALL)
    assert choose_playing_profile([*profiles, keep_all]) == keep_all


def test_playing_qos_defaults_to_depth_ten_if_history_is_unknown() -> None:
    """Fast DDS does not announce history and depth."""
    unknown_history = QoSProfile(history=HistoryPolicy.UNKNOWN, depth=0)
    assert choose_playing_profile([from_library(to_library(unknown_history))]) == QoSProfile(depth=10)


def test_qos_overrides_are_parsed() -> None:
    document = {"/a": {"reliability": "best_effort", "depth": 3, "deadline": {"sec": 1, "nsec": 5}}}
    (qos,) = parse_overrides(document, "file").values()
    assert (qos.reliability, qos.depth) == (ReliabilityPolicy.BEST_EFFORT, 3)
    assert qos.deadline == Duration(nanoseconds=1_000_000_005)


@pytest.mark.parametrize(
    ("document", "message"),
    [
        ([1], "map topics"),
        ({"/a": {"reliability": "best_efort"}}, "best_effort"),
        ({"/a": {"reliabilty": "reliable"}}, "reliability"),
        ({"/a": {"depth": 0}}, "'depth'"),
        ({"/a": {"deadline": 5}}, "not a duration"),
    ],
)
def test_invalid_qos_overrides_are_reported(document: object, message: str) -> None:
    with pytest.raises(LinkwrightError) as error:
        parse_overrides(document, "qos.yaml")
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "BAG106"
    assert message in f"{diagnostic.message} {diagnostic.hint}"


@pytest.mark.parametrize(
    ("name", "beginning", "message"),
    [
        ("a.mcap", b"", "the file is empty"),
        ("a.mcap", b"no recording", "it does not begin with a MCAP header"),
        ("a.db3", b"no recording", "it does not begin with a SQLite header"),
        ("a.mcap", b"#ROSBAG V2.0\n", "it is a ROS 1 recording"),
        ("a.mcap", b"\x89MCAP0\r\n\x01", "it is a damaged or truncated MCAP file"),
        ("a.mcap", b"\n<!DOCTYPE html><html>", "it is a web page"),
        ("a.mcap", b"version https://git-lfs.github.com/spec/v1\n", "it is a Git LFS pointer"),
        ("a.mcap", b"\x28\xb5\x2f\xfd1234", "it is compressed with zstd"),
    ],
)
def test_wrong_file_format_is_identified(tmp_path: Path, name: str, beginning: bytes, message: str) -> None:
    (tmp_path / name).write_bytes(beginning)
    with pytest.raises(LinkwrightError, match=message) as error:
        BagReader(tmp_path / name)
    assert error.value.diagnostics[0].hint


def test_foreign_sqlite_database_is_reported(tmp_path: Path) -> None:
    with closing(sqlite3.connect(tmp_path / "a.db3")) as database:
        database.execute("CREATE TABLE cats (name TEXT)")
    with pytest.raises(LinkwrightError, match="an SQLite database without the tables of a recording"):
        BagReader(tmp_path / "a.db3")
