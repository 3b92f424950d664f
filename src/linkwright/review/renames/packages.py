"""Find packages with a new name or folder, and remove the changes that only follow from it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import SequenceMatcher
from itertools import chain
from pathlib import PurePosixPath
from typing import NamedTuple

from linkwright.diagnostics import Phrase, counted, joined, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.manifest import MANIFEST, package_name
from linkwright.review.changes import Change, Effect, Subject, SubjectKind
from linkwright.review.texts.merging import name_edit
from linkwright.review.versions import Version, Versions

_NAMED_AFTER_PACKAGES = (SubjectKind.BUILD, SubjectKind.MANIFEST, SubjectKind.PLUGINS)
"""The kinds of files in which names that contain the package name are derived from it."""
_REFERENCE = (
    r"(?P<before>\$\(find(?:-pkg-share|-pkg-prefix)? |(?:package|model)://|\b(?:share|lib)/|\bnode '|"
    r"\b(?:get_package_\w+|FindPackageShare)\((?:package=)?['\"])(?P<name>{names})(?![\w.-])|"
    r"\b(?P<scope>{names})(?=::)"
)
"""The forms in which launch files and descriptions name a package."""
_NAME = re.compile(r"[\w:./~-]+")
_RENAMED_TEMPLATE = "package '{old}' renamed to '{new}'"


@dataclass(frozen=True)
class RenamedPackage:
    """A package with a new name or in a new folder.

    Attributes:
        old_name: the old name.
        new_name: the new name.
        old_folder: the old folder relative to the root; empty for the root.
        new_folder: the new folder.
    """

    old_name: str
    new_name: str
    old_folder: str
    new_folder: str

    def new_path(self, old_path: str) -> str | None:
        """Return the new path of a file that moves with the package; None for other files."""
        path = PurePosixPath(old_path)
        if self.old_folder == self.new_folder or not path.is_relative_to(self.old_folder):
            return None
        return (PurePosixPath(self.new_folder) / path.relative_to(self.old_folder)).as_posix()

    def derive_path(self, old_path: str, names: PackageNames) -> str | None:
        """Return the new path of a file whose path in the package contains its name; None for other files."""
        path = PurePosixPath(old_path)
        if not path.is_relative_to(self.old_folder):
            return None
        inner = path.relative_to(self.old_folder).as_posix()
        derived = names.rename_derived(inner)
        return None if derived == inner else (PurePosixPath(self.new_folder) / derived).as_posix()


def find_renamed_packages(versions: Versions) -> list[RenamedPackage]:
    """Return the packages with a new name or folder.

    Git must recognize their manifests, or at least half of their other files, as renamed or changed, or the name of
    the package must be the same.
    """
    packages = []
    for old_path, new_path in _pair_manifests(versions):
        old_folder, new_folder = (PurePosixPath(path).parent for path in (old_path, new_path))
        old_name, new_name = _read_name(versions.old, old_path), _read_name(versions.new, new_path)
        if old_name and new_name and (old_name != new_name or old_folder != new_folder):
            folders = (folder.as_posix().removeprefix(".") for folder in (old_folder, new_folder))
            packages.append(RenamedPackage(old_name, new_name, *folders))
    return packages


def _pair_manifests(versions: Versions) -> list[tuple[str, str]]:
    """Return the old and new paths of changed manifests.

    A removed and an added manifest are a pair if no other changed manifest has the name of their package, or if other
    files moved from one package to the other. Those with new names are then paired by these, because similar packages
    may differ in little else.
    """
    removed: dict[str | None, list[str]] = {}
    added: dict[str | None, list[str]] = {}
    pairs: list[tuple[str, str]] = []
    for file in versions.changed_files:
        if PurePosixPath(file.path).name != MANIFEST:
            continue
        if file.old_path and file.new_path:
            pairs.append((file.old_path, file.new_path))
        elif file.old_path:
            removed.setdefault(_read_name(versions.old, file.old_path), []).append(file.old_path)
        elif file.new_path:
            added.setdefault(_read_name(versions.new, file.new_path), []).append(file.new_path)
    unique = [name for name in removed if name and len(removed[name]) == len(added.get(name, ())) == 1]
    pairs += [(removed.pop(name)[0], added.pop(name)[0]) for name in unique]
    old_paths, new_paths = (list(chain.from_iterable(paths.values())) for paths in (removed, added))
    pairs += _pair_by_moved_files(versions.changed_files, old_paths, new_paths)
    return _pair_by_names(versions, pairs)


def _pair_by_names(versions: Versions, pairs: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return pairs of manifests, with those of packages with new names paired by the most similar names.

    Manifests with equally similar names are paired as given.
    """
    names = {old: _read_name(versions.old, old) or "" for old, _ in pairs}
    new_names = {new: _read_name(versions.new, new) or "" for _, new in pairs}
    moved = [pair for pair in pairs if names[pair[0]] != new_names[pair[1]]]
    ratios = {
        (old, new): SequenceMatcher(None, names[old], new_names[new], autojunk=False).ratio()
        for old, _ in moved
        for _, new in moved
    }
    paired = {old: new for old, new in pairs if (old, new) not in moved}
    for old, new in sorted(ratios, key=lambda pair: (-ratios[pair], pair not in moved)):
        if old not in paired and new not in paired.values():
            paired[old] = new
    return list(paired.items())


def _pair_by_moved_files(
    files: Sequence[ChangedFile], removed: Sequence[str], added: Sequence[str]
) -> Iterator[tuple[str, str]]:
    """Yield the removed and added manifests of packages whose other files mostly moved from one to the other.

    Git does not pair short manifests.
    """
    remaining = list(added)
    for old_path in removed:
        old_folder = PurePosixPath(old_path).parent
        moved_to: Counter[str] = Counter()
        total = 0
        for file in files:
            if (
                file.old_path is None
                or file.old_path == old_path
                or old_folder not in PurePosixPath(file.old_path).parents
            ):
                continue
            total += 1
            new_parents = () if file.new_path is None else PurePosixPath(file.new_path).parents
            moved_to.update(path for path in remaining if PurePosixPath(path).parent in new_parents)
        new_path, count = max(moved_to.items(), key=lambda item: item[1], default=("", 0))
        if count and 2 * count >= total:
            remaining.remove(new_path)
            yield old_path, new_path


def _read_name(version: Version, path: str) -> str | None:
    """Return the name of a package, from the path of its manifest."""
    return package_name(version.file(path).parent)


def match_moved_files(versions: Versions) -> Versions:
    """Return versions that match the old and new files of moved packages by their paths in the package.

    Git does not recognize all of these files as moved, and pairs equal files of different packages.
    """
    packages = find_renamed_packages(versions)
    names = PackageNames(packages)
    moved = [file for file in versions.changed_files if file.old_path != file.new_path]
    free = {file.new_path for file in moved if file.new_path is not None}
    pairs: dict[str, str] = {}
    for old_path in (file.old_path for file in moved if file.old_path is not None):
        paths = (
            path for package in packages for path in (package.new_path(old_path), package.derive_path(old_path, names))
        )
        new_path = next((path for path in paths if path in free), None)
        if new_path is not None:
            pairs[old_path] = new_path
            free.remove(new_path)
    taken = set(pairs.values())
    files: list[ChangedFile] = []
    for file in versions.changed_files:
        if file.old_path == file.new_path:
            files.append(file)
            continue
        moved_to = None if file.old_path is None else pairs.get(file.old_path)
        if moved_to is not None:
            files.append(replace(file, new_path=moved_to))
        rest = replace(
            file,
            old_path=file.old_path if moved_to is None else None,
            new_path=None if file.new_path in taken else file.new_path,
        )
        if rest.path:
            files.append(rest)
    return replace(versions, changed_files=files)


class PackageNames:
    """The names of renamed packages in texts of the old version.

    Args:
        packages: the renamed packages.
    """

    def __init__(self, packages: Sequence[RenamedPackage]) -> None:
        self._names = {
            package.old_name: package.new_name for package in packages if package.old_name != package.new_name
        }
        names = "|".join(re.escape(name) for name in sorted(self._names, key=len, reverse=True)) or "(?!)"
        self._derived = re.compile(rf"(?<![A-Za-z0-9])(?:{names})(?![A-Za-z0-9])")
        self._edits = {name_edit(old, new) for old, new in self._names.items()}
        self._references = re.compile(_REFERENCE.replace("{names}", names))

    def translate_package(self, name: str) -> str:
        """Return the new name of a package."""
        return self._names.get(name, name)

    def rename_derived(self, text: str) -> str:
        """Return a text with new names in place of names derived from the old package names."""
        return self._derived.sub(lambda match: self._names[match[0]], text)

    def has_same_edit(self, old: str, new: str) -> bool:
        """Return whether two names differ by the same edit as the old and new names of a package."""
        return name_edit(old, new) in self._edits

    def rename_references(self, text: str) -> str:
        """Return a text with the new package name in paths, URIs and C++ scopes that begin with it."""
        return self._references.sub(
            lambda match: (match["before"] or "") + self._names[match["name"] or match["scope"]], text
        )


@dataclass(frozen=True)
class _Consequences:
    """The changes that only follow from new names and folders of packages.

    Attributes:
        packages: the renamed packages.
        names: the names of the packages.
        classes: the new names of classes in plugin descriptions, by old name.
    """

    packages: Sequence[RenamedPackage]
    names: PackageNames
    classes: dict[str, str]

    def contain(self, change: Change, subject: Subject) -> bool:
        """Return whether a change to a file only follows from a new name or folder."""
        arguments = _find_innermost_sentence(change.sentence).arguments
        if change.sentence.template == _RENAMED_TEMPLATE:
            return False
        old_path = subject.old_path
        if old_path is not None and arguments.get("path") == old_path:
            return any(package.new_path(old_path) == subject.new_path for package in self.packages)
        for before, after in (("old", "new"), ("removed", "added")):
            if before in arguments and after in arguments:
                old, new = str(arguments[before]), str(arguments[after])
                return old != new and self._rename(old, subject.kind) == new
        return False

    def _rename(self, text: str, kind: SubjectKind) -> str:
        if text in self.classes:
            return self.classes[text]
        return self.names.rename_derived(text) if kind in _NAMED_AFTER_PACKAGES else self.names.rename_references(text)


class _DerivedName(NamedTuple):
    """A name that changes with that of a package: its kind in reports, if it is known, and both names."""

    kind: object
    old: str
    new: str


def remove_consequences(versions: Versions, subjects: Sequence[Subject]) -> tuple[list[Subject], list[Phrase]]:
    """Return the subjects without changes that only follow from renamed packages, and notes.

    The change to the manifest lists the names of libraries, classes and other things that changed with the package.
    """
    packages = find_renamed_packages(versions)
    if not packages:
        return list(subjects), []
    names = PackageNames(packages)
    renamed_classes = {
        str(change.sentence.arguments["old"]): str(change.sentence.arguments["new"])
        for subject in subjects
        if subject.kind is SubjectKind.PLUGINS
        for change in subject.changes
        if change.sentence.arguments.keys() == {"old", "new"}
    }
    classes = {old: new for old, new in renamed_classes.items() if names.rename_derived(old) == new}
    consequences = _Consequences(packages, names, classes)
    manifests = {f"{package.new_folder}/{MANIFEST}".lstrip("/"): package for package in packages}
    count = 0
    derived: list[_DerivedName] = []
    result = []
    for subject in subjects:
        remaining = [change for change in subject.changes if not consequences.contain(change, subject)]
        if subject.path in manifests and subject.kind is SubjectKind.MANIFEST:
            remaining = _add_folder_change(manifests[subject.path], remaining)
        count += len(subject.changes) - len(remaining)
        remaining_ids = {id(change) for change in remaining}
        derived += [
            _DerivedName(_find_kind(subject, arguments), str(arguments["old"]), str(arguments["new"]))
            for change in subject.changes
            if id(change) not in remaining_ids and change.effect is Effect.BREAKING
            if "old" in (arguments := change.core.arguments)
        ]
        result.append(replace(subject, changes=remaining))
    if not count:
        return result, []
    note = counted(
        "one change follows from the new name or folder of a package alone and is not listed",
        "{count} changes follow from new names or folders of packages alone and are not listed",
        count,
    )
    return [_add_derived_names(subject, manifests, derived) for subject in result], [note]


def _find_innermost_sentence(sentence: Phrase) -> Phrase:
    while isinstance(change := sentence.arguments.get("change"), Phrase):
        sentence = change
    return sentence


def _add_folder_change(package: RenamedPackage, changes: Sequence[Change]) -> list[Change]:
    """Return the changes to a manifest, with the old folder of a package that keeps its name."""
    if package.old_name != package.new_name or package.old_folder == package.new_folder:
        return list(changes)
    values = {"name": package.new_name, "folder": f"{package.old_folder or '.'}/"}
    text = phrase("package '{name}' moved from {folder}", **values)
    if not package.new_folder:
        text = phrase("package '{name}' moved from {folder} to the root of the repository", **values)
    return [Change(text), *changes]


def _add_derived_names(
    subject: Subject, manifests: dict[str, RenamedPackage], derived: Sequence[_DerivedName]
) -> Subject:
    """Return a subject whose change of the package name lists the derived names with their kinds."""
    package = manifests.get(subject.path)
    if package is None or package.old_name == package.new_name:
        return subject
    package_names = PackageNames([package])
    own = [name for name in derived if package_names.rename_derived(name.old) == name.new]
    own = [name for name in own if _NAME.fullmatch(name.old.strip("'"))]  # no lists of types or long values
    kinds = dict.fromkeys(name.kind for name in own)
    ordered = sorted(kinds, key=lambda kind: kind is not None)
    groups = [_format_derived(kind, [name for name in own if name.kind == kind]) for kind in ordered]
    changes = [
        replace(change, sentence=phrase("{change}; also {names}", change=change.sentence, names=joined(groups)))
        if groups and change.sentence.template == _RENAMED_TEMPLATE
        else change
        for change in subject.changes
    ]
    return replace(subject, changes=changes)


def _find_kind(subject: Subject, arguments: Mapping[str, object]) -> object:
    """Return the kind of a renamed thing as reports name it, or None if it is unknown."""
    return phrase("plugin classes") if subject.kind is SubjectKind.PLUGINS else arguments.get("kind")


def _format_derived(kind: object, names: Sequence[_DerivedName]) -> Phrase:
    """Return the new names of things of a kind, such as executables; without the kind if it is unknown."""
    pairs = ((name.old.strip("'"), name.new.strip("'")) for name in names)
    texts = joined(dict.fromkeys(f"'{old}' -> '{new}'" for old, new in pairs))
    return phrase("{kind} {names}", kind=kind, names=texts) if kind is not None else texts


def find_moved_files(versions: Versions, files: Sequence[ChangedFile]) -> Iterator[tuple[str, str]]:
    """Yield the new paths of files that move with their package, with its old folder."""
    packages = find_renamed_packages(versions)
    names = PackageNames(packages)
    for file in files:
        for package in packages if file.old_path and file.new_path else ():
            path = package.new_path(file.old_path or "")
            if path is not None and file.new_path in (path, package.derive_path(file.old_path or "", names)):
                yield file.path, package.old_folder
