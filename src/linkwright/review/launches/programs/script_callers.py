"""Find callers that pass arguments which a Python program no longer reads."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.command_files import list_command_files
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.launches.programs.default_names import find_script
from linkwright.review.launches.programs.script_options import LAUNCH_SUFFIXES, accepts_option, read_accepted_options
from linkwright.review.launches.reading import read_outline
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.texts.list_changes import list_items
from linkwright.review.versions import Version, Versions

_POSITIONAL_READING = re.compile(r"\bsys\.argv\s*\[\s*[1-9:]")
_ANY_READING = re.compile(
    r"\b(?:argv|sys\.orig_argv|myargv|ArgumentParser|OptionParser|getopt|docopt|fire|click|typer|absl)\b"
)
_RUN_COMMAND = re.compile(r"(?:\bros2\s+run|\brosrun)\s+(?P<package>[\w-]+)\s+(?P<program>[\w.-]+)(?P<arguments>.*)")
_SCRIPT_PATH = re.compile(r"(?<![\w.-])(?P<path>(?:[\w.-]+/)*[\w-]+\.py)\b(?P<arguments>.*)")
_END_OF_ARGUMENTS = re.compile(r"\s(?:--ros-args\b|#|[;|&]|\d?>|<).*|[;|&].*")
_OPTION = re.compile(r"--[A-Za-z][\w-]*")
_REMAPPING = re.compile(r"[^\s=]*:=\S*")


def find_lost_arguments(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the callers that pass unknown arguments to a changed program.

    Each file with commands or launch file comes with a change.

    A program took positional arguments if its old version reads ``sys.argv`` by an index. Options of argparse are
    compared for shell scripts; see `find_refused_options` for launch files.
    """
    programs = {file.new_path: file.old_path for file in changed_files if _is_program(file)}
    ignoring_programs = {new for new, old in programs.items() if new and old and _ignores_arguments(versions, old, new)}
    changed_programs = [path for path in programs if path]
    stems = {PurePosixPath(path).stem for path in changed_programs}
    if not changed_programs:
        return
    for path in list_command_files(versions.new):
        text = versions.new.text(path)
        if any(stem in text for stem in stems) or "run " in text:
            yield from _compare_shell_script(versions, path, text, changed_programs, ignoring_programs)
    ignoring_stems = {PurePosixPath(path).stem for path in ignoring_programs}
    for path in versions.new.paths(LAUNCH_SUFFIXES) if ignoring_programs else ():
        text = versions.new.text(path)
        if is_launch_file(path) and (
            any(name in text for name in ignoring_stems) or "args" in text or "arguments" in text
        ):
            yield from _compare_launch_file(versions.new, path, ignoring_programs)


def _is_program(file: ChangedFile) -> bool:
    return bool(file.old_path and file.new_path) and PurePosixPath(file.path).suffix in (PYTHON_SUFFIX, "")


def _ignores_arguments(versions: Versions, old_path: str, new_path: str) -> bool:
    """Return whether only the old version of a program reads arguments of the command line."""
    old, new = versions.old.text(old_path), versions.new.text(new_path)
    return _POSITIONAL_READING.search(old) is not None and _ANY_READING.search(new) is None


def _compare_shell_script(
    versions: Versions, path: str, text: str, changed: Sequence[str], ignoring_programs: set[str]
) -> Iterator[tuple[str, Change]]:
    """Yield the lines of a shell script that pass unknown arguments, each as a change."""
    for number, line in enumerate(text.splitlines(), 1):
        called = _parse_call(versions.new, line, changed)
        if called is None:
            continue
        program, words = called
        location = Location(path, number, 1)
        if program in ignoring_programs and any(not word.startswith("-") for word in words):
            yield path, _make_ignored_change(program, location)
            continue
        old, new = (read_accepted_options(version.file(program)) for version in (versions.old, versions.new))
        for word in words if old is not None and new is not None else ():
            option = word.partition("=")[0]
            if (
                _OPTION.fullmatch(option)
                and accepts_option(old or (), option)
                and not accepts_option(new or (), option)
            ):
                name = PurePosixPath(program).name
                change_text = phrase("'{option}' is passed to '{program}'", option=option, program=name)
                reason = phrase("'{program}' does not accept '{option}'", option=option, program=name)
                yield path, Change(change_text, Effect.BREAKING, reason, location)


def _parse_call(version: Version, line: str, changed: Sequence[str]) -> tuple[str, list[str]] | None:
    """Return the changed program that a line starts, and its arguments, or None."""
    if line.lstrip().startswith("#"):
        return None
    run = _RUN_COMMAND.search(line)
    if run is not None:
        script = find_script(version.root, f"{run['package']}/{run['program']}")
        path = None if script is None else version.relative(str(script))
        return None if path not in changed or path is None else (path, _split_arguments(run["arguments"]))
    match = _SCRIPT_PATH.search(line)
    if match is None:
        return None
    matching_paths = [path for path in changed if f"/{path}".endswith(f"/{match['path'].lstrip('./')}")]
    return (matching_paths[0], _split_arguments(match["arguments"])) if len(matching_paths) == 1 else None


def _split_arguments(text: str) -> list[str]:
    """Return the arguments after the program in a command, without ROS arguments."""
    text = _END_OF_ARGUMENTS.sub("", f" {text}")
    try:
        words = shlex.split(text)
    except ValueError:
        words = text.split()
    return [word for word in words if not _REMAPPING.fullmatch(word)]


def _compare_launch_file(version: Version, path: str, ignoring_programs: set[str]) -> Iterator[tuple[str, Change]]:
    """Yield the nodes of a launch file that pass arguments to programs that ignore them."""
    try:
        outline = read_outline(version.file(path), version.root)
    except (LinkwrightError, UnreadableFileError, OSError, ValueError, RecursionError):
        return
    for entry in outline.entries:
        script: Path | None = find_script(version.root, entry.name) if entry.kind == "node" else None
        program = None if script is None else version.relative(str(script))
        text = entry.settings.get("arguments", "")
        words = list_items(text) if text.startswith("[") else text.split()
        words = words[: words.index("--ros-args")] if "--ros-args" in words else words
        if (
            program in ignoring_programs
            and program is not None
            and any(not _REMAPPING.fullmatch(word) for word in words)
        ):
            yield path, _make_ignored_change(program, Location(path, entry.span.line, entry.span.column))


def _make_ignored_change(program: str, location: Location) -> Change:
    name = PurePosixPath(program).name
    text = phrase("arguments are passed to '{program}', which no longer reads them", program=name)
    return Change(text, Effect.BREAKING, phrase("the program starts without the values"), location)
