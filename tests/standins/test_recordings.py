"""Recordings read and written by programs: ``rosbag2_py``."""

from __future__ import annotations

import dataclasses
import subprocess
import sys

import pytest
import rosbag2_py
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message, serialize_message
from rosbag2_py import (
    ConverterOptions,
    SequentialReader,
    SequentialWriter,
    StorageFilter,
    StorageOptions,
    TopicMetadata,
)
from rosidl_runtime_py.utilities import get_message
from std_msgs.msg import Int32, String

from linkwright.standins import process
from tests.recordings import needs_rosbags

pytestmark = needs_rosbags

CDR = ConverterOptions("cdr", "cdr")


def write_recording(path, storage="mcap", writer_class=SequentialWriter):
    writer = writer_class()
    writer.open(StorageOptions(uri=str(path), storage_id=storage), CDR)
    writer.create_topic(
        TopicMetadata(name="/words", type="std_msgs/msg/String", offered_qos_profiles=[QoSProfile(depth=3)])
    )
    writer.create_topic(TopicMetadata(7, "/numbers", "std_msgs/msg/Int32", "cdr"))
    for number in range(4):
        writer.write("/numbers", serialize_message(Int32(data=number)), 1000 + 10 * number)
        writer.write("/words", serialize_message(String(data=f"word {number}")), 1005 + 10 * number)
    writer.close()


def open_reader(path):
    reader = SequentialReader()
    reader.open(StorageOptions(str(path), "mcap"), ConverterOptions("", ""))
    return reader


def read_rest(reader):
    read = []
    while reader.has_next():
        topic, _, stamp_ns = reader.read_next()
        read.append((topic, stamp_ns))
    return read


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_written_messages_are_read(tmp_path, storage):
    write_recording(tmp_path / "bag", storage)
    reader = open_reader(tmp_path / "bag")
    types = {topic.name: topic.type for topic in reader.get_all_topics_and_types()}
    assert types == {"/numbers": "std_msgs/msg/Int32", "/words": "std_msgs/msg/String"}
    topic, data, stamp_ns = reader.read_next()
    assert (topic, stamp_ns) == ("/numbers", 1000)
    assert deserialize_message(data, get_message(types[topic])) == Int32(data=0)
    assert len(read_rest(reader)) == 7
    with pytest.raises(RuntimeError, match="Bag is at end"):
        reader.read_next()


def test_topics_are_filtered_and_seek_moves_to_time(tmp_path):
    write_recording(tmp_path / "bag")
    reader = open_reader(tmp_path / "bag")
    reader.set_filter(StorageFilter(topics=["/words"]))
    assert read_rest(reader) == [("/words", 1005 + 10 * number) for number in range(4)]
    reader.seek(1020)
    assert read_rest(reader) == [("/words", 1025), ("/words", 1035)]
    reader.reset_filter()
    reader.seek(1030)
    assert read_rest(reader) == [("/numbers", 1030), ("/words", 1035)]
    reader.set_filter(StorageFilter(topics=["/nothing"]))
    reader.seek(0)
    assert not reader.has_next()


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_changed_filter_neither_repeats_nor_skips_messages(tmp_path, storage):
    writer = SequentialWriter()
    writer.open(StorageOptions(str(tmp_path / "bag"), storage), CDR)
    for name in "abc":
        writer.create_topic(TopicMetadata(name=f"/{name}", type="std_msgs/msg/Int32"))
    for name, stamp_ns in ("a", 1), ("b", 2), ("a", 2), ("c", 2), ("b", 3), ("a", 9):
        writer.write(f"/{name}", serialize_message(Int32()), stamp_ns)
    writer.close()
    reader = open_reader(tmp_path / "bag")
    reader.set_filter(StorageFilter(topics=["/a"]))
    reader.read_next()
    assert reader.read_next()[::2] == ("/a", 2)
    reader.reset_filter()
    assert read_rest(reader) == [("/c", 2), ("/b", 3), ("/a", 9)]


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_messages_are_read_in_reverse(tmp_path, storage):
    write_recording(tmp_path / "bag", storage)
    reader = open_reader(tmp_path / "bag")
    forwards = read_rest(reader)
    reader.set_read_order(rosbag2_py.ReadOrder(reverse=True))
    reader.seek(2_000_000_000_000)
    assert read_rest(reader) == forwards[::-1]
    reader.seek(1015)
    assert reader.read_next()[::2] == ("/words", 1015)
    reader.set_filter(StorageFilter(topics=["/numbers"]))
    assert read_rest(reader) == [("/numbers", 1010), ("/numbers", 1000)]
    with pytest.raises(RuntimeError, match="File"):
        reader.set_read_order(rosbag2_py.ReadOrder(rosbag2_py.ReadOrderSortBy.File))


@pytest.mark.parametrize(
    ("storage_filter", "admitted"),
    [
        (StorageFilter(), ["/a/b", "/c"]),
        (StorageFilter(topics=["/c"]), ["/c"]),
        (StorageFilter(topics_regex="/a"), ["/a/b"]),
        (StorageFilter(topics=["/c"], topics_regex="/a"), ["/a/b", "/c"]),
        (StorageFilter(topics_regex_to_exclude="/a"), ["/c"]),
        (StorageFilter(exclude_topics=["/c"]), ["/a/b"]),
        (StorageFilter(services_events=["/c"]), ["/c"]),
        (StorageFilter(exclude_service_events=["/c"]), ["/a/b"]),
        (StorageFilter(regex_to_exclude="/a"), ["/c"]),
    ],
)
def test_storage_filter_selects_topics(storage_filter, admitted):
    assert [topic for topic in ("/a/b", "/c") if storage_filter.admits(topic)] == admitted


def test_metadata_is_read_without_messages(tmp_path):
    write_recording(tmp_path / "bag", writer_class=rosbag2_py.SequentialCompressionWriter)
    metadata = rosbag2_py.Info().read_metadata(str(tmp_path / "bag"), "mcap")
    assert (metadata.message_count, metadata.storage_identifier) == (8, "mcap")
    assert metadata.starting_time.nanoseconds == 1000
    assert metadata.duration.nanoseconds == 35
    words = next(topic for topic in metadata.topics_with_message_count if topic.topic_metadata.name == "/words")
    assert words.message_count == 4
    assert [profile.depth for profile in words.topic_metadata.offered_qos_profiles] == [3]


def test_metadata_is_written_and_read(tmp_path):
    write_recording(tmp_path / "bag")
    reader, metadata_io = open_reader(tmp_path / "bag"), rosbag2_py.MetadataIo()
    metadata = metadata_io.read_metadata(str(tmp_path / "bag"))
    for entry in metadata.topics_with_message_count:
        (topic_entry,) = (
            topic for topic in reader.get_all_topics_and_types() if topic.name == entry.topic_metadata.name
        )
        assert entry.topic_metadata == dataclasses.replace(topic_entry, id=0)
    assert [(file.path, file.message_count) for file in metadata.files] == [("bag_0.mcap", 8)]
    assert reader.get_metadata().files == metadata.files
    assert metadata_io.deserialize_metadata(metadata_io.serialize_metadata(metadata)).files == metadata.files
    metadata.custom_data = {"site": "north"}
    (tmp_path / "other").mkdir()
    metadata_io.write_metadata(str(tmp_path / "other"), metadata)
    assert metadata_io.read_metadata(str(tmp_path / "other")).custom_data == {"site": "north"}
    assert "Messages:          8" in str(metadata)
    assert not metadata_io.metadata_file_exists(str(tmp_path))
    with pytest.raises(RuntimeError, match=r"metadata\.yaml"):
        metadata_io.read_metadata(str(tmp_path))
    with pytest.raises(RuntimeError, match="bad conversion"):
        metadata_io.deserialize_metadata("[]")


def test_message_definitions_are_returned(tmp_path):
    write_recording(tmp_path / "bag")
    definitions = {
        definition.topic_type: definition for definition in open_reader(tmp_path / "bag").get_all_message_definitions()
    }
    local = rosbag2_py.LocalMessageDefinitionSource()
    assert definitions["std_msgs/msg/Int32"] == local.get_full_text("std_msgs/msg/Int32")
    assert "int32 data" in definitions["std_msgs/msg/Int32"].encoded_message_definition
    assert local.get_full_text("some_pkg") == rosbag2_py.MessageDefinition("some_pkg", "unknown", "", "")


def test_unknown_options_cannot_be_set():
    for options in (rosbag2_py.RecordOptions(), rosbag2_py.PlayOptions(), StorageOptions("bag")):
        with pytest.raises(AttributeError):
            options.all_topic = True


def test_topic_metadata_accepts_humble_and_later_arguments():
    old = TopicMetadata("/t", "std_msgs/msg/String", "cdr", "")
    new = TopicMetadata(
        id=0, name="/t", type="std_msgs/msg/String", serialization_format="cdr", offered_qos_profiles=""
    )
    assert old.equals(new)
    with pytest.raises(TypeError, match="unexpected arguments: kind"):
        TopicMetadata(name="/t", kind="x")


def test_invalid_use_raises_runtime_errors(tmp_path):
    with pytest.raises(RuntimeError, match="there is no recording"):
        open_reader(tmp_path / "nowhere")
    with pytest.raises(RuntimeError, match="not open"):
        SequentialReader().get_all_topics_and_types()
    writer = SequentialWriter()
    with pytest.raises(RuntimeError, match="not open"):
        writer.create_topic(TopicMetadata(name="/t", type="std_msgs/msg/String"))
    with pytest.raises(RuntimeError, match="no storage 'tape'"):
        writer.open(StorageOptions(str(tmp_path / "bag"), "tape"), CDR)
    writer.open(StorageOptions(str(tmp_path / "bag")), CDR)
    with pytest.raises(RuntimeError, match="unheard_msgs"):
        writer.create_topic(TopicMetadata(name="/t", type="unheard_msgs/msg/Thing"))
    with pytest.raises(RuntimeError, match="'/t' has not been created yet"):
        writer.write("/t", b"", 0)
    with pytest.raises(RuntimeError, match="it exists already"):
        SequentialWriter().open(StorageOptions(str(tmp_path / "bag")), CDR)
    writer.close()


def test_recording_is_complete_after_program_exit(tmp_path):
    program = """
from rosbag2_py._storage import ConverterOptions, StorageOptions, TopicMetadata
import rosbag2_py
from rclpy.serialization import serialize_message
from std_msgs.msg import String
writer = rosbag2_py.SequentialWriter()
writer.open(StorageOptions(uri="bag", storage_id="sqlite3"), ConverterOptions("", ""))
writer.create_topic(TopicMetadata(name="chatter", type="std_msgs/msg/String", serialization_format="cdr"))
writer.write("chatter", serialize_message(String(data="hello")), 5)
"""
    subprocess.run([sys.executable, "-c", program], cwd=tmp_path, env=process.create_environment(), check=True)
    assert read_rest(open_reader(tmp_path / "bag")) == [("chatter", 5)]
