"""Compressed files of recordings, with and without the metadata of their folder."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

from linkwright.bag import BagReader, is_recording
from linkwright.cli import main
from linkwright.diagnostics import LinkwrightError
from linkwright.messages import String, serialize, type_hash
from linkwright.messages.schema_text import schema_of

START_NS = 1_700_000_000_000_000_000
STRING = "std_msgs/msg/String"
MODES = [CompressionMode.FILE, CompressionMode.MESSAGE]
PLUGINS = [StoragePlugin.MCAP, StoragePlugin.SQLITE3]


def record_compressed(folder: Path, plugin: StoragePlugin, mode: CompressionMode, length: int = 20) -> Path:
    """Write a folder as `ros2 bag record --compression-mode` does.

    Messages of ``/a`` and ``/b`` alternate.
    """
    writer = Writer(folder, version=8, storage_plugin=plugin)
    writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        topics = [
            writer.add_connection(name, STRING, msgdef=schema_of(STRING), rihs01=type_hash(STRING))
            for name in ("/a", "/b")
        ]
        for number in range(length):
            writer.write(topics[number % 2], START_NS + number, serialize(String(data=f"number {number}" * 100)))
    return folder


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("plugin", PLUGINS)
def test_compressed_file_without_folder_has_same_messages(
    tmp_path: Path, plugin: StoragePlugin, mode: CompressionMode
) -> None:
    folder = record_compressed(tmp_path / "bag", plugin, mode)
    (file,) = (path for path in folder.iterdir() if path.name != "metadata.yaml")
    file_copy = tmp_path / file.name
    shutil.copy(file, file_copy)
    assert is_recording(file_copy)
    with BagReader(folder) as folder_reader, BagReader(file_copy) as file_reader:
        assert list(file_reader.messages()) == list(folder_reader.messages())
        assert file_reader.storage == folder_reader.storage == plugin.name.lower()
        for time_ns in (START_NS - 1, START_NS, START_NS + 7, START_NS + 30):
            assert file_reader.state_at(["/a", "/b"], time_ns) == folder_reader.state_at(["/a", "/b"], time_ns)
    (folder / "metadata.yaml").unlink()
    assert is_recording(folder)
    with BagReader(folder) as bag:
        assert len(list(bag.messages())) == 20


def test_truncated_compressed_mcap_gives_complete_messages(tmp_path: Path) -> None:
    folder = record_compressed(tmp_path / "bag", StoragePlugin.MCAP, CompressionMode.FILE, length=20_000)
    (file,) = folder.glob("*.mcap.zstd")
    cut = tmp_path / "cut.mcap.zstd"
    cut.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    with BagReader(cut) as bag:
        assert [finding.code for finding in bag.findings] == ["BAG109"]
        assert 0 < len(list(bag.messages())) < 20_000


def test_damaged_compressed_files_are_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plain = tmp_path / "plain.mcap.zstd"
    plain.write_text("not compressed")
    with pytest.raises(LinkwrightError, match="it does not begin with a zstd header"):
        BagReader(plain)
    (file,) = record_compressed(tmp_path / "bag", StoragePlugin.SQLITE3, CompressionMode.FILE, 20_000).glob("*.zstd")
    cut = tmp_path / "cut.db3.zstd"
    cut.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    assert main(["bag", "info", str(cut)]) == 1
    assert "its content is damaged or truncated" in capsys.readouterr().err


def test_missing_files_listed_in_metadata_are_named(tmp_path: Path) -> None:
    folder = record_compressed(tmp_path / "bag", StoragePlugin.SQLITE3, CompressionMode.MESSAGE)
    (folder / "bag.db3").unlink()
    with pytest.raises(LinkwrightError, match=r"files that its metadata.yaml lists are missing: bag\.db3$"):
        BagReader(folder)
