"""Recordings of several files, snapshots, and conversions of recordings."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest
import yaml

from linkwright.bag import BagReader, BagWriter
from linkwright.bag.reindexing import reindex
from linkwright.bag.rewriting import rewrite
from linkwright.bag.writing import COMPRESSIONS, STORAGES
from linkwright.diagnostics import LinkwrightError
from linkwright.messages import String, serialize

SECOND_NS = 1_000_000_000
START = 1_700_000_000 * SECOND_NS
FORMS = [(storage, form) for storage in STORAGES for form in COMPRESSIONS if (storage, form) != ("sqlite3", "storage")]


def write_recording(
    path: Path, storage: str = "mcap", *, topic: str = "/words", count: int = 40, **options: Any
) -> Path:
    """Write a recording with a message of 10 kB every tenth of a second."""
    with BagWriter(path, storage, **options) as writer:
        writer.add_topic(topic, "std_msgs/msg/String")
        for number in range(count):
            writer.write(topic, START + number * SECOND_NS // 10, numbered_text(number))
    return path


def numbered_text(number: int) -> bytes:
    return serialize(String(data=f"{number:05}" * 2000))


def read_metadata(folder: Path) -> dict[str, Any]:
    document = yaml.safe_load((folder / "metadata.yaml").read_text(encoding="utf-8"))
    return document["rosbag2_bagfile_information"]  # type: ignore[no-any-return]  # YAML has no types


def read_content(path: Path) -> list[tuple[str, int, bytes]]:
    with BagReader(path) as bag:
        assert not bag.findings
        return [(topic, stamp, bytes(data)) for topic, stamp, data in bag.messages()]


def expected_messages(topic: str = "/words", count: int = 40) -> list[tuple[str, int, bytes]]:
    return [(topic, START + number * SECOND_NS // 10, numbered_text(number)) for number in range(count)]


@pytest.mark.parametrize(("storage", "compression"), FORMS)
def test_recording_splits_by_duration_and_metadata_lists_files(tmp_path, storage, compression) -> None:
    folder = write_recording(tmp_path / "drive", storage, compression=compression, max_seconds=1)
    suffix = (".mcap" if storage == "mcap" else ".db3") + (".zstd" if compression == "file" else "")
    names = [f"drive_{number}{suffix}" for number in range(4)]
    assert sorted(path.name for path in folder.iterdir()) == [*names, "metadata.yaml"]
    result = read_metadata(folder)
    assert result["relative_file_paths"] == names
    assert [(file["path"], file["message_count"]) for file in result["files"]] == list(
        zip(names, (11, 11, 11, 7), strict=True)
    )
    assert result["message_count"] == result["topics_with_message_count"][0]["message_count"] == 40
    assert result["duration"]["nanoseconds"] == 39 * SECOND_NS // 10
    assert read_content(folder) == expected_messages()


@pytest.mark.parametrize("storage", STORAGES)
def test_recording_splits_by_size(tmp_path, storage) -> None:
    folder = write_recording(tmp_path / "drive", storage, max_size=150_000)
    sizes = [path.stat().st_size for path in folder.iterdir() if path.suffix in (".mcap", ".db3")]
    assert len(sizes) >= 3
    assert max(sizes) < 200_000
    assert read_content(folder) == expected_messages()


def test_single_file_is_numbered_like_rosbag2(tmp_path) -> None:
    assert (write_recording(tmp_path / "drive") / "drive_0.mcap").exists()


@pytest.mark.parametrize("storage", STORAGES)
def test_split_size_below_rosbag2_minimum_is_rejected(tmp_path, storage) -> None:
    with pytest.raises(LinkwrightError, match="cannot be split into files as small as 10 bytes"):
        BagWriter(tmp_path / "drive", storage, max_size=10)
    assert not (tmp_path / "drive").exists()


def test_snapshot_writes_last_messages_within_size_limit(tmp_path) -> None:
    with BagWriter(tmp_path / "drive", snapshot_size=3 * len(numbered_text(0))) as writer:
        writer.add_topic("/words", "std_msgs/msg/String")
        for number in range(8):
            writer.write("/words", START + number * SECOND_NS // 10, numbered_text(number))
        assert writer.take_snapshot()
        writer.write("/words", START + SECOND_NS, numbered_text(9))
    assert read_content(tmp_path / "drive") == expected_messages(count=8)[5:]


def test_normal_recording_has_no_snapshots(tmp_path) -> None:
    with BagWriter(tmp_path / "drive") as writer:
        assert not writer.take_snapshot()


@pytest.mark.parametrize(("storage", "compression"), FORMS)
def test_reindex_restores_metadata(tmp_path, storage, compression) -> None:
    folder = write_recording(tmp_path / "drive", storage, compression=compression, max_seconds=1)
    before = read_metadata(folder)
    (folder / "metadata.yaml").unlink()
    reindex(folder)
    keys = ("relative_file_paths", "files", "message_count", "starting_time", "topics_with_message_count", "duration")
    assert {key: read_metadata(folder)[key] for key in keys} == {key: before[key] for key in keys}
    assert read_content(folder) == expected_messages()


def test_reindex_restores_killed_recording_of_several_files(tmp_path) -> None:
    folder = write_recording(tmp_path / "drive", max_seconds=1)
    last = folder / "drive_3.mcap"
    last.write_bytes(last.read_bytes()[:-200])
    (folder / "metadata.yaml").unlink()
    reindex(folder)
    with BagReader(folder) as bag:
        assert [stamp for _, stamp, _ in bag.messages()] == [stamp for _, stamp, _ in expected_messages()]


def test_reindex_rejects_folder_without_recording_files(tmp_path) -> None:
    with pytest.raises(LinkwrightError, match="no files of a recording"):
        reindex(tmp_path)


def write_options(tmp_path: Path, *outputs: dict[str, Any]) -> Path:
    path = tmp_path / "options.yaml"
    path.write_text(yaml.safe_dump({"output_bags": list(outputs)}), encoding="utf-8")
    return path


def test_rewrite_merges_by_time_and_splits_by_topics(tmp_path) -> None:
    first, second = (
        write_recording(tmp_path / "one"),
        write_recording(tmp_path / "other", "sqlite3", topic="/others", count=10),
    )
    folders = rewrite(
        [first, second],
        write_options(
            tmp_path,
            {"uri": str(tmp_path / "all"), "storage_id": "sqlite3", "all": True, "max_bagfile_duration": 2},
            {"uri": str(tmp_path / "some"), "topics": ["/others"], "compression_mode": "FILE"},
            {"uri": str(tmp_path / "part"), "regex": "wor", "start_time_ns": START + 2 * SECOND_NS},
        ),
    )
    assert [folder.name for folder in folders] == ["all", "some", "part"]
    assert read_content(folders[0]) == sorted(
        [*expected_messages(), *expected_messages("/others", 10)],
        key=lambda message: (message[1], message[0] != "/words"),
    )
    assert read_metadata(folders[0])["relative_file_paths"] == ["all_0.db3", "all_1.db3"]
    assert read_content(folders[1]) == expected_messages("/others", 10)
    assert (folders[1] / "some_0.mcap.zstd").exists()
    assert read_content(folders[2]) == expected_messages()[20:]


@pytest.mark.parametrize(
    ("document", "message"),
    [
        ("{}", "must have the key 'output_bags'"),
        ("output_bags: [{all: true}]", "must have the key 'uri'"),
        ("output_bags: [{uri: x, topics: /a}]", "'topics' must be a list of names"),
        ("output_bags: [{uri: x, storage_id: zip}]", "'storage_id' must be 'mcap' or 'sqlite3', not 'zip'"),
        ("output_bags: [{uri: x, max_bagfile_size: big}]", "'max_bagfile_size' must be an integer"),
        ("output_bags: [", "the recording options in '.*options.yaml' cannot be used: while parsing"),
    ],
)
def test_malformed_rewrite_options_are_rejected_before_writing(tmp_path, document, message) -> None:
    source = write_recording(tmp_path / "one", count=1)
    path = tmp_path / "options.yaml"
    path.write_text(document, encoding="utf-8")
    with pytest.raises(LinkwrightError, match=message):
        rewrite([source], path)
    shutil.rmtree(source)
    assert [path.name for path in tmp_path.iterdir()] == ["options.yaml"]
