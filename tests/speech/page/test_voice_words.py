"""Words that pages enroll, and the user's file."""

from __future__ import annotations

import re
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import numpy as np
import pytest

from linkwright.speech.commands.command_file import DEFAULT_FILE, read_command_file
from linkwright.speech.enrolled.words import Words, find_words_path
from tests.speech.page.test_voice import frame
from tests.speech.voices import WORDS, say
from tests.viewer.scene import Client, open_page, open_world

STRINGS = Path(__file__).parents[3] / "frontend" / "src" / "strings"


@pytest.fixture(autouse=True)
def _own_file(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))


@asynccontextmanager
async def open_pages() -> AsyncIterator[tuple[Client, Client]]:
    """Open two pages with the words; the first one's microphone is open."""
    async with open_world() as world, open_page(world.viewer) as client, open_page(world.viewer) as other:
        for client_page in (client, other):
            await client_page.opened()
            await client_page.send("watch_words", watched=True)
            assert (await client_page.until("voice_words"))["words"] == []
        await client.send("talk", mode="ready")
        yield client, other


async def record(client: Client, name: str, samples: np.ndarray, *, has_gaps: bool = False) -> dict:
    await client.send("begin_take", name=name)
    for start in range(0, samples.size, 1600):
        await client.socket.send_bytes(frame(samples[start : start + 1600]))
    await client.send("end_take", has_gaps=has_gaps)
    return await client.until("take_judged", name=name)


async def test_word_is_enrolled_from_recordings():
    async with open_pages() as (client, other):
        for count in (1, 2, 3):
            result = await record(client, "stop", say(WORDS["stop"], seed=count))
            assert (result["code"], result["number"]) == (None, count)
            assert 0.1 < result["peak"] < 1.0
            assert result["seconds"] == pytest.approx(1.0 + 0.4, abs=0.3)
            message = await other.until("voice_words")
            assert (message["words"], message["enough"]) == ([{"name": "stop", "takes": count}], 3)
        assert Words.read(find_words_path()).names == ("stop",)


async def test_recording_with_gaps_is_rejected():
    async with open_pages() as (client, _):
        result = await record(client, "stop", say(WORDS["stop"]), has_gaps=True)
        assert result["code"] == "VOICE212"
        assert not Words.read(find_words_path()).names


async def test_silent_recording_is_rejected():
    async with open_pages() as (client, _):
        result = await record(client, "stop", np.zeros(16_000, np.int16))
        assert (result["code"], result["peak"]) == ("VOICE205", 0.0)
        assert "no audible word" in result["text"]
        assert Words.read(find_words_path()).names == ()


async def test_words_are_renamed_and_removed_in_order():
    async with open_pages() as (client, _):
        for name in ("stop", "back", "forward"):
            await record(client, name, say(WORDS[name]))
        await client.send("rename_word", name="stop", new_name="停止")
        message = await client.until("voice_words", problem=None)
        while [word["name"] for word in message["words"]] != ["停止", "back", "forward"]:
            message = await client.until("voice_words", problem=None)
        await client.send("rename_word", name="back", new_name="forward")
        while message["problem"] is None:
            message = await client.until("voice_words")
        assert message["problem"] == "a word cannot be named 'forward': a word with this name already exists"
        await client.send("remove_word", name="back")
        message = await client.until("voice_words", problem=None)
        assert [word["name"] for word in message["words"]] == ["停止", "forward"]


async def test_words_file_is_exported_and_imported():
    async with open_pages() as (client, _):
        await record(client, "stop", say(WORDS["stop"]))
        await client.send("request_words_file")
        text = (await client.until("voice_words_file"))["text"]
        find_words_path().unlink()
        await client.send("import_words", text=text)
        while (await client.until("voice_words"))["words"] != [{"name": "stop", "takes": 1}]:
            pass
        await client.send("import_words", text="[]")
        while (problem := (await client.until("voice_words"))["problem"]) is None:
            pass
        assert "cannot be read as a file of enrolled words" in problem
        assert Words.read(find_words_path()).names == ("stop",)


async def test_damaged_words_file_is_reported_and_kept():
    async with open_pages() as (client, other):
        find_words_path().parent.mkdir(parents=True)
        find_words_path().write_text("{")
        await client.send("begin_take", name="stop")
        await client.send("end_take", has_gaps=False)
        assert "it is not JSON" in (await client.until("voice_words"))["problem"]
        assert find_words_path().read_text() == "{"
        await other.send("watch_words", watched=True)
        assert "it is not JSON" in (await other.until("voice_words"))["problem"]


@pytest.mark.parametrize("language", ["en", "zh"])
def test_words_suggested_by_page_are_commands(language):
    (suggestions,) = re.findall(
        r"suggestions: \[(.*?)\]", (STRINGS / language / "voice.ts").read_text(encoding="utf-8")
    )
    commands = read_command_file(DEFAULT_FILE)
    for phrase in re.findall(r'"(.*?)"', suggestions):
        assert commands.match_command(phrase) is not None, phrase
