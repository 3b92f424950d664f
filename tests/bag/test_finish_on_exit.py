"""The end of a recording that another thread writes while the process is being ended."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest

from linkwright.bag import BagReader, BagWriter
from linkwright.files.unfinished import finish_all
from linkwright.messages import String, serialize
from tests.waiting import TIMEOUT_S, wait_until

FORMS = {
    "mcap": ("bag", {}),
    "compressed": ("bag", {"compression": "storage"}),
    "sqlite3": ("bag", {"storage": "sqlite3"}),
    "file": ("bag.mcap", {"single_file": True}),
}


@pytest.fixture(params=FORMS)
def writer(request: pytest.FixtureRequest, tmp_path: Path) -> BagWriter:
    name, options = FORMS[request.param]
    writer = BagWriter(tmp_path / name, **options)
    writer.add_topic("/chatter", "std_msgs/msg/String")
    return writer


def message_times(path: Path) -> list[int]:
    """Return the times of a complete recording's messages."""
    with BagReader(path) as bag:
        stamps = [stamp for _, stamp, _ in bag.messages()]
        assert not bag.findings
    return stamps


def test_finish_all_completes_recording_while_thread_writes(writer: BagWriter) -> None:
    count = 0
    over = threading.Event()

    def write() -> None:
        nonlocal count
        while not over.is_set():
            writer.write("/chatter", count + 1, serialize(String(data="word " * 50)))
            writer.flush()
            count += 1

    thread = threading.Thread(target=write)
    thread.start()
    try:
        wait_until(lambda: count > 100 or not thread.is_alive())
        finish_all()
    finally:
        over.set()
        thread.join(TIMEOUT_S)
    numbers_written = message_times(writer.path)
    assert numbers_written == list(range(1, len(numbers_written) + 1))
    assert len(numbers_written) >= 100
    writer.close()
    assert message_times(writer.path) == numbers_written


def test_finish_all_leaves_closed_recording_unchanged(writer: BagWriter) -> None:
    writer.write("/chatter", 1, serialize(String(data="word")))
    writer.close()
    before = {path: path.stat().st_mtime_ns for path in (writer.path, *writer.path.glob("*"))}
    finish_all()
    assert {path: path.stat().st_mtime_ns for path in before} == before
