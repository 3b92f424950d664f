"""The keys of a recording and a player, typed in a terminal of the test."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from linkwright.cli.bag.keys import SPACE, UP, reading_keys
from tests.waiting import eventually

pty = pytest.importorskip("pty")
termios = pytest.importorskip("termios")


@pytest.fixture
def keyboard(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """Return the typing end of a terminal; the other end is the standard input."""
    main, terminal = pty.openpty()
    with os.fdopen(terminal) as stdin:
        monkeypatch.setattr(sys, "stdin", stdin)
        monkeypatch.setattr(os, "tcgetpgrp", lambda _: os.getpgrp())
        yield main
    os.close(main)


async def test_reading_keys_calls_actions_and_restores_terminal(keyboard: int) -> None:
    before = termios.tcgetattr(sys.stdin)
    pressed: list[str] = []
    actions = {SPACE: lambda: pressed.append("space"), UP: lambda: pressed.append("up")}
    with reading_keys(actions) as listens:
        assert listens
        for key in (SPACE, "x", UP):
            os.write(keyboard, key.encode())
            count = len(pressed) + (key != "x")
            await eventually(lambda count=count: len(pressed) == count)
    assert pressed == ["space", "up"]
    assert termios.tcgetattr(sys.stdin) == before


async def test_reading_keys_ignores_terminal_in_background(keyboard: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "tcgetpgrp", lambda _: os.getpgrp() + 1)
    with reading_keys({}) as listens:
        assert not listens


async def test_reading_keys_requires_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    with Path(os.devnull).open() as null_device:  # noqa: ASYNC230  # which does not block
        monkeypatch.setattr(sys, "stdin", null_device)
        with reading_keys({}) as listens:
            assert not listens
