"""Find files of the repository that read files which a package no longer installs, or does not install."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, SourceText, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.lint.rules.package_install import USUAL_FOLDERS
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.files.build.facts import list_names
from linkwright.review.installed_paths import read_package_facts
from linkwright.review.renames.packages import find_renamed_packages
from linkwright.review.users.installed_readers import READER_SUFFIXES, NamedPath, find_named_paths
from linkwright.review.users.references import LAUNCH_SUFFIXES
from linkwright.review.versions import TEST_FOLDERS, Version, Versions
from linkwright.xacro.cache import read_document

_HEADERS = "include/"
_DESCRIPTION_SUFFIXES = (".urdf", ".xacro")


@dataclass
class _LostInstall:
    """The files that a package no longer installs.

    Attributes:
        name: the name of the package.
        folder: the folder of the package in the new version.
        is_ros1: whether the package is also found in its source folder.
        shared: whether the new version has the source, by the path below the share folder.
        headers: whether the new version has the source, by the path below ``include``.
        remaining_folders: the folders below the share folder that still have files.
    """

    name: str
    folder: str
    is_ros1: bool
    shared: dict[str, bool] = field(default_factory=dict)
    headers: dict[str, bool] = field(default_factory=dict)
    remaining_folders: set[str] = field(default_factory=set)

    def find(self, path: str, *, is_complete: bool) -> bool | None:
        """Return whether the new version has the source of a lost file or folder; None if nothing is lost.

        Args:
            path: the path below the share folder.
            is_complete: whether the path is known to its end.
        """
        if is_complete and path in self.shared:
            return self.shared[path]
        if not path or path in self.remaining_folders:
            return None
        sources = [has_source for file, has_source in self.shared.items() if file.startswith(f"{path}/")]
        return any(sources) if sources else None


def find_lost_installs(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the files that still read files which are no longer installed, each with a change.

    Tests are left out, because a build may install files only for them. So are a launch file that names a removed file,
    and a file of the same package that does: `find_lost_references` and `find_lost_data` find them.
    """
    lost = {package.name: package for package in _find_lost_packages(versions, changed_files)}
    if not lost:
        return
    words = _list_words(lost.values())
    for path in versions.new.paths(READER_SUFFIXES):
        text = versions.new.text(path)
        if not TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts) or not any(word in text for word in words):
            continue
        source = SourceText(str(versions.new.file(path)), text)
        yield from ((path, change) for change in _compare_reader(versions, path, source, lost))


def find_uninstalled_paths(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the descriptions that newly name files of a folder which its package of ROS 2 does not install.

    Findings report folders with usual names, such as ``meshes``.
    """
    for file in changed_files:
        if file.old_path is None or file.new_path is None or not file.new_path.endswith(_DESCRIPTION_SUFFIXES):
            continue
        old, new = (
            {
                (item.package, item.path): item
                for item in find_named_paths(SourceText(str(version.file(path)), version.text(path)), path)
            }
            for version, path in ((versions.old, file.old_path), (versions.new, file.new_path))
        )
        named: dict[str, dict[str, NamedPath]] = {}
        for (package, path), item in new.items():
            if (package, path) not in old and item.is_complete and _is_uninstalled(versions.new, file.new_path, item):
                named.setdefault(package, {})[path] = item
        for package, paths in named.items():
            text = phrase("names files that '{package}' does not install: {names}", package=package, names=_list(paths))
            yield file.new_path, _make_change(file.new_path, text, phrase("it does not find the files"), paths)


def _is_uninstalled(version: Version, path: str, item: NamedPath) -> bool:
    """Return whether a file of a package of ROS 2 is in a folder from which the package installs nothing."""
    share = version.share_of(item.package, version.file(path).parent)
    folder = None if share is None else version.relative(share)
    top = item.path.partition("/")[0]
    if share is None or folder is None or top in USUAL_FOLDERS or not (share / item.path).is_file():
        return False
    folder = "" if folder == "." else folder
    facts = read_package_facts(version, folder)
    if facts is None or not facts.is_complete or Manifest(read_document(str(share / MANIFEST))).is_ros1:
        return False
    installed = {source.partition("/")[0] for target, source in facts.files.items() if target.startswith("share/")}
    return top not in installed and any((share / name).is_dir() for name in installed)


def _list_words(lost: Iterable[_LostInstall]) -> set[str]:
    """Return words of which each file that reads a lost file contains one."""
    words: set[str] = set()
    for package in lost:
        words |= {PurePosixPath(path).name for path in package.headers}
        words |= {package.name} if package.shared else set()
    return words


def _find_lost_packages(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[_LostInstall]:
    """Yield the packages that install fewer files than before."""
    renamed = {package.old_folder for package in find_renamed_packages(versions)}
    folders = {versions.old.package_of(file.old_path) for file in changed_files if file.old_path}
    for folder in sorted(folder for folder in folders if folder is not None and folder not in renamed):
        old, new = read_package_facts(versions.old, folder), read_package_facts(versions.new, folder)
        manifest = versions.new.file(folder) / MANIFEST
        if old is None or new is None or not old.project or not new.unknown <= old.unknown or not manifest.is_file():
            continue
        package = _LostInstall(old.project, folder, Manifest(read_document(str(manifest))).is_ros1)
        share = f"share/{old.project}/"
        for target, file in old.files.items():
            if target in new.files:
                continue
            has_source = versions.new.file((PurePosixPath(folder) / file).as_posix()).is_file()
            if target.startswith(share):
                package.shared[target.removeprefix(share)] = has_source
            elif target.startswith(_HEADERS):
                path = target.removeprefix(_HEADERS)
                package.headers |= {path: has_source, path.removeprefix(f"{old.project}/"): has_source}
        for target in new.files:
            if target.startswith(share):
                parents = PurePosixPath(target.removeprefix(share)).parents
                package.remaining_folders |= {parent.as_posix() for parent in parents}
        if package.shared or package.headers:
            yield package


def _compare_reader(
    versions: Versions, path: str, source: SourceText, lost: Mapping[str, _LostInstall]
) -> Iterator[Change]:
    """Yield the changes about the lost files and headers that a file names."""
    own_package = versions.new.package_of(path)
    found: dict[str, dict[str, NamedPath]] = {}
    headers: dict[str, dict[str, NamedPath]] = {}
    for named_path in find_named_paths(source, path):
        if not named_path.package:
            owner = _find_lost_header(versions, own_package, named_path.path, lost.values())
            if owner is not None:
                headers.setdefault(owner.name, {}).setdefault(named_path.path, named_path)
            continue
        package = lost.get(named_path.package)
        if package is None:
            continue
        has_source = package.find(named_path.path, is_complete=named_path.is_complete)
        if has_source or (has_source is not None and not _is_found_elsewhere(path, own_package, package)):
            found.setdefault(package.name, {}).setdefault(named_path.path, named_path)
    for name, named_paths in found.items():
        yield _make_reader_change(path, lost[name], _drop_parents(named_paths))
    for name, named_paths in headers.items():
        text = phrase(
            "includes headers of '{package}' that are no longer installed: {names}",
            package=name,
            names=_list(named_paths),
        )
        yield _make_change(path, text, phrase("the code does not build"), named_paths)


def _is_found_elsewhere(path: str, own_package: str | None, package: _LostInstall) -> bool:
    """Return whether another step reports that a file names a removed file of a package."""
    return path.endswith(LAUNCH_SUFFIXES) or own_package == package.folder


def _find_lost_header(
    versions: Versions, own_package: str | None, path: str, lost: Iterable[_LostInstall]
) -> _LostInstall | None:
    """Return the package whose lost header a file includes; None for other headers.

    A header that the package of the file also has is not lost, and neither is one of its own package.
    """
    for package in lost:
        if path not in package.headers or own_package is None or own_package == package.folder:
            continue
        own_folder = versions.new.file(own_package)
        if not any((own_folder / folder / path).is_file() for folder in ("include", "src", "")):
            return package
    return None


def _drop_parents(named_paths: Mapping[str, NamedPath]) -> dict[str, NamedPath]:
    """Return the paths without the folders that contain others of them."""
    return {
        path: named_path
        for path, named_path in named_paths.items()
        if not any(other.startswith(f"{path}/") for other in named_paths)
    }


def _make_reader_change(path: str, package: _LostInstall, named_paths: Mapping[str, NamedPath]) -> Change:
    text = phrase(
        "names files of '{package}' that are no longer installed: {names}",
        package=package.name,
        names=_list(named_paths),
    )
    reason = phrase("it does not find the files")
    if package.is_ros1 and all(package.find(item, is_complete=True) for item in named_paths):
        reason = phrase("it does not find the files in an installed workspace")
    return _make_change(path, text, reason, named_paths)


def _list(named_paths: Iterable[str]) -> Phrase:
    return list_names(list(named_paths))


def _make_change(path: str, text: Phrase, reason: Phrase, named_paths: Mapping[str, NamedPath]) -> Change:
    span = next(iter(named_paths.values())).span
    return Change(text, Effect.BREAKING, reason, Location(path, span.line, span.column))
