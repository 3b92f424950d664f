"""The earlier output that a new page receives."""

from __future__ import annotations

from linkwright.panels.terminal.environment import make_terminal_environment
from linkwright.panels.terminal.history import LINES, TerminalHistory


def history(*parts: str) -> str:
    history = TerminalHistory()
    for part in parts:
        history.add(part)
    return history.text()


def test_short_output_is_returned_unchanged() -> None:
    assert history() == ""
    assert history("\x1b[31mred\x1b[0m\r\n", "$ ") == "\x1b[31mred\x1b[0m\r\n$ "


def test_history_returns_last_lines() -> None:
    lines = [f"{number}\r\n" for number in range(3 * LINES)]
    shown = history(*lines, "$ ").splitlines()
    assert len(shown) == LINES
    assert (shown[0], shown[-1]) == (str(2 * LINES + 1), "$ ")


def test_terminal_modes_survive_long_output() -> None:
    text = history("\x1b[?1049h\x1b[?2004;25h\x1b[?25l", *(f"{number}\r\n" for number in range(2 * LINES)))
    assert text.startswith("\x1b[?1049h\x1b[?2004h\x1b[?25l")
    assert history("\x1b[?1049h", "\x1bc", "x\n" * 2 * LINES).startswith("x")


def test_output_without_newlines_uses_limited_memory() -> None:
    history = TerminalHistory()
    history.add("\x1b[?1000h")
    for _ in range(400):
        history.add("x" * 10_000)
        assert history._size <= 1024 * 1024 + 10_000
    assert history.text().startswith("\x1b[?1000h")
    assert len(history.text()) <= 512 * 1024 + 100


def test_terminal_modes_are_found_in_dropped_output() -> None:
    history = TerminalHistory()
    history.add("\x1b[?1h\n")
    history.add(("y" * 1000 + "\n") * 2000)
    assert history.text().startswith("\x1b[?1hy")


def test_shell_environment_gets_utf8_locale() -> None:
    assert make_terminal_environment({})["LC_CTYPE"] in ("C.UTF-8", "UTF-8")
    assert "LC_CTYPE" not in make_terminal_environment({"LANG": "zh_CN.UTF-8"})
    assert "LC_CTYPE" not in make_terminal_environment({"LC_ALL": "C"})
    environment = make_terminal_environment({"TERM": "dumb", "COLUMNS": "3", "PATH": "/bin"})
    assert (environment["TERM"], environment["COLORTERM"], environment["PATH"]) == (
        "xterm-256color",
        "truecolor",
        "/bin",
    )
    assert "COLUMNS" not in environment
