"""The files of a git commit, for comparison with those of the working tree."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, phrase
from linkwright.files.scratch_folders import ScratchFolder
from linkwright.packages import PackageFinder
from linkwright.packages.manifest import SourceScan
from linkwright.packages.share_layout import share_of_sources

_OF_HOOKS = ("GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_PREFIX")
"""Variables that git sets for hooks; they would override the repository of a file's folder."""


class Revision:
    """All files of a commit in a temporary folder, including included files and meshes.

    Neither the repository nor its working tree is changed. A file that was renamed after the commit is found by its old
    name, as git recognises it. Packages that are not in the commit are found from the working tree.

    Args:
        path: a file of the working tree.
        name: the commit, as git names it: ``HEAD``, ``main~2``, a tag or a hash.

    Attributes:
        name: the commit, as git names it.
        path: the file in the temporary folder.

    Raises:
        LinkwrightError: CLI341 if git is not installed, CLI342 if the file is not in a repository, CLI343 if there is
            no such commit, CLI344 if the commit does not contain the file, or CLI345 if git cannot write
            the files.
    """

    def __init__(self, path: Path, name: str) -> None:
        self.name = name
        real = path.resolve()
        if not real.is_file():
            hint = phrase("name an existing file; the commit follows `--against`")
            raise LinkwrightError(
                Diagnostic("CLI344", phrase("there is no file '{path}'", path=display_path(path)), hint=hint)
            )
        self._top = _top_of(real)
        commit = _commit(self._top, name)
        inside = real.relative_to(self._top)
        if _git(self._top, "cat-file", "-e", f"{commit}:{inside.as_posix()}").returncode != 0:
            inside = _path_before_rename(self._top, commit, inside, name)
        self._folder = ScratchFolder("revision")
        self._root = Path(self._folder.name).resolve() / "files"
        try:
            self._write(commit)
        except BaseException:
            self.close()
            raise
        self.path = self._root / inside

    def close(self) -> None:
        """Remove the temporary folder."""
        self._folder.cleanup()

    @cached_property
    def finder(self) -> PackageFinder:
        """The finder of the commit's packages, and of other packages from the working tree."""
        return PackageFinder(start=[self.path.parent, self._top, Path.cwd()], extra=self._packages)

    @cached_property
    def _packages(self) -> Mapping[str, Path]:
        found = SourceScan(self._root.parent).packages()
        return {name: share_of_sources(name, folder) for name, folder in found.items()}

    def label(self, file: str) -> str:
        """Return the name that git uses for a file of the commit, such as ``HEAD:robots/arm.urdf``.

        Other files keep their names.
        """
        try:
            inside = Path(os.path.realpath(file)).relative_to(self._root)
        except ValueError:
            return file
        return f"{self.name}:{inside.as_posix()}"

    def normalizers(self, finder: PackageFinder) -> tuple[Callable[[str], str], Callable[[str], str]]:
        """Return functions that make paths of the commit and of the other side comparable.

        Args:
            finder: the finder of the other description's packages.
        """
        theirs = {name: share for name in self._packages if (share := finder.find(name)) is not None}
        return _path_normalizer(self._packages, self._root), _path_normalizer(theirs, self._top)

    def _write(self, commit: str) -> None:
        index = {"GIT_INDEX_FILE": str(self._root.parent / "index")}
        done = _git(self._top, "read-tree", commit, environment=index)
        if done.returncode == 0:
            words = ("checkout-index", "--all", "--quiet", f"--prefix={self._root}{os.sep}")
            done = _git(self._top, *words, environment=index)
        if done.returncode != 0:
            message = phrase(
                "git cannot write the files of commit '{name}': {reason}",
                name=self.name,
                reason=foreign(done.stderr.strip()),
            )
            raise LinkwrightError(Diagnostic("CLI345", message))


def _top_of(path: Path) -> Path:
    """Return the root folder of the working tree that contains a file."""
    done = _git(path.parent, "rev-parse", "--show-toplevel")
    if done.returncode != 0:
        message = phrase("'{path}' is not in a git repository", path=display_path(path))
        hint = phrase("compare it with another file: `linkwright diff OLD NEW`")
        if "dubious ownership" in done.stderr:
            message = phrase("git does not trust the repository of '{path}'", path=display_path(path))
            hint = phrase("another user owns it; to trust it, add it to git's setting safe.directory")
        raise LinkwrightError(Diagnostic("CLI342", message, hint=hint))
    return Path(done.stdout.rstrip("\r\n")).resolve()


def _commit(top: Path, name: str) -> str:
    words = ("rev-parse", "--verify", "--quiet", f"{name}^{{commit}}")
    done = None if name.startswith("-") else _git(top, *words)
    if done is None or done.returncode != 0:
        message = phrase("there is no commit '{name}' in {folder}", name=name, folder=display_path(top))
        hint = phrase(
            "HEAD is the last commit; `git log --oneline` lists others, and `git fetch` downloads those of a server"
        )
        raise LinkwrightError(Diagnostic("CLI343", message, hint=hint))
    return done.stdout.strip()


def _path_before_rename(top: Path, commit: str, inside: Path, name: str) -> Path:
    """Return the path that a file of the working tree had in a commit, before it was renamed.

    The renaming need not be staged.

    Raises:
        LinkwrightError: CLI344 if git recognises the file in none of the files that were removed after the commit.
    """
    new = inside.as_posix()
    with ScratchFolder("revision") as folder:
        index = Path(folder) / "index"
        with suppress(OSError):
            shutil.copyfile(top / _git(top, "rev-parse", "--git-path", "index").stdout.rstrip("\r\n"), index)
        own = {"GIT_INDEX_FILE": str(index)}
        _git(top, "add", "--intent-to-add", "--", new, environment=own)
        words = ("diff", "--no-ext-diff", "--find-renames", "--diff-filter=R", "--name-status", "-z", commit)
        renames = _git(top, *words, environment=own).stdout.split("\0")  # R087, old name, new name, ...
    for old, renamed in zip(renames[1::3], renames[2::3], strict=False):
        if renamed == new:
            return Path(old)
    message = phrase("commit '{name}' has no file '{inside}'", name=name, inside=new)
    if _git(top, "log", "--max-count=1", "--format=%h", "--", new).stdout:
        hint = phrase("`git log -- {inside}` lists the commits that have it", inside=new)
    else:
        hint = phrase("no commit has it yet; compare it with another file: `linkwright diff OLD NEW`")
    raise LinkwrightError(Diagnostic("CLI344", message, hint=hint))


def _git(folder: Path, *words: str, environment: Mapping[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    """Run git in a folder with English output, and return the completed process.

    Raises:
        LinkwrightError: CLI341 if git is not installed.
    """
    variables = {name: value for name, value in os.environ.items() if name not in _OF_HOOKS}
    try:
        return subprocess.run(  # noqa: S603 - no shell; the user's word is not an option
            ["git", *words],  # noqa: S607 - the user's own git, found as the shell finds it
            cwd=folder,
            env={**variables, "LC_ALL": "C", **(environment or {})},
            capture_output=True,
            encoding="utf-8",
            errors="replace",
            check=False,
        )
    except FileNotFoundError:
        hint = phrase("install git, or compare two files: `linkwright diff OLD NEW`")
        raise LinkwrightError(Diagnostic("CLI341", phrase("there is no program git"), hint=hint)) from None


def _path_normalizer(shares: Mapping[str, Path], top: Path) -> Callable[[str], str]:
    known: Sequence[tuple[str, str]] = [
        *((str(share), f"package://{name}") for name, share in shares.items()),
        (str(top), "."),
    ]
    longest_first = sorted(known, key=lambda item: -len(item[0]))

    def normalize(words: str) -> str:
        for path, name in longest_first:
            words = words.replace(path, name)
        return words

    return normalize
