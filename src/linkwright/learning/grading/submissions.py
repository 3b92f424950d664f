"""Students' folders: search, untrusting reading, and copying."""

from __future__ import annotations

import os
import shutil
import stat
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import LinkwrightError, Phrase, counted, foreign, phrase
from linkwright.diagnostics.render import make_printable
from linkwright.learning.course import Course
from linkwright.learning.local_text import LocalText
from linkwright.learning.progress import PROGRESS_FILE, Progress, read_progress

_ARCHIVE_SUFFIXES = {".zip", ".tar", ".gz", ".tgz", ".bz2", ".xz", ".7z", ".rar"}
_SKIPPED_NAMES = {".git", "__pycache__", "__MACOSX"}
_MAX_PROGRESS_BYTES = 1 << 20
_MAX_FILES = 20_000
_MAX_BYTES = 256 << 20
_MAX_DEPTH = 64
"""The limits of a copied folder: the bytes of `learn.yaml`, files, bytes of all files, levels."""


@dataclass
class Submission:
    """The folder of a student.

    Attributes:
        student: the student's name, which is the folder's.
        folder: the workspace.
        progress: the claims of the student's progress file.
        notes: remarks about the folder for the teacher.
        is_readable: whether the folder can be graded.
    """

    student: str
    folder: Path
    progress: Progress
    notes: list[LocalText] = field(default_factory=list)
    is_readable: bool = True

    def note(self, text: Phrase) -> None:
        """Add a note."""
        self.notes.append(LocalText.from_phrase(text))


def find_submissions(folders: Sequence[Path], course: Course) -> list[Submission]:
    """Return the submission in each of the given folders, with notes."""
    absolute_folders = list(dict.fromkeys(_make_absolute(folder) for folder in folders))
    counts = Counter(folder.name for folder in absolute_folders)
    submissions = []
    for folder in absolute_folders:
        name = folder.name if counts[folder.name] == 1 else f"{folder.parent.name}/{folder.name}"
        submissions.append(_open_submission(make_printable(name), folder, course))
    return submissions


def _make_absolute(folder: Path) -> Path:
    """Return the absolute path without ``..``, so that it ends with a name.

    Links are not followed.
    """
    return Path(os.path.abspath(folder))  # noqa: PTH100 - `resolve` follows links


def _open_submission(student: str, folder: Path, course: Course) -> Submission:
    submission = Submission(student, folder, Progress(course.id, {}))
    try:
        submission.folder = _find_workspace(folder)
    except NotADirectoryError:
        submission.is_readable = False
        if folder.suffix.lower() in _ARCHIVE_SUFFIXES:
            submission.note(phrase("it is an archive; unpack it first"))
        else:
            submission.note(phrase("it is a file, not a student's folder"))
        return submission
    except OSError as error:
        submission.is_readable = False
        submission.note(phrase("the folder cannot be read: {error}", error=foreign(error.strerror or error)))
        return submission
    if (archive := _find_archive(submission.folder)) is not None:
        submission.is_readable = False
        submission.note(
            phrase("the folder contains only the archive '{name}'; unpack it first", name=_make_printable(archive.name))
        )
        return submission
    if submission.folder != folder:
        submission.note(
            phrase("the workspace is the folder '{name}' in it", name=_make_printable(submission.folder.name))
        )
    _read_claims(submission, course)
    return submission


def _find_workspace(folder: Path) -> Path:
    """Return the workspace: the folder, or its only subfolder.

    Unpacking an archive often creates such a subfolder.
    """
    entries = list(folder.iterdir())
    if _is_workspace(folder):
        return folder
    subfolders = [
        path for path in entries if path.is_dir() and not path.is_symlink() and path.name not in _SKIPPED_NAMES
    ]
    visible = [path for path in subfolders if not path.name.startswith(".")]
    return visible[0] if len(visible) == 1 and _is_workspace(visible[0]) else folder


def _find_archive(folder: Path) -> Path | None:
    """Return an archive in a folder that is not a workspace, or None.

    Downloads of a class contain archives.
    """
    if _is_workspace(folder):
        return None
    return next((path for path in sorted(folder.iterdir()) if path.suffix.lower() in _ARCHIVE_SUFFIXES), None)


def _is_workspace(folder: Path) -> bool:
    return (folder / PROGRESS_FILE).exists() or (folder / "src").is_dir()


def _read_claims(submission: Submission, course: Course) -> None:
    """Read the student's progress file, whose content is not trusted."""
    path = submission.folder / PROGRESS_FILE
    try:
        status = path.lstat()
        if not stat.S_ISREG(status.st_mode) or status.st_size > _MAX_PROGRESS_BYTES:
            submission.note(phrase("{file} is a link or too large, and was not read", file=PROGRESS_FILE))
            return
        progress = read_progress(submission.folder)
    except FileNotFoundError:
        progress = None
    except (LinkwrightError, RecursionError, OSError) as error:
        reason = error.diagnostics[0].message if isinstance(error, LinkwrightError) else foreign(type(error).__name__)
        submission.note(phrase("{file} cannot be read: {reason}", file=PROGRESS_FILE, reason=reason))
        return
    if progress is None:
        submission.note(phrase("there is no {file}, so there are no answers", file=PROGRESS_FILE))
    elif PurePosixPath(progress.course.replace("\\", "/")).name != course.id:
        name = make_printable(progress.course)
        submission.note(phrase("{file} belongs to the course '{name}' and was not used", file=PROGRESS_FILE, name=name))
    else:
        submission.progress = progress


def copy_workspace(submission: Submission, target: Path) -> bool:
    """Copy the files of a submission, and return whether that succeeded.

    Links, special files and unreadable files are omitted and mentioned in the notes.
    """
    omitted_counts: Counter[str] = Counter()
    count = size = 0
    target.mkdir()
    for path, status in _walk_entries(submission.folder, omitted_counts):
        copy = target / path.relative_to(submission.folder)
        if stat.S_ISDIR(status.st_mode):
            copy.mkdir(exist_ok=True)
            continue
        count, size = count + 1, size + status.st_size
        if count > _MAX_FILES or size > _MAX_BYTES:
            size_limit = _MAX_BYTES >> 20
            submission.note(
                phrase("the folder has more than {count} files or {size} MiB", count=_MAX_FILES, size=size_limit)
            )
            submission.is_readable = False
            return False
        try:
            shutil.copyfile(path, copy, follow_symlinks=False)
            copy.chmod(0o755 if status.st_mode & stat.S_IXUSR else 0o644)
        except OSError:
            omitted_counts["unreadable"] += 1
    for kind, number in sorted(omitted_counts.items()):
        submission.note(_describe_omitted_files(kind, number))
    return True


def _describe_omitted_files(kind: str, count: int) -> Phrase:
    if kind == "links":
        return counted("{count} link was left out", "{count} links were left out", count)
    if kind == "special":
        return counted(
            "{count} pipe, socket or device was left out", "{count} pipes, sockets or devices were left out", count
        )
    if kind == "deep":
        return counted(
            "{count} folder is nested too deeply and was left out",
            "{count} folders are nested too deeply and were left out",
            count,
        )
    return counted(
        "{count} file or folder cannot be read and was left out",
        "{count} files or folders cannot be read and were left out",
        count,
    )


def _walk_entries(folder: Path, omitted_counts: Counter[str]) -> Iterator[tuple[Path, os.stat_result]]:
    """Yield folders and regular files, in the same order on all systems.

    Each folder precedes its contents.
    """
    pending_folders = [(folder, 0)]
    while pending_folders:
        current, depth = pending_folders.pop()
        try:
            paths = sorted(current.iterdir())
        except OSError:
            omitted_counts["unreadable"] += 1
            continue
        for path in paths:
            status = path.lstat()
            if path.name in _SKIPPED_NAMES:
                continue
            if stat.S_ISLNK(status.st_mode):
                omitted_counts["links"] += 1
            elif stat.S_ISDIR(status.st_mode) and depth < _MAX_DEPTH:
                yield path, status
                pending_folders.append((path, depth + 1))
            elif stat.S_ISDIR(status.st_mode):
                omitted_counts["deep"] += 1
            elif stat.S_ISREG(status.st_mode):
                yield path, status
            else:
                omitted_counts["special"] += 1


def _make_printable(name: str) -> str:
    """Return the name of a file as text that can be printed and written as UTF-8."""
    return make_printable(os.fsencode(name).decode("utf-8", "replace"))
