"""Find systemd units that are gone, or that start another program of ROS or with other names."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath
from typing import NamedTuple

from linkwright.diagnostics import Phrase, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.breaking import possible_name_reason
from linkwright.review.changed_lines import UNIT_SUFFIX, compare_lines, list_commands, list_started_programs
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.versions import Versions

_RUN = re.compile(r"(?:ros2 run|rosrun)\s+(?P<package>[\w-]+)\s+(?P<program>[\w.-]+)(?P<arguments>.*)")
_LAUNCH = re.compile(r"(?:ros2 launch|roslaunch)\s+(?P<package>[\w-]+)\s+(?P<program>[\w.-]+)(?P<arguments>.*)")
_NAMESPACE = "__ns"


class _Started(NamedTuple):
    """A program or launch file that a unit starts.

    Attributes:
        name: its package and name.
        names: the namespace and the remappings, by the name that they replace; empty for a launch file.
    """

    name: str
    names: dict[str, str]


def find_lost_units(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the removed and renamed units, and the units that start something else, each with a change."""
    for file in changed_files:
        path = file.old_path
        if path is None or not path.endswith(UNIT_SUFFIX) or file.is_submodule:
            continue
        name = PurePosixPath(path).name
        reason = phrase("computers that enable '{name}' do not find it", name=name)
        if file.new_path is None:
            commands = list_commands(versions.old, path)
            text = phrase("systemd unit removed")
            if commands is not None:
                text = phrase("{change}: {items}", change=text, items=commands)
            yield path, Change(text, Effect.BREAKING, reason, Location(path, 1, 1, is_old=True))
            continue
        if PurePosixPath(file.new_path).name != name:
            text = phrase("systemd unit '{name}' renamed", name=name)
            yield file.new_path, Change(text, Effect.BREAKING, reason, Location(file.new_path, 1, 1))
        changes = list(_compare_programs(versions, file))
        lines = compare_lines(versions, file) if changes else None
        if lines is not None:
            changes.append(Change(lines, location=Location(file.new_path, 1, 1)))
        yield from ((file.new_path, change) for change in changes)


def _compare_programs(versions: Versions, file: ChangedFile) -> Iterator[Change]:
    """Yield the programs that a unit starts in place of others, and the names that it gives them."""
    sides = ((versions.old, file.old_path or ""), (versions.new, file.new_path or ""))
    old, new = ([*map(_parse, list_started_programs(version, path))] for version, path in sides)
    location = Location(file.path, 1, 1)
    for before, after in zip(old, new, strict=False) if len(old) == len(new) else ():
        if before is None or after is None:
            continue
        if before.name != after.name:
            text = phrase("starts {new} instead of {old}", new=after.name, old=before.name)
            reason = phrase("the topics and services of {name} are missing", name=before.name)
            yield Change(text, Effect.BREAKING, reason, location)
            continue
        for key in dict.fromkeys((*before.names, *after.names)):
            values = [started.names.get(key, "") for started in (before, after)]
            if values[0] != values[1]:
                yield Change(*_describe(key, *values), location)


def _describe(key: str, old: str, new: str) -> tuple[Phrase, Effect, Phrase]:
    if key == _NAMESPACE:
        text = phrase("namespace {old} -> {new}", old=old or "/", new=new or "/")
        reason = phrase("programs that use names in '{namespace}' do not find them", namespace=old or "/")
        return text, Effect.BREAKING, reason
    text = phrase("remapping {name}: {old} -> {new}", name=key, old=old or "-", new=new or "-")
    return text, Effect.BREAKING, possible_name_reason(old or key)


def _parse(command: str) -> _Started | None:
    """Return what a command of ROS starts, or None for other commands."""
    run = _RUN.match(command)
    match = run or _LAUNCH.match(command)
    if match is None:
        return None
    try:
        words = shlex.split(match["arguments"])
    except ValueError:
        words = match["arguments"].split()
    pairs = [word.split(":=", 1) for word in words if ":=" in word] if run is not None else []
    names = {name: value for name, value in pairs if name == _NAMESPACE or not name.startswith("_")}
    return _Started(f"{match['package']}/{match['program']}", names)
