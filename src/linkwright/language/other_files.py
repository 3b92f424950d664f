"""The files beside the descriptions that name links and joints: SRDF, YAML, RViz configurations and launch files.

A package means the robots that it contains and those of the packages that it depends on; a package without any means
all robots of the workspace. A name is followed there if every such robot that has it gets the new name.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from pathlib import Path

from linkwright.diagnostics import LinkwrightError
from linkwright.language.definitions import NameKind
from linkwright.language.includes import real
from linkwright.language.mentions import Mention, mentions_in
from linkwright.language.occurrences import Occurrence, occurrences_in
from linkwright.language.proof import Edit, ExpansionProof
from linkwright.language.workspace import Workspace
from linkwright.packages import enclosing_package
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.xmltree import parse

Names = Mapping[tuple[NameKind, str], str]
_OF_ROBOT = (NameKind.LINK, NameKind.JOINT)
_ENDINGS = (".urdf", ".xacro")


class OtherFiles:
    """The files of a workspace that may mention the names of some descriptions.

    Args:
        project: the workspace.
        texts: the texts of the open files.
        file: a file of the descriptions.
        proof: the expansions of the descriptions.
    """

    def __init__(self, project: Workspace, texts: Mapping[Path, str], file: Path, proof: ExpansionProof) -> None:
        self._project, self._texts, self._file, self._proof = project, texts, file, proof
        self._srdfs_added = False
        self._own = {*project.index.related(file, texts, computed=True)}
        self._names: dict[Path, frozenset[tuple[NameKind, str]]] = {}

    def edits(self, names: Names) -> tuple[set[Edit], tuple[Mention, ...]]:
        """Return the edits of the files that certainly mean some names, and the mentions that are not certain.

        Args:
            names: the names that change, each with its new name.
        """
        found: set[Edit] = set()
        unchanged: list[Mention] = []
        for use in self._literal_uses(names):
            if not use.is_definition:
                found.add(Edit(use.file, use.start, use.end, names[use.kind, use.name]))
        olds = frozenset(old for _, old in names)
        for folder, files in self._files.items():
            foreign: frozenset[tuple[NameKind, str]] | None = None
            for file in files:
                text = self._project.text(file, self._texts) or ""
                mentions = [*_mentions(text, file, names, olds)]
                if not mentions:
                    continue
                if foreign is None:
                    robots = robots_of_package(self._project, self._texts, folder)
                    if robots and not any(self._is_affected(robot) for robot in robots):
                        break  # the package is about other robots
                    others = (robot for robot in robots if not self._is_affected(robot))
                    foreign = frozenset(name for robot in others for name in self._names_of(robot))
                for mention in mentions:
                    kind = next((kind for kind in mention.kinds if (kind, mention.name) in names), None)
                    if kind is None:
                        if not mention.kinds:
                            unchanged.append(mention)
                    elif (kind, mention.name) in foreign or file in self._proof.data:
                        unchanged.append(mention)
                    else:
                        found.add(Edit(file, mention.start, mention.end, names[kind, mention.name]))
        return found, tuple(unchanged)

    def add_srdfs(self) -> None:
        """Compare the SRDF files in xacro of the packages that mean these robots alone, too."""
        if self._srdfs_added:
            return
        self._srdfs_added = True
        roots = {*self._project.index.roots(self._texts)}
        for folder, files in self._files.items():
            srdfs = [file for file in files if file.name.endswith(".srdf.xacro") and file in roots]
            if srdfs and all(map(self._is_affected, robots_of_package(self._project, self._texts, folder))):
                for file in srdfs:
                    self._proof.add(file)

    def _literal_uses(self, names: Names) -> Iterator[Occurrence]:
        """Yield the literal uses in the descriptions, also those that no expansion reaches."""
        for file in self._own:
            for use in occurrences_in(self._project.text(file, self._texts) or "", file):
                if (use.kind, use.name) in names:
                    yield use

    @cached_property
    def _files(self) -> dict[Path, list[Path]]:
        """The files of each package that may mention names, those of the own package first."""
        files: dict[Path, list[Path]] = {}
        seen: set[Path] = set()
        own = enclosing_package(self._file.parent)
        folders = [] if own is None else [real(own[1])]
        for folder in dict.fromkeys((*folders, *map(real, self._project.index.packages))):
            files[folder] = [file for file in self._project.configurations_below(folder) if file not in seen]
            seen.update(files[folder])
        return files

    def _is_affected(self, robot: Path) -> bool:
        return robot in self._proof.entries

    def _names_of(self, robot: Path) -> frozenset[tuple[NameKind, str]]:
        """Return the links and joints of a description; those in its texts if it cannot be expanded."""
        if robot not in self._names:
            model = self._project.robot(robot, self._texts)
            if model is not None:
                names = {(NameKind.LINK, name) for name in model.links} | {
                    (NameKind.JOINT, name) for name in model.joints
                }
            else:
                text = self._project.text(robot, self._texts) or ""
                names = {(use.kind, use.name) for use in occurrences_in(text, robot) if use.is_definition}
            self._names[robot] = frozenset(names)
        return self._names[robot]


def _mentions(text: str, file: Path, names: Names, olds: frozenset[str]) -> Iterable[Mention]:
    if ".srdf" in file.name:
        uses = (use for use in occurrences_in(text, file) if (use.kind, use.name) in names)
        return (Mention(use.name, file, use.start, (use.kind,)) for use in uses)
    return mentions_in(text, file, olds)


def robots_of_package(project: Workspace, texts: Mapping[Path, str], folder: Path) -> list[Path]:
    """Return the descriptions that a package may mean.

    Args:
        project: the workspace.
        texts: the texts of the open files.
        folder: the folder of the package.
    """
    entries = [entry for entry in project.index.roots(texts) if entry.name.endswith(_ENDINGS)]
    entries = [entry for entry in entries if ".srdf" not in entry.name]
    folders = [real(folder), *_dependencies(project, texts, real(folder))]
    inside = [entry for each in folders for entry in entries if entry.is_relative_to(each)]
    return [*dict.fromkeys(inside or entries)]


def _dependencies(project: Workspace, texts: Mapping[Path, str], folder: Path) -> list[Path]:
    """Return the folders of the packages of the workspace that a package depends on, directly or not."""
    manifests = {each: _manifest(project, texts, each) for each in map(real, project.index.packages)}
    by_name = {manifest.name: each for each, manifest in manifests.items() if manifest is not None}
    found: dict[Path, None] = {}
    pending = [folder]
    while pending:
        manifest = manifests.get(pending.pop(0))
        for dependency in manifest.dependencies if manifest is not None else ():
            other = by_name.get(dependency.name)
            if other is not None and other not in found:
                found[other] = None
                pending.append(other)
    return [*found]


def _manifest(project: Workspace, texts: Mapping[Path, str], folder: Path) -> Manifest | None:
    text = project.text(folder / MANIFEST, texts)
    try:
        return None if text is None else Manifest(parse(text, str(folder / MANIFEST)))
    except LinkwrightError:
        return None
