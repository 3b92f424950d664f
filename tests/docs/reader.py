"""A simulated reader of a page.

The reader has terminals, an empty home folder, and the installed wheel.

The reader types each line of the page's shell blocks and writes each file that has a title, in the order of the page.
A line that opens a page of Linkwright keeps its terminal until the next such line; other lines are typed beside it.
"""

from __future__ import annotations

import os
import re
import signal
import subprocess
import threading
import time
from codecs import getincrementaldecoder
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from tests.docs.pages import Block, read_blocks
from tests.domains import own_domain

TIMEOUT_S = 90.0
"""The time limit in seconds, which is long enough for a busy machine."""

_PROMPT = re.compile(r"\[status (\d+)\]\r?\n")
_PAGE = re.compile(r"linkwright (launch|sim|view|drive(?!.* --(show|write)$)) |ros2 launch ")
_ANY_PAGE = "Viewer: http://"
_ERROR_PATTERN = re.compile(r"Traceback|\[ERROR\]|\[FATAL\]|^error")


@dataclass(frozen=True)
class Outcome:
    """The known outcome of a line that does more than end with status 0.

    Attributes:
        output_text: a text that it prints, at the latest after the last line of its block.
        topic: the topic that it subscribes to; the reader waits for the subscription.
        node: the node that it starts; the reader waits for it.
        runs_on: whether it runs until the reader presses Ctrl-C, at the end of the block.
        error: part of the error that it prints, because the page shows a mistake.
        may_fail: whether it also may end with an error, such as one without a network.
    """

    output_text: str = ""
    topic: str = ""
    node: str = ""
    runs_on: bool = True
    error: str = ""
    may_fail: bool = False


class Terminal:
    """A bash on a pseudo-terminal whose prompts contain the exit status of the last command."""

    def __init__(self, environment: Mapping[str, str], folder: Path) -> None:
        self._terminal, theirs = os.openpty()
        self._shell = subprocess.Popen(
            ["setsid", "--ctty", "bash", "--noprofile", "--norc", "-i"],
            stdin=theirs,
            stdout=theirs,
            stderr=theirs,
            cwd=folder,
            env={**environment, "PROMPT_COMMAND": r'printf "[status %s]\n" $?', "PS1": "", "PS2": ""},
        )
        os.close(theirs)
        self._text = ""
        self._typed_at = 0
        self._changed = threading.Condition()
        self._reader_thread = threading.Thread(target=self._read)
        self._reader_thread.start()
        self.line = ""
        self.status()
        self.run("stty -echo; bind 'set enable-bracketed-paste off'")

    def _read(self) -> None:
        decoder = getincrementaldecoder("utf-8")("replace")
        while True:
            try:
                data = os.read(self._terminal, 65536)
            except OSError:  # all programs of the terminal have ended
                return
            with self._changed:
                self._text += decoder.decode(data)
                self._changed.notify_all()

    @property
    def output(self) -> str:
        """Return the output since the last line was typed."""
        return self._text[self._typed_at :]

    @property
    def is_free(self) -> bool:
        """Return whether the last line has ended."""
        return _PROMPT.search(self.output) is not None

    def type(self, line: str) -> None:
        """Type a line and the enter key."""
        self.line = line
        with self._changed:
            self._typed_at = len(self._text)
        os.write(self._terminal, f"{line}\n".encode())

    def wait_for(self, text: str) -> None:
        """Wait until the line has printed a text; fail if the line ends before."""
        with self._changed:
            is_done = self._changed.wait_for(lambda: text in self.output or self.is_free, TIMEOUT_S)
        assert is_done, f"{self.line!r} prints no {text!r}:\n{self.output}"
        assert text in self.output, f"{self.line!r} ended before {text!r}:\n{self.output}"

    def status(self) -> int:
        """Wait for the end of the line, and return its exit status."""
        with self._changed:
            has_ended = self._changed.wait_for(lambda: self.is_free, TIMEOUT_S)
        assert has_ended, f"{self.line!r} has not ended:\n{self.output}"
        prompt = _PROMPT.search(self.output)
        assert prompt is not None
        return int(prompt[1])

    def run(self, line: str) -> str:
        """Type a line that must succeed, and return its output."""
        self.type(line)
        status = self.status()
        assert status == 0, f"{line!r} ended with {status}:\n{self.output}"
        return _PROMPT.split(self.output)[0]

    def interrupt(self) -> int:
        """Press Ctrl-C, and return the exit status of the line."""
        if not self.is_free:
            os.write(self._terminal, b"\x03")
        return self.status()

    def close(self) -> None:
        """Close the terminal's window."""
        self._shell.send_signal(signal.SIGHUP)
        # A shell that receives the signal just before it reads handles the signal after the next line. If the shell has
        # ended, another error reports that.
        with suppress(OSError):
            os.write(self._terminal, b"\n")
        self._shell.wait(TIMEOUT_S)
        self._reader_thread.join(TIMEOUT_S)
        os.close(self._terminal)


class Reader:
    """A reader of pages."""

    def __init__(self, environment: Mapping[str, str], home: Path, outcomes: Mapping[str, Outcome]) -> None:
        """Open the first terminal.

        Args:
            environment: the variables of the terminals.
            home: the home folder, in which the reader begins.
            outcomes: the known outcomes of some lines of the page.
        """
        self._environment = environment
        self._outcomes = outcomes
        self._first = Terminal(environment, home)
        self._page: Terminal | None = None
        self._side_terminals: list[Terminal] = []
        self._typed_lines: set[str] = set()
        self._launch_time = 0.0

    def follow(self, page: Path) -> None:
        """Type and write all blocks of the page."""
        try:
            for block in read_blocks(page):
                if block.title:
                    write_block(block, self._folder())
                elif block.language == "bash":
                    for line in block.text.splitlines():
                        self._do(line)
                    self._end_side_terminals()
            self._end_page()
        finally:
            for terminal in {*self._side_terminals, *filter(None, (self._page,)), self._first}:
                terminal.close()
        assert set(self._outcomes) <= self._typed_lines, f"not on the page: {set(self._outcomes) - self._typed_lines}"

    def _folder(self) -> Path:
        return Path(self._first.run("pwd").strip())

    def _do(self, line: str) -> None:
        outcome = self._outcomes.get(line, Outcome(runs_on=False))
        self._typed_lines.add(line)
        if _PAGE.match(line):
            self._end_page()
            self._page = self._first if line.startswith("ros2 ") else Terminal(self._environment, self._folder())
            self._page.type(line)
            self._page.wait_for(_ANY_PAGE)
            self._launch_time = time.monotonic()
            while outcome.node and not self._node_exists(outcome.node):
                assert not self._page.is_free, f"{line!r} has ended:\n{self._page.output}"
        elif outcome.runs_on:
            count_before = self._subscribers(outcome.topic)
            terminal = Terminal(self._environment, self._folder())
            self._side_terminals.append(terminal)
            terminal.type(line)
            while outcome.topic and self._subscribers(outcome.topic) == count_before:
                self._try_again(terminal)
            while outcome.node and not self._node_exists(outcome.node):
                self._try_again(terminal)
        else:
            self._first.type(line)
            while self._first.status() and not outcome.may_fail and self._try_again(self._first):
                pass
            assert self._first.status() == 0 or outcome.may_fail, f"{line!r}:\n{self._first.output}"
            assert outcome.output_text in self._first.output
            self._check(self._first)

    def _try_again(self, terminal: Terminal) -> bool:
        """Type a line again if it ended before the launched program was ready.

        Return whether that happened.
        """
        is_repeated = terminal.is_free and self._page is not None and time.monotonic() < self._launch_time + TIMEOUT_S
        if is_repeated:
            terminal.type(terminal.line)
        return is_repeated

    def _subscribers(self, topic: str) -> int:
        if not topic:
            return 0
        self._first.type(f"linkwright topic info {topic}")
        self._first.status()
        match = re.search(r"Subscription count: (\d+)", self._first.output)
        return int(match[1]) if match is not None else 0

    def _node_exists(self, node: str) -> bool:
        return node in self._first.run("linkwright node list").splitlines()

    def _end_side_terminals(self) -> None:
        for terminal in self._side_terminals:
            terminal.wait_for(self._outcomes[terminal.line].output_text)
            assert not terminal.is_free, f"{terminal.line!r} has ended:\n{terminal.output}"
        for terminal in reversed(self._side_terminals):
            self._end(terminal)
            terminal.close()
        self._side_terminals.clear()

    def _end_page(self) -> None:
        self._end_side_terminals()
        if self._page is not None:
            self._end(self._page)
            if self._page is not self._first:
                self._page.close()
        self._page = None

    def _end(self, terminal: Terminal) -> None:
        status = terminal.interrupt()
        assert status in (0, 130), f"{terminal.line!r} ended with {status}:\n{terminal.output}"
        self._check(terminal)

    def _check(self, terminal: Terminal) -> None:
        outcome = self._outcomes.get(terminal.line, Outcome())
        error_lines = [line for line in terminal.output.splitlines() if _ERROR_PATTERN.search(line)]
        if outcome.error:
            assert all(outcome.error in line for line in error_lines)
            assert error_lines, f"{terminal.line!r} did not print {outcome.error!r}:\n{terminal.output}"
        else:
            assert outcome.may_fail or not error_lines, f"{terminal.line!r}:\n{terminal.output}"


def write_block(block: Block, folder: Path) -> None:
    """Write a block with a title into the page's file; ``FILE, more`` adds to a file."""
    path = folder / block.title.removesuffix(", more")
    if path == folder / block.title:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(block.text, encoding="utf-8")
        return
    text = path.read_text(encoding="utf-8")
    if path.name == "package.xml":
        last = re.findall(r"^  <(?:depend|license)>.*\n", text, re.MULTILINE)[-1]
        new_text = text.replace(last, last + block.text)
    else:
        new_text = text.replace("</robot>", block.text + _make_symmetric_elements(block.text) + "</robot>")
    assert new_text != text
    path.write_text(new_text, encoding="utf-8")


def _make_symmetric_elements(text: str) -> str:
    """Return the elements that the reader must write by analogy.

    These are the right wheel and the back caster.
    """
    elements = "".join(re.findall(r"  <joint.*?</joint>\n|  <link.*?</link>\n", text, re.DOTALL))
    if "left_" in elements:
        return elements.replace("left", "right").replace("0.19", "-0.19")
    return elements.replace("front", "back").replace("0.18", "-0.18") if "front_" in elements else ""


def environment_of(installed: Path, home: Path) -> dict[str, str]:
    """Return the variables of a reader with Linkwright in an active virtual environment."""
    return {
        "PATH": f"{installed / 'bin'}:/usr/local/bin:/usr/bin:/bin",
        "VIRTUAL_ENV": str(installed),
        "HOME": str(home),
        "SHELL": "/bin/bash",
        "TERM": "dumb",
        "LANG": "C.UTF-8",
        "BROWSER": "true",
        "ROS_DOMAIN_ID": str(own_domain()),
    }
