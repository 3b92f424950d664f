"""Open the two versions of a repository that a review compares."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Collection, Iterator, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import takewhile
from pathlib import Path, PurePosixPath

from linkwright.descriptions.pairs import Model
from linkwright.descriptions.revisions import CommitFiles, leads_outside
from linkwright.diagnostics import Diagnostic, LinkwrightError, Span, display_path, phrase
from linkwright.files.git_repository import SHALLOW_HINT, ChangedFile, GitRepository
from linkwright.lint.checking import Checker
from linkwright.lint.targets import DESCRIPTION_SUFFIXES as TARGET_SUFFIXES
from linkwright.lint.targets import find_targets
from linkwright.packages import PackageFinder
from linkwright.packages.manifest import (
    IGNORE_MARKERS,
    MANIFEST,
    ROSBUILD_MANIFEST,
    SKIPPED_FOLDERS,
    SourceScan,
    package_name,
)
from linkwright.packages.share_layout import find_share_of_sources
from linkwright.review.build_folders import find_build_files, find_generated_folders, split_generated
from linkwright.review.caching import cached_in_review
from linkwright.review.unprefixed_calls import DESCRIPTION_SUFFIXES, find_macros, find_prefixed_texts, is_of_ros1
from linkwright.xmltree import Overlay

TEST_FOLDERS = frozenset({"test", "tests"})
"""The names of test folders, whose files do not belong to a robot."""
_MAX_SEARCHED_BYTES = 1 << 20
_FILLED_SUFFIXES = (
    *(".urdf", ".xacro", ".srdf", ".sdf", ".world", ".launch", ".xml", ".yaml", ".yml", ".rviz"),
    *(".py", ".cpp", ".cc", ".c", ".h", ".hpp", ".sh", "CMakeLists.txt"),
)
"""The name endings of files that are of no use while they are empty."""
_INIT_FILE = "__init__.py"
_MAX_EMPTY_BYTES = 64
"""The maximum size of a file that has only blanks."""
_SUBMODULE = re.compile(r"^[ \t]*path[ \t]*=[ \t]*\"?(?P<path>.+?)\"?[ \t\r]*$", re.MULTILINE)
"""The line of ``.gitmodules`` with the path of a submodule."""
_DEFAULT_BRANCHES = ("origin/HEAD", "origin/main", "origin/master", "main", "master")


@dataclass(frozen=True)
class Version:
    """One of the two versions.

    Attributes:
        name: the commit in git's notation, or empty for the working tree.
        root: the folder with the files of the version, which corresponds to the root of the repository.
        commit: the files of the commit; None for the working tree.
        repository: the repository of both versions.
        is_old: whether it is the old version.
        entered: the folders that build tools skip, but that contain changed descriptions.
    """

    name: str
    root: Path
    commit: CommitFiles | None
    repository: GitRepository
    is_old: bool
    entered: frozenset[Path] = frozenset()

    def file(self, path: str) -> Path:
        """Return the file at a path relative to the root."""
        return self.root / path

    def relative(self, file: str | Path) -> str | None:
        """Return the path of a file relative to the root, or None for a file outside it."""
        real_path = Path(os.path.realpath(file))
        return real_path.relative_to(self.root).as_posix() if real_path.is_relative_to(self.root) else None

    def ignores(self, path: str) -> bool:
        """Return whether git ignores a path relative to the root, such as that of a generated file."""
        return self.repository.ignores(path, self.root)

    def text(self, path: str) -> str:
        """Return the text of a file at a path relative to the root.

        The result is empty if the file is unreadable or larger than 1 MiB.
        """
        return _read_text(self.root, path)

    def paths(self, suffixes: tuple[str, ...], folder: str = "") -> Iterator[str]:
        """Return the paths of files relative to the root, sorted by folder.

        Symbolic links, hidden folders, and folders that builds write are skipped.

        Args:
            suffixes: the endings of the names.
            folder: the folder to search, relative to the root; empty for all.
        """
        return (path for path in _list_files(self.root, folder) if path.endswith(suffixes))

    def package_of(self, path: str, manifests: Collection[str] = (MANIFEST,)) -> str | None:
        """Return the folder of the package that contains a file, or None if there is none.

        Args:
            path: the path of the file relative to the root.
            manifests: the names of the files that make a folder a package.

        Returns:
            The nearest such folder relative to the root; empty for the root.
        """
        parents = PurePosixPath(path).parents
        return _find_package(self.root, parents[0], tuple(manifests)) if parents else None

    def finder(self, folder: Path) -> PackageFinder:
        """Return the finder of packages for a file's folder."""
        if self._copies:
            shares = {**(self.shares if self.commit is not None else {}), **self._find_nearest_copies(folder)}
            return PackageFinder(start=[folder, self.root, Path.cwd()], extra=shares, sources_first=True)
        if self.commit is not None:
            return self.commit.finder(folder)
        return self._working_tree_finder.starting_at([folder, self.root, Path.cwd()])

    def share_of(self, package: str, folder: Path) -> Path | None:
        """Return the share folder of a package of the version, or None if there is none.

        Of several copies of the package, the copy nearest to the folder is used.

        Args:
            package: the name of the package.
            folder: the folder of the file that names the package.
        """
        return self._find_nearest_copies(folder).get(package) or self.shares.get(package)

    def checker(self) -> Checker:
        """Return a checker that finds the packages of this version.

        They take precedence over those of the working tree. Calls without the prefix are those of the compared robots.
        """
        return Checker(folders=(self.root,), shares=self.shares, overlay=self.overlay)

    def model(self, path: str, values: Mapping[str, str]) -> Model:
        """Return the model of a description in this version with values of its arguments."""
        file = self.file(path)
        return Model(file, values, self.finder(file.parent), self.commit, self.overlay)

    @cached_property
    def overlay(self) -> Overlay | None:
        """The descriptions of ROS 1 that call macros without the prefix, with the prefix; None if there are none."""
        manifests = (self.text(path) for path in self.paths((MANIFEST, ROSBUILD_MANIFEST)))
        if not any(map(is_of_ros1, manifests)):
            return None
        prefixed = find_prefixed_texts({str(self.file(path)): self.text(path) for path in self._descriptions})
        return Overlay(prefixed) if prefixed else None

    @cached_property
    def macros(self) -> frozenset[str]:
        """The names of the macros that the descriptions of the version define."""
        return find_macros(map(self.text, self._descriptions))

    @cached_property
    def submodules(self) -> frozenset[str]:
        """The paths of the submodules in ``.gitmodules``."""
        return frozenset(match["path"] for match in _SUBMODULE.finditer(self.text(".gitmodules")))

    @cached_property
    def _descriptions(self) -> list[str]:
        return list(self.paths(DESCRIPTION_SUFFIXES))

    @cached_property
    def shares(self) -> Mapping[str, Path]:
        """The share folders of the packages of the version, by the name of the package."""
        if self.commit is not None:
            return self.commit.packages
        return {name: find_share_of_sources(name, folder) for name, folder in SourceScan(self.root).packages().items()}

    @property
    def installed_shares(self) -> Mapping[str, Path]:
        """The share folders outside the version, which show the installed files, by the name of the package."""
        return {name: share for name, share in self.shares.items() if not share.is_relative_to(self.root)}

    def _find_nearest_copies(self, folder: Path) -> dict[str, Path]:
        """Return the nearest share folder of each package with several copies, by package name."""
        return {
            name: find_share_of_sources(name, max(copies, key=lambda copy: _count_common_parts(copy, folder)))
            for name, copies in self._copies.items()
        }

    @cached_property
    def _copies(self) -> Mapping[str, list[Path]]:
        """The folders of the packages with several copies, by the name of the package."""
        folders: dict[str, list[Path]] = {}
        for folder in find_targets([self.root]).packages:
            name = package_name(folder)
            if name is not None:
                folders.setdefault(name, []).append(folder)
        return {name: copies for name, copies in folders.items() if len(copies) > 1}

    def path_of_label(self, file: str) -> str:
        """Return the path of a file relative to the root.

        The file is given as a path or as returned by `Model.display_name`.
        """
        prefix = "" if self.commit is None else f"{self.commit.name}:"
        if prefix and file.startswith(prefix):
            return file.removeprefix(prefix)
        return self.relative(file) or file

    def with_relative_paths(self, finding: Diagnostic) -> Diagnostic:
        """Return a finding with paths of files in the repository relative to the root."""
        notes = tuple(note._replace(span=self._make_span_relative(note.span)) for note in finding.notes)
        return finding.with_changes(span=self._make_span_relative(finding.span), notes=notes)

    def _make_span_relative(self, span: Span | None) -> Span | None:
        return None if span is None else span._replace(file=self.relative(span.file) or span.file)

    @cached_property
    def _working_tree_finder(self) -> PackageFinder:
        return PackageFinder(start=[self.root, Path.cwd()], sources_first=True)


@cached_in_review(maxsize=1 << 16)
def _find_package(root: Path, folder: PurePosixPath, manifests: tuple[str, ...]) -> str | None:
    """Return the nearest package that contains a folder relative to the root; see `Version.package_of`."""
    if any((root / folder / name).is_file() for name in manifests):
        return "" if folder == PurePosixPath(".") else folder.as_posix()
    return _find_package(root, folder.parent, manifests) if folder.parents else None


@cached_in_review(maxsize=256)
def _list_files(root: Path, folder: str) -> tuple[str, ...]:
    """Return the paths of all files in a folder relative to the root; see `Version.paths`."""
    paths: list[str] = []
    for parent, folders, names in os.walk(root / folder):
        folders[:] = sorted(name for name in folders if not name.startswith(".") and name not in SKIPPED_FOLDERS)
        path = Path(parent).relative_to(root)
        paths += ((path / name).as_posix() for name in sorted(names) if _is_regular(f"{parent}{os.sep}{name}"))
    return tuple(paths)


def _is_regular(path: str) -> bool:
    """Return whether a path is that of a regular file, not of a symbolic link to one."""
    try:
        return stat.S_ISREG(os.lstat(path).st_mode)
    except OSError:
        return False


@cached_in_review(maxsize=64)
def _read_text(root: Path, path: str) -> str:
    """Return the text of a file at a path relative to the root; see `Version.text`."""
    file = root / path
    try:
        is_small = file.stat().st_size <= _MAX_SEARCHED_BYTES
        return file.read_bytes().decode("utf-8", errors="replace") if is_small else ""
    except OSError:
        return ""


def _count_common_parts(package: Path, folder: Path) -> int:
    """Return the number of leading folders that two paths have in common."""
    pairs = zip(package.parts, folder.parts, strict=False)
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pairs))


@dataclass(frozen=True)
class Versions:
    """Both versions, and the files that differ.

    Attributes:
        old: the old version.
        new: the new version.
        changed_files: the files that differ.
        generated_files: the files that differ in folders that colcon or catkin wrote, by the folder. They are not
            compared.
    """

    old: Version
    new: Version
    changed_files: list[ChangedFile]
    generated_files: Mapping[str, list[ChangedFile]] = field(default_factory=dict)

    @property
    def has_added_submodule(self) -> bool:
        """Whether the new version has a submodule, with files that are not compared, that the old one lacks."""
        return any(file.is_submodule and file.old_path is None for file in self.changed_files)

    def translate_paths(self, value: str, version: Version) -> str:
        """Return a value of one version, with its paths translated to those of the other version."""
        other = self.new if version.is_old else self.old
        folders = {share: other.shares[name] for name, share in version.shares.items() if name in other.shares}
        folders[version.root] = other.root
        for folder in sorted(folders, key=lambda path: -len(str(path))):
            pattern = rf"{re.escape(str(folder))}(?![^\s/])"
            value = str(folders[folder]).join(re.split(pattern, value))
        return value

    def close(self) -> None:
        """Remove the temporary folders."""
        for version in (self.old, self.new):
            if version.commit is not None:
                version.commit.close()


def names_commit(folder: Path, name: str) -> bool:
    """Return whether a text names a commit in the repository that contains a folder.

    Raises:
        LinkwrightError: CLI341, CLI342, git cannot find the repository.
    """
    return _open_repository(folder).resolve(name) is not None


def open_versions(folder: Path, range_text: str) -> Versions:
    """Return the versions that a range of commits names. The caller closes them.

    Args:
        folder: a folder of the repository.
        range_text: ``OLD..NEW``; ``OLD...NEW``, whose old version is the last common commit; ``OLD``, to compare with
            the working tree; or empty for the commits and changes since the default branch.

    Raises:
        LinkwrightError: CLI341 to CLI346, git cannot find or read the versions; REV101, the default branch is unknown;
            REV102, the commits have no common history.
    """
    repository = _open_repository(folder)
    old_name, new_name = _split_range(repository, range_text)
    old_commit = repository.require_commit(old_name)
    new_commit = repository.require_commit(new_name) if new_name else None
    if "..." in range_text or not range_text:
        old_commit = _find_common_commit(repository, old_commit, old_name, new_name or "HEAD")
    changed_files = repository.changed_files(old_commit, new_commit)
    folders = find_generated_folders({*repository.list_files(old_commit), *_list_paths(changed_files)})
    changed_files, generated_files = split_generated(changed_files, folders)
    changed = _list_paths(changed_files)
    find_unused = partial(find_build_files, changed=changed)
    with ExitStack() as stack:
        old_files = CommitFiles(repository, old_commit, old_name, must_be_complete=False, find_unused=find_unused)
        stack.callback(old_files.close)
        old = Version(old_name, old_files.root, old_files, repository, is_old=True)
        if new_commit is None or _is_checked_out(repository, new_commit):
            new = Version(new_name, repository.root, None, repository, is_old=False)
        else:
            new_files = CommitFiles(repository, new_commit, new_name, must_be_complete=False, find_unused=find_unused)
            stack.callback(new_files.close)
            new = Version(new_name, new_files.root, new_files, repository, is_old=False)
        stack.pop_all()
        paired_files = _pair_empty_files(old, new, _drop_files_of_submodules(changed_files))
        files = [file for file in paired_files if not _is_blank(old, new, file)]
        files = [_without_empty_version(old, file) for file in files]
        old, new = _enter_skipped_folders(old, files), _enter_skipped_folders(new, files)
        return Versions(old, new, files, generated_files)


def _list_paths(files: list[ChangedFile]) -> set[str]:
    """Return the old and the new paths of files."""
    return {path for file in files for path in (file.old_path, file.new_path) if path is not None}


def _enter_skipped_folders(version: Version, files: list[ChangedFile]) -> Version:
    """Return a version in which changed descriptions are found in spite of files such as ``COLCON_IGNORE``.

    Some repositories have such a file until an installation script deletes it.
    """
    folders = {
        version.file(parent.as_posix())
        for path in _list_paths(files)
        if path.endswith(TARGET_SUFFIXES)
        for parent in PurePosixPath(path).parents
    }
    entered = {folder for folder in folders if any((folder / marker).is_file() for marker in IGNORE_MARKERS)}
    return replace(version, entered=frozenset(entered)) if entered else version


def _pair_empty_files(old: Version, new: Version, files: list[ChangedFile]) -> list[ChangedFile]:
    """Return the files with another pairing of moved empty ones, which git pairs at random.

    Files are paired that have the same name, and the most folders in common at the end of their paths.
    """
    moved = [
        file
        for file in files
        if None not in (file.old_path, file.new_path) and file.old_path != file.new_path and not file.is_submodule
        if _is_empty(old, file.old_path) and _is_empty(new, file.new_path)
    ]
    sides = ((old, "old_path"), (new, "new_path"))
    single = [file for file in files if None in (file.old_path, file.new_path) and not file.is_submodule]
    single = [file for file in single if any(_is_empty(side, getattr(file, name)) for side, name in sides)]
    if not moved:
        return files
    old_paths = [file.old_path for file in (*moved, *single) if file.old_path is not None]
    new_paths = [file.new_path for file in (*moved, *single) if file.new_path is not None]
    pairs = sorted(
        ((path, other) for path in old_paths for other in new_paths if _count_equal_ends(path, other)),
        key=lambda pair: -_count_equal_ends(*pair),
    )
    result = [file for file in files if file not in moved and file not in single]
    for path, other in pairs:
        if path in old_paths and other in new_paths:
            old_paths.remove(path)
            new_paths.remove(other)
            result.append(ChangedFile(path, other))
    result += [ChangedFile(path, None) for path in old_paths]
    result += [ChangedFile(None, path) for path in new_paths]
    return sorted(result, key=lambda file: file.path)


def _count_equal_ends(path: str, other: str) -> int:
    """Return how many names at the end of two paths are equal."""
    pairs = zip(reversed(PurePosixPath(path).parts), reversed(PurePosixPath(other).parts), strict=False)
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pairs))


def _without_empty_version(old: Version, file: ChangedFile) -> ChangedFile:
    """Return a file whose old version is empty as an added file.

    Messages and ``__init__.py`` may be empty, and so may be the files with which tools mark folders.
    """
    path = file.old_path
    if path is None or file.new_path is None or not path.endswith(_FILLED_SUFFIXES) or path.endswith(_INIT_FILE):
        return file
    return replace(file, old_path=None) if _is_empty(old, path) else file


def _is_blank(old: Version, new: Version, file: ChangedFile) -> bool:
    """Return whether a file has only blanks in both versions, so that nothing changed."""
    paths = file.old_path, file.new_path
    return not file.is_submodule and paths[0] == paths[1] and all(map(_is_empty, (old, new), paths))


def _is_empty(version: Version, path: str | None) -> bool:
    """Return whether a version has a file, which has only blanks."""
    file = None if path is None else version.file(path)
    if path is None or file is None or not file.is_file() or file.stat().st_size >= _MAX_EMPTY_BYTES:
        return False
    return not version.text(path).strip()


def _open_repository(folder: Path) -> GitRepository:
    hint = phrase("run the review in the working tree of a repository, or pass `--repository FOLDER`")
    return GitRepository(folder, display_path(folder), hint, downloads_lfs=False)


def _split_range(repository: GitRepository, range_text: str) -> tuple[str, str]:
    """Return the names of the old and the new version.

    The new name is empty for the working tree.
    """
    if not range_text:
        return _find_default_branch(repository), ""
    separator = "..." if "..." in range_text else ".."
    old_name, is_range, new_name = range_text.partition(separator)
    return old_name or "HEAD", (new_name or "HEAD") if is_range else ""


def _find_default_branch(repository: GitRepository) -> str:
    for name in _DEFAULT_BRANCHES:
        if repository.resolve(name) is not None:
            return name
    raise LinkwrightError(
        Diagnostic(
            "REV101",
            phrase("the default branch of {folder} is unknown", folder=display_path(repository.root)),
            hint=phrase("pass the commit to compare with, such as `linkwright review main`"),
        )
    )


def _find_common_commit(repository: GitRepository, old_commit: str, old_name: str, new_name: str) -> str:
    common = repository.merge_base(old_commit, repository.require_commit(new_name))
    if common is None:
        message = phrase("'{old}' and '{new}' have no common commit in this clone", old=old_name, new=new_name)
        hint = phrase(
            "compare the two versions as they are: `linkwright review {old}..{new}`", old=old_name, new=new_name
        )
        if repository.is_shallow:
            hint = SHALLOW_HINT
        raise LinkwrightError(Diagnostic("REV102", message, hint=hint))
    return common


def _is_checked_out(repository: GitRepository, commit: str) -> bool:
    """Return whether the working tree contains exactly the files of a commit.

    Such files need not be written to another folder. A working tree with ignored files, such as a build folder or
    generated meshes, is not used, because a clone does not have them. Neither is one with links to outside, because
    foreign files could appear in the report.
    """
    if repository.resolve("HEAD") != commit or repository.changed_files(commit) or repository.has_ignored_files():
        return False
    root = repository.root
    return not any(leads_outside(root / link, root) for link in repository.list_symbolic_links(commit))


def _drop_files_of_submodules(files: list[ChangedFile]) -> list[ChangedFile]:
    """Return the changed files without those of a folder that becomes a submodule, where they still are."""
    submodules = {file.new_path for file in files if file.is_submodule and file.old_path is None}

    def is_inside(file: ChangedFile) -> bool:
        parents = PurePosixPath(file.old_path or "").parents
        return file.new_path is None and any(parent.as_posix() in submodules for parent in parents)

    return [file for file in files if not is_inside(file)] if submodules else files
