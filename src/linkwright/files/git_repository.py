"""A git repository: its commits, their files, and the changes between commits."""

from __future__ import annotations

import hashlib
import os
import subprocess
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, display_path, foreign, phrase
from linkwright.files.equal_files import pair_paths
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass

_HOOK_VARIABLES = ("GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_PREFIX")
"""Variables that git sets for hooks. They would override the repository of a folder."""

_SUBMODULE_MODE = "160000"
_PROGRAM_MODE = "100755"
_PLAIN_MODE = "100644"
_MAX_LFS_POINTER_BYTES = 1024
_LFS_POINTER = lazy_pattern(
    rb"version https://git-lfs\.github\.com/spec/v1\n(?:[^\n]+\n)*?"
    rb"oid sha256:(?P<hash>[0-9a-f]{64})\nsize (?P<size>\d+)"
)
_RAW = ("--raw", "-z", "--no-abbrev")
_SUBMODULES = ("--ignore-submodules=dirty",)
"""Compare submodules only by their commits. Else git reads ``.gitmodules``, and fails if that is not well-formed."""
_MAX_MISSING_FILES = 500
"""The maximum number of files without contents that are passed to git."""
_LINK_MODE = "120000"
_NO_FILE_MODE = "000000"

SHALLOW_HINT = phrase(
    "the clone is shallow; `git fetch --unshallow` downloads its history (in GitHub Actions: `fetch-depth: 0` for "
    "actions/checkout)"
)
"""The hint for a commit that a shallow clone lacks."""


@dataclass(frozen=True, slots=True)
class ChangedFile:
    """A file that differs between two commits, or between a commit and the working tree.

    Attributes:
        old_path: the path in the old commit, relative to the root of the repository; None for an added file.
        new_path: the path in the new commit or in the working tree; None for a removed file.
        is_submodule: whether the path is that of a submodule.
        is_executable: whether the file is a program in the new version, if only one version is; otherwise None.
        submodule_commits: the old and the new commit of a changed submodule; None if one is unknown.
    """

    old_path: str | None
    new_path: str | None
    is_submodule: bool = False
    is_executable: bool | None = None
    submodule_commits: tuple[str, str] | None = None

    @property
    def path(self) -> str:
        """The new path, or the old path of a removed file."""
        return self.new_path or self.old_path or ""


@dataclass(frozen=True, slots=True)
class _RawChange:
    """A changed file in the output of git.

    Attributes:
        file: the changed file.
        old_contents: the mode and hash of the old contents.
        hashes: the hashes of the contents that git stores.
    """

    file: ChangedFile
    old_contents: str
    hashes: tuple[str, ...]


class GitRepository:
    """The git repository of a folder.

    None of the methods changes the repository or its working tree.

    Args:
        folder: a folder of the working tree.
        subject: the name of the file or folder that the user named, for messages.
        hint: what the user can do if the folder is not in a repository.
        downloads_lfs: whether files of Git LFS are written with their contents, which may download them. Otherwise
            their pointers are written; see `read_lfs_pointer`.

    Attributes:
        root: the root folder of the working tree.

    Raises:
        LinkwrightError: CLI341 if git is not installed, or CLI342 if the folder is not in a repository.
    """

    def __init__(self, folder: Path, subject: str, hint: Phrase, *, downloads_lfs: bool = True) -> None:
        self.root = folder
        self._modes: dict[str, Mapping[str, str]] = {}
        self._variables = {} if downloads_lfs else {"GIT_LFS_SKIP_SMUDGE": "1"}
        result = self.run("rev-parse", "--show-toplevel")
        if result.returncode != 0:
            message = phrase("'{path}' is not in a git repository", path=subject)
            if "dubious ownership" in result.stderr:
                message = phrase("git does not trust the repository of '{path}'", path=subject)
                hint = phrase(
                    "add the repository to git's setting safe.directory if you trust the other user who owns it"
                )
            raise LinkwrightError(Diagnostic("CLI342", message, hint=hint))
        self.root = Path(result.stdout.rstrip("\r\n")).resolve()

    def run(
        self, *arguments: str, environment: Mapping[str, str] | None = None, text: str | None = None
    ) -> subprocess.CompletedProcess[str]:
        """Run git in the repository with English output, and return the completed process.

        Bytes of its output that are not UTF-8 become surrogates, as in the names of files that Python reads.
        Otherwise, files and symbolic links with such names would not be found.

        Args:
            arguments: the arguments of git.
            environment: variables of git's environment.
            text: the text that git reads.

        Raises:
            LinkwrightError: CLI341 if git is not installed, or CLI342 if the folder does not exist.
        """
        variables = {name: value for name, value in os.environ.items() if name not in _HOOK_VARIABLES}
        try:
            return subprocess.run(  # noqa: S603 - no shell; the user's word is not an option
                ["git", *arguments],  # noqa: S607 - the user's own git, found as the shell finds it
                cwd=self.root,
                env={**variables, "LC_ALL": "C", **self._variables, **(environment or {})},
                capture_output=True,
                input=text,
                encoding="utf-8",
                errors="surrogateescape",
                check=False,
            )
        except (FileNotFoundError, NotADirectoryError):
            if not self.root.is_dir():
                message = phrase("'{folder}' is not a folder", folder=display_path(self.root))
                raise LinkwrightError(Diagnostic("CLI342", message)) from None
            hint = phrase("install git, or compare two files: `linkwright diff OLD NEW`")
            raise LinkwrightError(Diagnostic("CLI341", phrase("git is not installed"), hint=hint)) from None

    def resolve(self, name: str) -> str | None:
        """Return the hash of a commit in git's notation, such as ``HEAD~2``.

        The result is None if there is no such commit.
        """
        if name.startswith("-"):
            return None
        result = self.run("rev-parse", "--verify", "--quiet", f"{name}^{{commit}}")
        return result.stdout.strip() if result.returncode == 0 else None

    def require_commit(self, name: str) -> str:
        """Return the hash of a commit in git's notation.

        Raises:
            LinkwrightError: CLI343 if there is no such commit.
        """
        commit = self.resolve(name)
        if commit is None:
            message = phrase("there is no commit '{name}' in {folder}", name=name, folder=display_path(self.root))
            raise LinkwrightError(Diagnostic("CLI343", message, hint=self._missing_commit_hint()))
        return commit

    def _missing_commit_hint(self) -> Phrase:
        if self.is_shallow:
            return SHALLOW_HINT
        return phrase(
            "HEAD is the last commit; `git log --oneline` lists others, and `git fetch` downloads the commits "
            "of a server"
        )

    @property
    def is_shallow(self) -> bool:
        """Whether the clone lacks a part of the history."""
        return self.run("rev-parse", "--is-shallow-repository").stdout.strip() == "true"

    def merge_base(self, commit: str, other: str) -> str | None:
        """Return the hash of the best common ancestor of two commits.

        The result is None if they have none in this clone.
        """
        result = self.run("merge-base", commit, other)
        return result.stdout.strip() if result.returncode == 0 else None

    def is_ancestor(self, commit: str, descendant: str) -> bool:
        """Return whether a commit is in the history of another one, or is the same commit."""
        return self.run("merge-base", "--is-ancestor", commit, descendant).returncode == 0

    def contains(self, commit: str, path: str) -> bool:
        """Return whether a commit contains a file, whose path is relative to the root."""
        return self.run("cat-file", "-e", f"{commit}:{path}").returncode == 0

    def list_working_files(self, *patterns: str) -> list[str]:
        """Return the paths of the working tree's files that git tracks or would add, relative to the root.

        Files of submodules are not listed.

        Args:
            patterns: the patterns of git of which a path matches at least one.
        """
        options = ("--cached", "--others", "--exclude-standard", "-z")
        return self.run("ls-files", *options, "--", *patterns).stdout.split("\0")[:-1]

    def list_files(self, commit: str) -> list[str]:
        """Return the paths of a commit's files, relative to the root."""
        return list(self._file_modes(commit))

    def list_symbolic_links(self, commit: str) -> list[str]:
        """Return the paths of a commit's symbolic links, relative to the root."""
        return [path for path, mode in self._file_modes(commit).items() if mode == _LINK_MODE]

    def _file_modes(self, commit: str) -> Mapping[str, str]:
        """Return git's modes of a commit's files, by the path relative to the root."""
        modes = self._modes.get(commit)
        if modes is None:
            entries = self.run("ls-tree", "-r", "-z", "--full-tree", commit).stdout.split("\0")[:-1]
            modes = self._modes[commit] = {path: mode for mode, path in map(_split_tree_entry, entries)}
        return modes

    def write_files(
        self,
        commit: str,
        folder: Path,
        index: Path,
        *,
        must_be_complete: bool = True,
        find_unused: Callable[[Sequence[str]], Collection[str]] | None = None,
    ) -> list[str]:
        """Write the files of a commit into a folder.

        Args:
            commit: the hash of the commit.
            folder: the folder, which is created.
            index: a file for an index of git, which is created.
            must_be_complete: whether it is an error if git cannot write some of the files, such as large ones that a
                partial clone has not downloaded.
            find_unused: returns those of the given paths whose files are not written, relative to the root; None to
                write all. Symbolic links are always written.

        Returns:
            The paths of the files that git could not write, relative to the root.

        Raises:
            LinkwrightError: CLI345 if git cannot write the files.
        """
        environment = {"GIT_INDEX_FILE": str(index)}
        result = self.run("read-tree", commit, environment=environment)
        is_read = result.returncode == 0
        if is_read:
            folder.mkdir(exist_ok=True)
            names = self.list_files(commit)
            unused = find_unused(names) if find_unused is not None else ()
            selection: Sequence[str] = ("--all",)
            text = None
            if unused:
                links = set(self.list_symbolic_links(commit))
                names = [name for name in names if name not in unused or name in links]
                selection, text = ("-z", "--stdin"), "".join(f"{name}\0" for name in names)
            arguments = ("checkout-index", *selection, "--quiet", f"--prefix={folder}{os.sep}")
            result = self.run(*arguments, environment=environment, text=text)
        if result.returncode == 0:
            return []
        if is_read and not must_be_complete:
            missing = [name for name in names if not os.path.lexists(folder / name)]
            if len(missing) < len(names):
                return missing
        message = phrase(
            "git cannot write the files of commit '{name}': {reason}",
            name=commit,
            reason=foreign(result.stderr.strip()),
        )
        raise LinkwrightError(Diagnostic("CLI345", message))

    def ignores(self, path: str, folder: Path) -> bool:
        """Return whether git ignores a path by the patterns of a version, or whether git cannot tell.

        Args:
            path: the path of a file that may be missing, relative to the root.
            folder: the folder with the files of the version, such as ``.gitignore``.
        """
        git_folder = self.run("rev-parse", "--absolute-git-dir").stdout.rstrip("\r\n")
        options = ("-C", str(folder), f"--git-dir={git_folder}", f"--work-tree={folder}")
        return self.run(*options, "check-ignore", "--no-index", "--quiet", "--", path).returncode != 1

    def has_ignored_files(self) -> bool:
        """Return whether the working tree contains files that git ignores.

        Hidden files and folders, and compiled Python files, do not count.
        """
        options = ("--others", "--ignored", "--exclude-standard", "--directory", "-z")
        names = self.run("ls-files", *options).stdout.split("\0")
        return any(
            not any(part.startswith(".") or part == "__pycache__" for part in name.split("/"))
            for name in names
            if name and not name.endswith(".pyc")
        )

    def changed_files(self, old_commit: str, new_commit: str | None = None) -> list[ChangedFile]:
        """Return the files that differ between two commits, sorted by path.

        Renamed files are recognized as git recognizes them; those whose contents the clone lacks, only if they are
        equal. Of several renamed files with equal contents, the old and new paths are paired by their similarity.

        Args:
            old_commit: the hash of the old commit.
            new_commit: the hash of the new commit; None for the files of the working tree, including files that
                git does not track and does not ignore.

        Raises:
            LinkwrightError: CLI346 if git cannot compare them.
        """
        commits = [old_commit] if new_commit is None else [old_commit, new_commit]
        result = self.run("diff", "--no-ext-diff", "--find-renames", *_SUBMODULES, *_RAW, *commits)
        if result.returncode != 0:
            result = self._compare_incomplete_commits(commits)
        if result.returncode != 0:
            message = phrase("git cannot compare the commits: {reason}", reason=foreign(result.stderr.strip()))
            raise LinkwrightError(Diagnostic("CLI346", message))
        files = _pair_equal_files(_parse_raw_changes(result.stdout))
        if new_commit is None:
            names = self.run("ls-files", "--others", "--exclude-standard", "-z").stdout.split("\0")
            files += [ChangedFile(None, name) for name in names if name]
        return sorted(files, key=lambda file: file.path)

    def _compare_incomplete_commits(self, commits: Sequence[str]) -> subprocess.CompletedProcess[str]:
        """Compare commits of a clone that lacks the contents of files, such as a partial clone.

        To recognize renamed files that were edited, git needs their contents. It therefore compares the files with
        known contents, and then the others, which it recognizes if they are equal.
        """
        command = (*(("diff-index",) if len(commits) == 1 else ("diff-tree", "-r")), *_SUBMODULES, *_RAW)
        result = self.run(*command, *commits)
        objects = self.run("cat-file", "--batch-all-objects", "--batch-check=%(objectname)")
        known = set(objects.stdout.split())
        missing = {
            path
            for change in _parse_raw_changes(result.stdout)
            if not change.file.is_submodule and not known.issuperset(change.hashes)
            for path in (change.file.old_path, change.file.new_path)
            if path is not None
        }
        if result.returncode != 0 or objects.returncode != 0 or not 0 < len(missing) <= _MAX_MISSING_FILES:
            return result
        results = [
            self.run(*command, option, *commits, "--", *(f":(top,{magic}literal){path}" for path in sorted(missing)))
            for magic, option in (("exclude,", "--find-renames"), ("", "--find-renames=100%"))
        ]
        if any(part.returncode != 0 for part in results):
            return result
        result.stdout = "".join(part.stdout for part in results)
        return result


def compute_file_hash(path: Path) -> str:
    """Return the SHA-256 hash of a file in hexadecimal.

    Raises:
        OSError: the file cannot be read.
    """
    return hashlib.sha256(path.read_bytes()).hexdigest()


@dataclass(frozen=True)
class LfsPointer:
    """A pointer of Git LFS, which replaces a file that was not fetched.

    Attributes:
        hash: the SHA-256 hash of the file in hexadecimal.
        size: the size of the file in bytes.
    """

    hash: str
    size: int


def read_lfs_pointer(path: Path) -> LfsPointer | None:
    """Return the pointer of Git LFS in a file, or None for any other file.

    Source: the specification of Git LFS, docs/spec.md.
    """
    try:
        with path.open("rb") as file:
            start = file.read(_MAX_LFS_POINTER_BYTES)
    except OSError:
        return None
    match = _LFS_POINTER.match(start)
    return LfsPointer(match["hash"].decode(), int(match["size"])) if match else None


def _split_tree_entry(entry: str) -> tuple[str, str]:
    """Return the mode and the path in a line of `git ls-tree`."""
    properties, _, path = entry.partition("\t")
    return properties.partition(" ")[0], path


def _pair_equal_files(changes: Iterable[_RawChange]) -> list[ChangedFile]:
    """Return the changed files, with the renamed files of equal contents paired by their paths."""
    groups: dict[str, list[ChangedFile]] = {}
    for change in changes:
        file = change.file
        is_moved = file.old_path is not None and file.old_path != file.new_path
        groups.setdefault(change.old_contents if is_moved else file.path, []).append(file)
    paired: list[ChangedFile] = []
    for group in groups.values():
        old_paths = [file.old_path for file in group if file.old_path]
        pairs = pair_paths(old_paths, [file.new_path for file in group if file.new_path]) if len(group) > 1 else {}
        if not pairs:
            paired += group
            continue
        for file in group:
            if file.new_path:
                paired.append(ChangedFile(pairs[file.new_path], file.new_path, file.is_submodule, file.is_executable))
        left = [path for path in old_paths if path not in pairs.values()]
        paired += [ChangedFile(path, None, group[0].is_submodule) for path in left]
    return paired


def _parse_raw_changes(text: str) -> Iterator[_RawChange]:
    """Yield the files in the output of ``git diff --raw -z``.

    A file is ``:OLDMODE NEWMODE OLDHASH NEWHASH STATUS``, a path and, if it was renamed, its new path. Each of them
    ends with a null byte.
    """
    fields = iter(text.split("\0"))
    for header in fields:
        if not header:
            return
        old_mode, new_mode, old_hash, new_hash, status = header.lstrip(":").split(" ")
        old_path = new_path = next(fields)
        if status.startswith(("R", "C")):
            new_path = next(fields)
        hashes = tuple(name for name in (old_hash, new_hash) if name.strip("0"))
        is_other_commit = old_mode == new_mode == _SUBMODULE_MODE and len({*hashes}) > 1
        file = ChangedFile(
            None if old_mode == _NO_FILE_MODE or status.startswith("C") else old_path,
            None if new_mode == _NO_FILE_MODE else new_path,
            _SUBMODULE_MODE in (old_mode, new_mode),
            new_mode == _PROGRAM_MODE if {old_mode, new_mode} == {_PROGRAM_MODE, _PLAIN_MODE} else None,
            (old_hash, new_hash) if is_other_commit else None,
        )
        yield _RawChange(file, f"{old_mode} {old_hash}", hashes)
