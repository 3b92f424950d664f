"""Recording, playing and conversion by programs, with ``rosbag2_py``."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest
import rclpy
import rosbag2_py
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message, serialize_message
from rosbag2_py import CompressionMode, CompressionOptions, StorageOptions, TopicMetadata
from std_msgs.msg import String

from tests.recordings import needs_rosbags
from tests.waiting import wait_until

pytestmark = needs_rosbags


@pytest.fixture
def node():
    rclpy.init(args=[])
    node = rclpy.create_node("other")
    yield node
    rclpy.shutdown()


def write_recording(path: Path, *, writer=None, **options) -> Path:
    writer = writer or rosbag2_py.SequentialWriter()
    writer.open(StorageOptions(uri=str(path), storage_id="mcap", **options))
    profiles = [QoSProfile(depth=3)]
    writer.create_topic(
        TopicMetadata(
            id=0, name="/words", type="std_msgs/msg/String", serialization_format="cdr", offered_qos_profiles=profiles
        )
    )
    for number in range(4):
        writer.write("/words", serialize_message(String(data=f"word {number}")), 1000 + number * 10_000_000)
    writer.close()
    return path


def recorded_words(path: Path) -> list[str]:
    reader = rosbag2_py.SequentialReader()
    reader.open_uri(str(path))
    texts = []
    while reader.has_next():
        _, data, _ = reader.read_next()
        texts.append(deserialize_message(data, String).data)
    return texts


WORDS = [f"word {number}" for number in range(4)]


def test_recorder_records_until_canceled(node, tmp_path) -> None:
    options = rosbag2_py.RecordOptions()
    options.topics = ["/words"]
    options.disable_keyboard_controls = True
    storage = StorageOptions(uri=str(tmp_path / "drive"), max_bagfile_size=1024)
    recording = threading.Thread(target=lambda: rosbag2_py.Recorder("warn").record(storage, options, "my_recorder"))
    recording.start()
    talking = node.create_publisher(String, "/words", 10)

    def has_two_files() -> bool:
        talking.publish(String(data="x" * 2000))
        return (tmp_path / "drive" / "drive_1.mcap").exists()

    try:
        wait_until(has_two_files)
    finally:
        rosbag2_py.Recorder.cancel()
        recording.join()
    assert set(recorded_words(tmp_path / "drive")) == {"x" * 2000}


def test_recorder_canceled_before_start_ends_at_once(tmp_path) -> None:
    recorder = rosbag2_py.Recorder("warn")
    recorder.cancel()
    options = rosbag2_py.RecordOptions()
    options.all = True  # the name in Humble
    recorder.record(StorageOptions(uri=str(tmp_path / "drive")), options)
    assert (tmp_path / "drive" / "metadata.yaml").exists()
    with pytest.raises(RuntimeError, match="xxx"):
        rosbag2_py.Recorder("xxx")


def test_player_plays_until_canceled(node, tmp_path) -> None:
    texts: list[str] = []
    node.create_subscription(String, "/other_words", lambda message: texts.append(message.data), 10)
    options = rosbag2_py.PlayOptions()
    options.loop = True
    options.topic_remapping_options = ["--ros-args", "--remap", "/words:=/other_words"]
    storage = StorageOptions(uri=str(write_recording(tmp_path / "drive")))
    playing = threading.Thread(target=lambda: rosbag2_py.Player("warn").play(storage, options))
    playing.start()

    def has_heard_all() -> bool:
        rclpy.spin_once(node, timeout_sec=0.01)
        return set(texts) >= set(WORDS)

    try:
        wait_until(has_heard_all)
    finally:
        rosbag2_py.Player.cancel()
        playing.join()


def test_player_ends_with_recording_and_reports_missing_file(tmp_path) -> None:
    player = rosbag2_py.Player("warn")
    player.play(StorageOptions(uri=str(write_recording(tmp_path / "drive"))), rosbag2_py.PlayOptions())
    with pytest.raises(RuntimeError, match="no recording"):
        player.play(StorageOptions(uri=str(tmp_path / "none")), rosbag2_py.PlayOptions())


def test_reindexer_restores_metadata(tmp_path) -> None:
    path = write_recording(tmp_path / "drive")
    (path / "metadata.yaml").unlink()
    rosbag2_py.Reindexer().reindex(StorageOptions(uri=str(path), storage_id="mcap"))
    assert rosbag2_py.Info().read_metadata(str(path), "mcap").relative_file_paths == ["drive_0.mcap"]
    assert (path / "metadata.yaml").exists()
    with pytest.raises(RuntimeError):
        rosbag2_py.Reindexer().reindex(StorageOptions(uri=str(tmp_path / "none")))


def test_bag_rewrite_converts_recording(tmp_path) -> None:
    options = tmp_path / "options.yaml"
    options.write_text(f"output_bags: [{{uri: {tmp_path / 'new'}, storage_id: sqlite3, all: true}}]", encoding="utf-8")
    rosbag2_py.bag_rewrite([StorageOptions(uri=str(write_recording(tmp_path / "drive")))], str(options))
    assert recorded_words(tmp_path / "new") == WORDS
    with pytest.raises(RuntimeError, match="at least one input"):
        rosbag2_py.bag_rewrite([], str(options))


def test_writer_takes_snapshots_splits_and_compresses(tmp_path) -> None:
    writer = rosbag2_py.SequentialWriter()
    writer.open(StorageOptions(uri=str(tmp_path / "a"), snapshot_mode=True, max_cache_size=1000))
    assert writer.take_snapshot()
    writer.split_bagfile()
    writer.close()
    assert (tmp_path / "a" / "a_1.mcap").exists()
    options = CompressionOptions(compression_format="zstd", compression_mode=CompressionMode.FILE)
    path = write_recording(tmp_path / "b", writer=rosbag2_py.SequentialCompressionWriter(options))
    assert (path / "b_0.mcap.zstd").exists()
    assert recorded_words(path) == WORDS
    with pytest.raises(RuntimeError, match="cache size"):
        rosbag2_py.SequentialWriter().open(StorageOptions(uri=str(tmp_path / "c"), snapshot_mode=True))


def test_default_storage_id_and_compressors_are_returned() -> None:
    assert rosbag2_py.get_default_storage_id() == "mcap"
    assert rosbag2_py.get_registered_compressors() == {"zstd"}
    assert rosbag2_py.compression_mode_from_string("file") is CompressionMode.FILE
