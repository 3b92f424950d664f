"""Report the changed lines of scripts, settings, device rules, container files and lists of packages."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from difflib import SequenceMatcher
from itertools import takewhile
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, counted, joined, joined_first, phrase
from linkwright.diagnostics.phrase import count_shown
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import MAX_NAMES
from linkwright.review.texts.excerpts import differing_excerpts, shorten
from linkwright.review.versions import Version, Versions

_SHELL_SUFFIXES = frozenset({".sh", ".bash", ".zsh"})
UNIT_SUFFIX = ".service"
"""The end of the names of units of systemd that start programs."""
_SETTINGS_SUFFIXES = frozenset({".ini", ".cfg", ".conf", ".properties", ".lua", ".toml", ".robot", ".material"})
"""The ends of the names of files with settings of programs and devices."""
_SETTINGS_OF_TOOLS = re.compile(r"\..*|(tox|pytest|mypy|ruff|pylint|flake8|setup|cspell|doxygen|poetry).*")
"""The names of files with settings of tools for developers, which no robot reads."""
_SETTINGS_COMMENT = re.compile(r"[#;]|//|--")
_CMAKE_END = re.compile(r"end(?:if|macro|function|foreach|while) ?\(.*\)", re.IGNORECASE)
"""The end of a block of CMake, which means something only with its beginning."""
_HEAD_BYTES = 100
_RULES_SUFFIX = ".rules"
_SUFFIXES = _SHELL_SUFFIXES | {_RULES_SUFFIX, UNIT_SUFFIX, ".dockerfile"}
_CONTAINER_FILE = re.compile(r"(.*\.)?(docker|container)file(\..*)?|(.*[.-])?compose([.-].*)?\.ya?ml")
_CONTAINER_LINE = re.compile(
    r"(?:FROM|EXPOSE|ENTRYPOINT|CMD)\b.*|(?:image|build|command|entrypoint|network_mode|privileged):.+"
)
"""The lines of container files with what is started, from which image, and with which rights."""
_FILE_NAME = re.compile(
    rf"{_CONTAINER_FILE.pattern}|\w*(packages?|apt|requirements?|dependencies)\w*\.txt|\.env|cmakelists\.txt|.*\.cmake"
)
_PACKAGE = re.compile(r"[A-Za-z0-9][\w.+:~<>=!-]*")
"""A line of a list of packages."""
_SHELL = re.compile(rb"#![^\n]*/(?:env[ \t]+)?(?:ba|z|da)?sh\b")
"""The first line of a shell script, whose name may have no suffix."""
_UNIT_COMMAND = re.compile(r"Exec\w+=")
"""The lines of a unit of systemd that start programs."""
_ROS_COMMAND = re.compile(r"\b(?:ros2 (?:run|launch)|rosrun|roslaunch)\b.*")
_PYTHON_COMMAND = re.compile(r"\bpython[\d.]* (?:-u )?\S+\.py\b")
_SECONDARY_COMMAND = re.compile(
    r"(?:echo|printf|sleep|wait|exit|trap|clear|set|return|if|elif|for|while|until|case|declare|local)\b.*"
    r"|[{}]|\w+ ?\(\) ?\{?|(?:fi|done|else|then|do|esac);?"
)
"""A line of a script that writes a message, waits, tests a condition, or has no command."""
_WORD = re.compile(r"""(?:"[^"]*"|'[^']*'|[^\s"']|["'])+""")
"""A word of a command, in which a quoted text stays whole."""
_MAX_LINES = 6
"""The maximum number of changed lines that are shown, except in a list of packages."""
_MAX_LINE_LENGTH = 160
_MAX_SHOWN = 4
"""The maximum number of added lines, and of removed ones, that are shown if there are many."""
_MAX_SHORT_LENGTH = 80
_MAX_COMMAND_LENGTH = 500
"""The maximum number of characters of a command, whose last words are its remappings."""
_MAX_BYTES = 1 << 18
_MIN_SIMILARITY = 0.5
_MIN_SHARE_OF_WORDS = 0.7
"""The minimum share of the words of two long commands that both have."""


def compare_lines(versions: Versions, file: ChangedFile) -> Phrase | None:
    """Return the added and removed lines of a text file, or None for other kinds of files.

    Comments and empty lines are left out. Of many lines, the first ones are given, and the number of the rest.
    """
    if file.old_path is None or file.new_path is None or file.is_submodule or not _has_lines(versions.new, file.path):
        return None
    paths = versions.old.file(file.old_path), versions.new.file(file.new_path)
    try:
        if any(text.stat().st_size > _MAX_BYTES for text in paths):
            return None
        old, new = ([*split_content_lines(text.read_text("utf-8"))] for text in paths)
        if _has_settings(file.path):
            old, new = ([line for line in lines if not _SETTINGS_COMMENT.match(line)] for lines in (old, new))
        old, new = ([line for line in lines if not _CMAKE_END.fullmatch(line)] for lines in (old, new))
    except (OSError, ValueError):
        return None
    removed, added = (list((Counter(a) - Counter(b)).elements()) for a, b in ((old, new), (new, old)))
    if not removed and not added:
        return None
    if all(map(_PACKAGE.fullmatch, (*removed, *added))):
        return _format_lines(joined_first(added, MAX_NAMES), joined_first(removed, MAX_NAMES))
    is_single_line = len(removed) == len(added) == 1
    if is_single_line and SequenceMatcher(None, removed[0], added[0], autojunk=False).ratio() >= _MIN_SIMILARITY:
        before, after = differing_excerpts(removed[0], added[0])
        return phrase("{old} -> {new}", old=before, new=after)
    changed = list(_take_changed_commands(removed, added))
    is_short = len(removed) + len(added) <= _MAX_LINES
    is_script = is_shell_script(versions.new, file.new_path)
    gained, lost = (_list_lines(lines, is_short=is_short, is_script=is_script) for lines in (added, removed))
    return _format_lines(gained, lost, changed)


def _list_lines(lines: list[str], *, is_short: bool, is_script: bool) -> Phrase | str:
    """Return lines in quotes: all of a short list, or the first ones of a long list; empty if there are none."""
    if is_short:
        return joined([f"`{shorten(line, _MAX_LINE_LENGTH)}`" for line in lines])
    if not lines:
        return ""
    return _format_commands(lines, _MAX_SHOWN, _MAX_SHORT_LENGTH) if is_script else _format_first(lines)


def _format_commands(lines: Sequence[str], limit: int, max_length: int) -> Phrase:
    """Return the commands of a long script that start programs of ROS or Python, and the number of its other lines."""
    commands = [line for line in lines if _find_rank(line) == 0]
    shown = commands[: count_shown(len(commands), limit)]
    texts: list[Phrase | str] = [f"`{shorten(line, max_length)}`" for line in shown]
    rest = len(lines) - len(shown)
    if rest and shown:
        texts.append(counted("{count} more line", "{count} more lines", rest))
    return joined(texts) if shown else counted("{count} line", "{count} lines", rest)


def _take_changed_commands(removed: list[str], added: list[str]) -> Iterator[Phrase]:
    """Yield the words that long commands gain and lose, and remove these commands from both lists.

    A command with the same words in another order is not a change of words.
    """
    for old in list(removed):
        words = _WORD.findall(old)
        for new in added:
            new_words = _WORD.findall(new)
            is_long = max(len(old), len(new)) > _MAX_LINE_LENGTH and words[0] == new_words[0]
            gained, lost = Counter(new_words) - Counter(words), Counter(words) - Counter(new_words)
            share = 1 - (gained.total() + lost.total()) / (len(words) + len(new_words))
            if is_long and (gained or lost) and share >= _MIN_SHARE_OF_WORDS:
                removed.remove(old)
                added.remove(new)
                change = _format_lines(_join_words(gained), _join_words(lost))
                yield phrase("{entry}: {change}", entry=f"`{_find_start(old, new)}`", change=change)
                break


def _join_words(words: Counter[str]) -> Phrase | str:
    return joined_first(list(words.elements()), MAX_NAMES) if words else ""


def _find_start(old: str, new: str) -> str:
    """Return the first words that two commands have in common, not more than a short line has."""
    common = takewhile(lambda pair: pair[0] == pair[1], zip(old.split(), new.split(), strict=False))
    return shorten(" ".join(word for word, _ in common), _MAX_SHORT_LENGTH)


def list_commands(version: Version, path: str) -> Phrase | None:
    """Return the first commands of an added or removed script, unit, container file or device rule, or None."""
    is_script = is_shell_script(version, path)
    is_container_file = _CONTAINER_FILE.fullmatch(PurePosixPath(path).name.lower()) is not None
    if not is_script and not is_container_file and not path.endswith((UNIT_SUFFIX, _RULES_SUFFIX)):
        return None
    lines = [*split_content_lines(version.text(path))]
    if is_container_file:
        lines = list(dict.fromkeys(line for line in lines if _CONTAINER_LINE.match(line)))
    elif path.endswith(UNIT_SUFFIX):
        lines = list_started_programs(version, path)
    if len(lines) > _MAX_LINES and is_script:
        return _format_commands(lines, _MAX_LINES, _MAX_COMMAND_LENGTH)
    return joined_first([f"`{shorten(line, _MAX_COMMAND_LENGTH)}`" for line in lines], _MAX_LINES) if lines else None


def list_started_programs(version: Version, path: str) -> list[str]:
    """Return the commands of a unit of systemd, from the part that starts a program of ROS on."""
    lines = split_content_lines(version.text(path))
    return [_find_started_program(line) for line in lines if _UNIT_COMMAND.match(line)]


def _find_started_program(line: str) -> str:
    """Return the part of a command that starts a program of ROS, or the whole command."""
    match = _ROS_COMMAND.search(line)
    return line if match is None else match[0].rstrip("'\"")


def _find_rank(line: str) -> int:
    """Return the rank of a line of a script: programs of ROS and Python come first, messages and pauses last."""
    if _SECONDARY_COMMAND.fullmatch(line):
        return 2
    return 0 if _ROS_COMMAND.search(line) or _PYTHON_COMMAND.search(line) else 1


def _format_first(lines: list[str]) -> Phrase:
    """Return the first lines in the order of their ranks."""
    ordered = sorted(lines, key=_find_rank)
    shown = count_shown(len(ordered), _MAX_SHOWN)
    texts: list[Phrase | str] = [f"`{shorten(line, _MAX_SHORT_LENGTH)}`" for line in ordered[:shown]]
    if len(ordered) > shown:
        texts.append(counted("{count} more line", "{count} more lines", len(ordered) - shown))
    return joined(texts)


def _format_lines(added: Phrase | str, removed: Phrase | str, changed: Sequence[Phrase] = ()) -> Phrase:
    parts = [*changed]
    if added:
        parts.append(phrase("{items} added", items=added))
    if removed:
        parts.append(phrase("{items} removed", items=removed))
    return joined(parts, "; ")


def _has_lines(version: Version, path: str) -> bool:
    name = PurePosixPath(path).name.lower()
    is_known = PurePosixPath(name).suffix in _SUFFIXES or _FILE_NAME.fullmatch(name) is not None
    return is_known or _has_settings(path) or is_shell_script(version, path)


def _has_settings(path: str) -> bool:
    name = PurePosixPath(path).name.lower()
    return PurePosixPath(name).suffix in _SETTINGS_SUFFIXES and _SETTINGS_OF_TOOLS.fullmatch(name) is None


def is_shell_script(version: Version, path: str) -> bool:
    """Return whether a file is a shell script by its suffix or its first line."""
    if PurePosixPath(path).suffix in _SHELL_SUFFIXES:
        return True
    try:
        with version.file(path).open("rb") as file:
            return _SHELL.match(file.read(_HEAD_BYTES)) is not None
    except OSError:
        return False


def split_content_lines(text: str) -> Iterable[str]:
    """Yield the lines of a text without comments, with continued lines as one."""
    for line in re.sub(r"\\\n\s*", "", text).splitlines():
        words = " ".join(line.split())
        if words and not words.startswith("#"):
            yield words
