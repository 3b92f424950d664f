"""The files of a git commit, for comparison with the files of the working tree."""

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

_HOOK_VARIABLES = ("GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_PREFIX")
"""Variables that git sets for hooks, and that would override the repository of a file's folder."""


class Revision:
    """All files of a commit in a temporary folder, including included files and meshes.

    Neither the repository nor its working tree is changed. A file that was renamed after the commit is found by its old
    name, as git recognises it. Packages that are not in the commit are found from the working tree.

    Args:
        path: a file of the working tree.
        name: the commit in git's notation: ``HEAD``, ``main~2``, a tag or a hash.

    Attributes:
        name: the commit in git's notation.
        path: the file in the temporary folder.

    Raises:
        LinkwrightError: CLI341 if git is not installed, CLI342 if the file is not in a repository, CLI343 if there is
            no such commit, CLI344 if the commit does not contain the file, or CLI345 if git cannot write
            the files.
    """

    def __init__(self, path: Path, name: str) -> None:
        self.name = name
        real_path = path.resolve()
        if not real_path.is_file():
            hint = phrase("pass an existing file, and the commit after `--against`")
            raise LinkwrightError(
                Diagnostic("CLI344", phrase("there is no file '{path}'", path=display_path(path)), hint=hint)
            )
        self._repository_root = _find_repository_root(real_path)
        commit = _resolve_commit(self._repository_root, name)
        relative_path = real_path.relative_to(self._repository_root)
        if _git(self._repository_root, "cat-file", "-e", f"{commit}:{relative_path.as_posix()}").returncode != 0:
            relative_path = _path_before_rename(self._repository_root, commit, relative_path, name)
        self._folder = ScratchFolder("revision")
        self._root = Path(self._folder.name).resolve() / "files"
        try:
            self._write(commit)
        except BaseException:
            self.close()
            raise
        self.path = self._root / relative_path

    def close(self) -> None:
        """Remove the temporary folder."""
        self._folder.cleanup()

    @cached_property
    def finder(self) -> PackageFinder:
        """The finder of the commit's packages, and of other packages from the working tree."""
        return PackageFinder(start=[self.path.parent, self._repository_root, Path.cwd()], extra=self._packages)

    @cached_property
    def _packages(self) -> Mapping[str, Path]:
        source_folders = SourceScan(self._root.parent).packages()
        return {name: share_of_sources(name, folder) for name, folder in source_folders.items()}

    def label(self, file: str) -> str:
        """Return the name that git uses for a file of the commit, such as ``HEAD:robots/arm.urdf``.

        Other files keep their names.
        """
        try:
            relative_path = Path(os.path.realpath(file)).relative_to(self._root)
        except ValueError:
            return file
        return f"{self.name}:{relative_path.as_posix()}"

    def normalizers(self, finder: PackageFinder) -> tuple[Callable[[str], str], Callable[[str], str]]:
        """Return functions that make paths of the commit and of the other side comparable.

        Args:
            finder: the finder of the other description's packages.
        """
        other_shares = {name: share for name in self._packages if (share := finder.find(name)) is not None}
        return _path_normalizer(self._packages, self._root), _path_normalizer(other_shares, self._repository_root)

    def _write(self, commit: str) -> None:
        index = {"GIT_INDEX_FILE": str(self._root.parent / "index")}
        result = _git(self._repository_root, "read-tree", commit, environment=index)
        if result.returncode == 0:
            arguments = ("checkout-index", "--all", "--quiet", f"--prefix={self._root}{os.sep}")
            result = _git(self._repository_root, *arguments, environment=index)
        if result.returncode != 0:
            message = phrase(
                "git cannot write the files of commit '{name}': {reason}",
                name=self.name,
                reason=foreign(result.stderr.strip()),
            )
            raise LinkwrightError(Diagnostic("CLI345", message))


def _find_repository_root(path: Path) -> Path:
    """Return the root folder of the working tree that contains a file."""
    result = _git(path.parent, "rev-parse", "--show-toplevel")
    if result.returncode != 0:
        message = phrase("'{path}' is not in a git repository", path=display_path(path))
        hint = phrase("compare it with another file: `linkwright diff OLD NEW`")
        if "dubious ownership" in result.stderr:
            message = phrase("git does not trust the repository of '{path}'", path=display_path(path))
            hint = phrase("add the repository to git's setting safe.directory if you trust the other user who owns it")
        raise LinkwrightError(Diagnostic("CLI342", message, hint=hint))
    return Path(result.stdout.rstrip("\r\n")).resolve()


def _resolve_commit(top: Path, name: str) -> str:
    arguments = ("rev-parse", "--verify", "--quiet", f"{name}^{{commit}}")
    result = None if name.startswith("-") else _git(top, *arguments)
    if result is None or result.returncode != 0:
        message = phrase("there is no commit '{name}' in {folder}", name=name, folder=display_path(top))
        hint = phrase(
            "HEAD is the last commit; `git log --oneline` lists others, and `git fetch` downloads the commits "
            "of a server"
        )
        raise LinkwrightError(Diagnostic("CLI343", message, hint=hint))
    return result.stdout.strip()


def _path_before_rename(top: Path, commit: str, relative_path: Path, name: str) -> Path:
    """Return the path that a file of the working tree had in a commit, before it was renamed.

    The renaming need not be staged.

    Raises:
        LinkwrightError: CLI344 if git does not recognise the file as the new version of a file that was removed.
    """
    new_path = relative_path.as_posix()
    with ScratchFolder("revision") as folder:
        index = Path(folder) / "index"
        with suppress(OSError):
            shutil.copyfile(top / _git(top, "rev-parse", "--git-path", "index").stdout.rstrip("\r\n"), index)
        index_environment = {"GIT_INDEX_FILE": str(index)}
        _git(top, "add", "--intent-to-add", "--", new_path, environment=index_environment)
        arguments = ("diff", "--no-ext-diff", "--find-renames", "--diff-filter=R", "--name-status", "-z", commit)
        renames = _git(top, *arguments, environment=index_environment).stdout.split(
            "\0"
        )  # R087, old name, new name, ...
    for old_name, new_name in zip(renames[1::3], renames[2::3], strict=False):
        if new_name == new_path:
            return Path(old_name)
    message = phrase("commit '{name}' has no file '{inside}'", name=name, inside=new_path)
    if _git(top, "log", "--max-count=1", "--format=%h", "--", new_path).stdout:
        hint = phrase("run `git log -- {inside}` to list the commits that have it", inside=new_path)
    else:
        hint = phrase("no commit has it yet; compare it with another file: `linkwright diff OLD NEW`")
    raise LinkwrightError(Diagnostic("CLI344", message, hint=hint))


def _git(folder: Path, *words: str, environment: Mapping[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    """Run git in a folder with English output, and return the completed process.

    Raises:
        LinkwrightError: CLI341 if git is not installed.
    """
    variables = {name: value for name, value in os.environ.items() if name not in _HOOK_VARIABLES}
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
        raise LinkwrightError(Diagnostic("CLI341", phrase("git is not installed"), hint=hint)) from None


def _path_normalizer(shares: Mapping[str, Path], top: Path) -> Callable[[str], str]:
    replacements: Sequence[tuple[str, str]] = [
        *((str(share), f"package://{name}") for name, share in shares.items()),
        (str(top), "."),
    ]
    longest_first = sorted(replacements, key=lambda item: -len(item[0]))

    def normalize(words: str) -> str:
        for path, name in longest_first:
            words = words.replace(path, name)
        return words

    return normalize
