"""A reader who follows a page: in terminals, in an empty home folder, with the wheel that they installed.

The reader types each line of the page's shell blocks and writes each file that has a title, in the order of the page.
A line that starts a page goes on in its terminal until the next such line; other lines are typed beside it.
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

from tests.docs.pages import Block, blocks
from tests.domains import own_domain

PATIENCE = 90.0
"""Seconds to wait for anything; a busy machine is slow."""

_PROMPT = re.compile(r"\[status (\d+)\]\r?\n")
_PAGE = re.compile(r"linkwright (launch|sim|view|drive(?!.* --(show|write)$)) |ros2 launch ")
_ANY_PAGE = "Viewer: http://"
_BAD = re.compile(r"Traceback|\[ERROR\]|\[FATAL\]|^error")


@dataclass(frozen=True)
class Known:
    """What is known of a line that does more than end well.

    Attributes:
        shows: a text that it prints, at the latest after the last line of its block.
        hears: the topic that it subscribes to, which the reader waits for.
        node: the node that it starts, which the reader waits for.
        goes_on: whether it goes on until the reader presses Ctrl-C, at the end of the block.
        complains: part of the error that it prints, because the page shows what goes wrong.
        may_fail: whether it also may end with an error, as where there is no network.
    """

    shows: str = ""
    hears: str = ""
    node: str = ""
    goes_on: bool = True
    complains: str = ""
    may_fail: bool = False


class Terminal:
    """A bash on a pseudo-terminal, whose prompts say the exit status of the last command."""

    def __init__(self, environment: Mapping[str, str], folder: Path) -> None:
        self._own, theirs = os.openpty()
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
        self._reading = threading.Thread(target=self._read)
        self._reading.start()
        self.line = ""
        self.status()
        self.run("stty -echo; bind 'set enable-bracketed-paste off'")

    def _read(self) -> None:
        decoder = getincrementaldecoder("utf-8")("replace")
        while True:
            try:
                read = os.read(self._own, 65536)
            except OSError:  # all programs of the terminal have ended
                return
            with self._changed:
                self._text += decoder.decode(read)
                self._changed.notify_all()

    @property
    def output(self) -> str:
        """What was printed since the last line was typed."""
        return self._text[self._typed_at :]

    @property
    def is_free(self) -> bool:
        """Whether the last line has ended."""
        return _PROMPT.search(self.output) is not None

    def type(self, line: str) -> None:
        """Type a line and the enter key."""
        self.line = line
        with self._changed:
            self._typed_at = len(self._text)
        os.write(self._own, f"{line}\n".encode())

    def wait_for(self, text: str) -> None:
        """Wait until the line has printed a text; it fails where the line ends before."""
        with self._changed:
            came = self._changed.wait_for(lambda: text in self.output or self.is_free, PATIENCE)
        assert came, f"{self.line!r} prints no {text!r}:\n{self.output}"
        assert text in self.output, f"{self.line!r} ended without {text!r}:\n{self.output}"

    def status(self) -> int:
        """Wait for the end of the line, and return its exit status."""
        with self._changed:
            ended = self._changed.wait_for(lambda: self.is_free, PATIENCE)
        assert ended, f"{self.line!r} has not ended:\n{self.output}"
        prompt = _PROMPT.search(self.output)
        assert prompt is not None
        return int(prompt[1])

    def run(self, line: str) -> str:
        """Type a line that ends well, and return what it printed."""
        self.type(line)
        status = self.status()
        assert status == 0, f"{line!r} ended with {status}:\n{self.output}"
        return _PROMPT.split(self.output)[0]

    def interrupt(self) -> int:
        """Press Ctrl-C, and return the exit status of the line."""
        if not self.is_free:
            os.write(self._own, b"\x03")
        return self.status()

    def close(self) -> None:
        """Close the terminal's window."""
        self._shell.send_signal(signal.SIGHUP)
        with suppress(OSError):  # the shell has ended, of which another error tells
            os.write(self._own, b"\n")  # a shell that the signal meets just before it reads looks at it after the line
        self._shell.wait(PATIENCE)
        self._reading.join(PATIENCE)
        os.close(self._own)


class Reader:
    """Somebody who follows a page."""

    def __init__(self, environment: Mapping[str, str], home: Path, known: Mapping[str, Known]) -> None:
        """Open the first terminal.

        Args:
            environment: the variables of the terminals.
            home: the home folder, in which the reader begins.
            known: what is known of lines of the page.
        """
        self._environment = environment
        self._known = known
        self._first = Terminal(environment, home)
        self._page: Terminal | None = None
        self._beside: list[Terminal] = []
        self._typed: set[str] = set()
        self._launched = 0.0

    def follow(self, page: Path) -> None:
        """Do all that the page says in blocks."""
        try:
            for block in blocks(page):
                if block.title:
                    write(block, self._folder())
                elif block.language == "bash":
                    for line in block.text.splitlines():
                        self._do(line)
                    self._end_beside()
            self._end_page()
        finally:
            for terminal in {*self._beside, *filter(None, (self._page,)), self._first}:
                terminal.close()
        assert set(self._known) <= self._typed, f"not on the page: {set(self._known) - self._typed}"

    def _folder(self) -> Path:
        return Path(self._first.run("pwd").strip())

    def _do(self, line: str) -> None:
        known = self._known.get(line, Known(goes_on=False))
        self._typed.add(line)
        if _PAGE.match(line):
            self._end_page()
            self._page = self._first if line.startswith("ros2 ") else Terminal(self._environment, self._folder())
            self._page.type(line)
            self._page.wait_for(_ANY_PAGE)
            self._launched = time.monotonic()
            while known.node and not self._is_there(known.node):
                assert not self._page.is_free, f"{line!r} has ended:\n{self._page.output}"
        elif known.goes_on:
            before = self._subscribers(known.hears)
            terminal = Terminal(self._environment, self._folder())
            self._beside.append(terminal)
            terminal.type(line)
            while known.hears and self._subscribers(known.hears) == before:
                self._try_again(terminal)
            while known.node and not self._is_there(known.node):
                self._try_again(terminal)
        else:
            self._first.type(line)
            while self._first.status() and not known.may_fail and self._try_again(self._first):
                pass
            assert self._first.status() == 0 or known.may_fail, f"{line!r}:\n{self._first.output}"
            assert known.shows in self._first.output
            self._check(self._first)

    def _try_again(self, terminal: Terminal) -> bool:
        """Type a line again where it has ended because what was launched is not up yet; return whether that was so."""
        again = terminal.is_free and self._page is not None and time.monotonic() < self._launched + PATIENCE
        if again:
            terminal.type(terminal.line)
        return again

    def _subscribers(self, topic: str) -> int:
        if not topic:
            return 0
        self._first.type(f"linkwright topic info {topic}")
        self._first.status()
        match = re.search(r"Subscription count: (\d+)", self._first.output)
        return int(match[1]) if match is not None else 0

    def _is_there(self, node: str) -> bool:
        return node in self._first.run("linkwright node list").splitlines()

    def _end_beside(self) -> None:
        for terminal in self._beside:
            terminal.wait_for(self._known[terminal.line].shows)
            assert not terminal.is_free, f"{terminal.line!r} has ended:\n{terminal.output}"
        for terminal in reversed(self._beside):
            self._end(terminal)
            terminal.close()
        self._beside.clear()

    def _end_page(self) -> None:
        self._end_beside()
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
        known = self._known.get(terminal.line, Known())
        bad = [line for line in terminal.output.splitlines() if _BAD.search(line)]
        if known.complains:
            assert all(known.complains in line for line in bad)
            assert bad, f"{terminal.line!r} did not say {known.complains!r}:\n{terminal.output}"
        else:
            assert known.may_fail or not bad, f"{terminal.line!r}:\n{terminal.output}"


def write(block: Block, folder: Path) -> None:
    """Write a block with a title into the file that the page names; ``FILE, more`` adds to one."""
    path = folder / block.title.removesuffix(", more")
    if path == folder / block.title:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(block.text, encoding="utf-8")
        return
    text = path.read_text(encoding="utf-8")
    if path.name == "package.xml":
        last = re.findall(r"^  <(?:depend|license)>.*\n", text, re.MULTILINE)[-1]
        added = text.replace(last, last + block.text)
    else:
        added = text.replace("</robot>", block.text + _sisters(block.text) + "</robot>")
    assert added != text
    path.write_text(added, encoding="utf-8")


def _sisters(text: str) -> str:
    """What the page asks the reader to write alike: the right wheel after the left one, the back caster, too."""
    parts = "".join(re.findall(r"  <joint.*?</joint>\n|  <link.*?</link>\n", text, re.DOTALL))
    if "left_" in parts:
        return parts.replace("left", "right").replace("0.19", "-0.19")
    return parts.replace("front", "back").replace("0.18", "-0.18") if "front_" in parts else ""


def environment_of(installed: Path, home: Path) -> dict[str, str]:
    """The variables of a reader who has Linkwright in an environment of their own, active."""
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
