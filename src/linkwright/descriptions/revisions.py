"""The files of a git commit, for comparison with the files of the working tree."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, phrase
from linkwright.files.git_repository import GitRepository
from linkwright.files.scratch_folders import ScratchFolder
from linkwright.packages import PackageFinder
from linkwright.packages.manifest import MANIFEST, SourceScan, package_name
from linkwright.packages.share_layout import find_share_of_sources


class CommitFiles:
    """The files of a commit in a temporary folder, including included files and meshes.

    Neither the repository nor its working tree is changed. Packages of other repositories are found from the working
    tree, but not those that the repository contains today and the commit does not. Symbolic links that point outside
    the folder are removed, because a commit must not show other files of the computer.

    Args:
        repository: the git repository of the commit.
        require_commit: the hash of the commit.
        name: the commit in git's notation, for users.
        must_be_complete: whether it is an error if git cannot write some of the files.
        find_unused: returns those of the given paths whose files are not needed; None if all are.

    Attributes:
        name: the commit in git's notation.
        root: the temporary folder with the files, which corresponds to the root folder of the repository.
        missing_files: the paths of the files that git cannot write, relative to the root.
        removed_links: the paths of the removed links, relative to the root.

    Raises:
        LinkwrightError: CLI345 if git cannot write the files.
    """

    def __init__(
        self,
        repository: GitRepository,
        commit: str,
        name: str,
        *,
        must_be_complete: bool = True,
        find_unused: Callable[[Sequence[str]], Collection[str]] | None = None,
    ) -> None:
        self.name = name
        self._repository = repository
        self._repository_root = repository.root
        self._folder = ScratchFolder("revision")
        self.root = Path(self._folder.name).resolve() / "files"
        try:
            self.missing_files = repository.write_files(
                commit,
                self.root,
                self.root.parent / "index",
                must_be_complete=must_be_complete,
                find_unused=find_unused,
            )
            self.removed_links = tuple(self._remove_outward_links(repository.list_symbolic_links(commit)))
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Remove the temporary folder."""
        self._folder.cleanup()

    def __getstate__(self) -> dict[str, object]:
        """Return the state for another process, which does not remove the folder."""
        return {name: value for name, value in vars(self).items() if name != "_folder"}

    def finder(self, folder: Path) -> PackageFinder:
        """Return a finder for a file's folder.

        It finds the commit's packages, and packages outside the repository, in submodules and in ignored folders of the
        working tree.
        """
        return self._finder.starting_at([folder, self._repository_root, Path.cwd()])

    @cached_property
    def _finder(self) -> PackageFinder:
        """The finder whose search of the source trees all others share."""
        manifests = self._repository.list_working_files(MANIFEST, f"*/{MANIFEST}")
        names = (package_name((self._repository_root / path).parent) for path in manifests)
        hidden = {name for name in names if name is not None}.difference(self.packages)
        return PackageFinder(start=[self._repository_root], extra=self.packages, hidden=hidden)

    @cached_property
    def packages(self) -> Mapping[str, Path]:
        """The share folders of the commit's packages, by the name of the package."""
        source_folders = SourceScan(self.root.parent).packages()
        return {name: find_share_of_sources(name, folder) for name, folder in source_folders.items()}

    def label(self, file: str) -> str:
        """Return the name that git uses for a file of the commit, such as ``HEAD:robots/arm.urdf``.

        Other files keep their names.
        """
        try:
            relative_path = Path(os.path.realpath(file)).relative_to(self.root)
        except ValueError:
            return file
        return f"{self.name}:{relative_path.as_posix()}"

    @property
    def normalize(self) -> Callable[[str], str]:
        """A function that makes the commit's paths comparable with those of other trees."""
        return _make_path_normalizer(self.packages, self.root)

    def normalizer_for(self, finder: PackageFinder) -> Callable[[str], str]:
        """Return a function that makes the working tree's paths comparable with this commit's.

        Args:
            finder: the finder of the working tree's packages.
        """
        shares = {name: share for name in self.packages if (share := finder.find(name)) is not None}
        return _make_path_normalizer(shares, self._repository_root)

    def _remove_outward_links(self, links: Sequence[str]) -> Iterator[str]:
        for link in links:
            path = self.root / link
            if leads_outside(path, self.root):
                path.unlink()
                yield link


def leads_outside(path: Path, root: Path) -> bool:
    """Return whether a symbolic link leaves the files of a commit, or enters git's folder.

    Args:
        path: a path below the root.
        root: the root folder of the repository or of the files, without symbolic links.
    """
    target = Path(os.path.realpath(path))  # Path.resolve refuses loops before Python 3.13
    return path.is_symlink() and (not target.is_relative_to(root) or target.is_relative_to(root / ".git"))


def file_in_commit(path: Path, name: str) -> tuple[CommitFiles, Path]:
    """Return the files of a commit, and the path among them of a file of the working tree.

    A file that was renamed after the commit is found by its old name, as git recognizes it. The caller closes the
    files.

    Args:
        path: a file of the working tree.
        name: the commit in git's notation: ``HEAD``, ``main~2``, a tag or a hash.

    Raises:
        LinkwrightError: CLI341 if git is not installed, CLI342 if the file is not in a repository, CLI343 if there is
            no such commit, CLI344 if the commit does not contain the file, or CLI345 if git cannot write
            the files.
    """
    real_path = path.resolve()
    if not real_path.is_file():
        hint = phrase("pass an existing file, and the commit after `--against`")
        message = phrase("there is no file '{path}'", path=display_path(path))
        raise LinkwrightError(Diagnostic("CLI344", message, hint=hint))
    hint = phrase("compare it with another file: `linkwright diff OLD NEW`")
    repository = GitRepository(real_path.parent, display_path(real_path), hint)
    commit = repository.require_commit(name)
    relative_path = real_path.relative_to(repository.root)
    if not repository.contains(commit, relative_path.as_posix()):
        relative_path = _find_path_before_rename(repository, commit, relative_path, name)
    files = CommitFiles(repository, commit, name)
    return files, files.root / relative_path


def _find_path_before_rename(repository: GitRepository, commit: str, relative_path: Path, name: str) -> Path:
    """Return the path that a file of the working tree had in a commit, before it was renamed.

    The renaming need not be staged.

    Raises:
        LinkwrightError: CLI344 if git does not recognize the file as the new version of a file that was removed.
    """
    new_path = relative_path.as_posix()
    with ScratchFolder("revision") as folder:
        index = Path(folder) / "index"
        with suppress(OSError):
            own_index = repository.run("rev-parse", "--git-path", "index").stdout.rstrip("\r\n")
            shutil.copyfile(repository.root / own_index, index)
        index_environment = {"GIT_INDEX_FILE": str(index)}
        repository.run("add", "--intent-to-add", "--", new_path, environment=index_environment)
        arguments = ("diff", "--no-ext-diff", "--find-renames", "--diff-filter=R", "--name-status", "-z", commit)
        renames = repository.run(*arguments, environment=index_environment).stdout.split(
            "\0"
        )  # R087, old name, new name, ...
    for old_name, new_name in zip(renames[1::3], renames[2::3], strict=False):
        if new_name == new_path:
            return Path(old_name)
    message = phrase("commit '{name}' has no file '{inside}'", name=name, inside=new_path)
    if repository.run("log", "--max-count=1", "--format=%h", "--", new_path).stdout:
        hint = phrase("run `git log -- {inside}` to list the commits that contain the file", inside=new_path)
    else:
        hint = phrase("no commit contains the file yet; compare it with another file: `linkwright diff OLD NEW`")
    raise LinkwrightError(Diagnostic("CLI344", message, hint=hint))


def _make_path_normalizer(shares: Mapping[str, Path], top: Path) -> Callable[[str], str]:
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
