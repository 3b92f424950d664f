"""Rename links and joints in SRDF, YAML, RViz configurations and launch files.

A file refers to the robots of its package or, if it has none, of the package's dependencies. A name is renamed there if
it is renamed in all these robots that contain it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import takewhile
from pathlib import Path

from linkwright.diagnostics import LinkwrightError
from linkwright.language.definitions import NameKind
from linkwright.language.includes import real_path
from linkwright.language.mentions import Mention, mentions_in
from linkwright.language.occurrences import Occurrence, occurrences_in
from linkwright.language.proof import Edit, ExpansionProof
from linkwright.language.trials import run_trials
from linkwright.language.workspace import Workspace, hash_texts
from linkwright.packages import enclosing_package
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.xmltree import parse

Names = Mapping[tuple[NameKind, str], str]
_PART_KINDS = (NameKind.LINK, NameKind.JOINT)
_SEARCHED_KINDS = (*_PART_KINDS, NameKind.MATERIAL)
_DESCRIPTION_SUFFIXES = (".urdf", ".xacro")
_ROBOT = re.compile(r"<robot\b[^>]*?\bname\s*=\s*[\"']([^\"']+)[\"']")
_LAUNCH = ("launch.py", ".launch", "launch.xml", "launch.yaml", "launch.yml")


class OtherFiles:
    """The files of a workspace that may mention the names of some descriptions.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        file: a file of the descriptions.
        proof: the expansions of the descriptions.
    """

    def __init__(self, workspace: Workspace, texts: Mapping[Path, str], file: Path, proof: ExpansionProof) -> None:
        self._project, self._texts, self._file, self._proof = workspace, texts, file, proof
        self._srdfs_added = False
        self._robots: dict[Path, list[Path]] = {}
        self._own_files = {*workspace.index.related_files(file, texts, computed=True)}

    def edits(self, names: Names) -> tuple[set[Edit], tuple[Mention, ...]]:
        """Return the edits of certain uses and mentions of names, and the uncertain mentions.

        Args:
            names: the names that change, each with its new name.
        """
        edits: set[Edit] = set()
        unchanged: list[Mention] = []
        for use in self._literal_uses(names):
            if not use.is_definition:
                edits.add(Edit(use.file, use.start, use.end, names[use.kind, use.name]))
        old_names = frozenset(old for _, old in names)
        for files in self._files.values():
            for file in files:
                text = self._project.text(file, self._texts) or ""
                mentions = [*_find_mentions(text, file, names, old_names)]
                robots = self._robots_of(file) if mentions else []
                if robots and not any(map(self._is_affected, robots)):  # The file refers to other robots.
                    unchanged += [mention for mention in mentions if self._depends(file, names, mention)]
                    continue
                others = [robot for robot in robots if not self._is_affected(robot)]
                for mention in mentions:
                    kind = next((kind for kind in mention.kinds if (kind, mention.name) in names), None)
                    if kind is None:
                        if not mention.kinds:
                            unchanged.append(mention)
                    elif (file in self._proof.data and ".srdf" not in file.name) or any(
                        (kind, mention.name) in find_names_of_robot(self._project, self._texts, robot)
                        for robot in others
                    ):
                        unchanged.append(mention)
                    else:
                        edits.add(Edit(file, mention.start, mention.end, names[kind, mention.name]))
        return edits, tuple(unchanged)

    def add_srdfs(self) -> None:
        """Add the SRDF xacro files of packages that refer only to these robots to the proof."""
        if self._srdfs_added:
            return
        self._srdfs_added = True
        roots = {*self._project.index.roots(self._texts)}
        for files in self._files.values():
            srdfs = [file for file in files if file.name.endswith(".srdf.xacro") and file in roots]
            for file in srdfs:
                if all(map(self._is_affected, self._robots_of(file))):
                    self._proof.add(file)

    def _literal_uses(self, names: Names) -> Iterator[Occurrence]:
        """Yield the literal uses in the descriptions, including uses outside all expansions."""
        for use in self._uses:
            if (use.kind, use.name) in names:
                yield use

    @cached_property
    def _uses(self) -> list[Occurrence]:
        texts = ((file, self._project.text(file, self._texts) or "") for file in self._own_files)
        return [use for file, text in texts for use in occurrences_in(text, file) if use.kind in _SEARCHED_KINDS]

    @cached_property
    def _files(self) -> dict[Path, list[Path]]:
        """The files of each package that may mention names, the file's own package first."""
        files: dict[Path, list[Path]] = {}
        seen_files: set[Path] = set()
        own_package = enclosing_package(self._file.parent)
        folders = [] if own_package is None else [real_path(own_package[1])]
        for folder in dict.fromkeys((*folders, *map(real_path, self._project.index.packages))):
            files[folder] = [file for file in self._project.configurations_below(folder) if file not in seen_files]
            seen_files.update(files[folder])
        return files

    def _depends(self, file: Path, names: Names, mention: Mention) -> bool:
        """Return whether the package of a mention depends on the package of the description.

        In that case, its files may also mean the renamed robots.
        """
        package, own_package = enclosing_package(file.parent), enclosing_package(self._file.parent)
        if package is None or own_package is None or not any((kind, mention.name) in names for kind in mention.kinds):
            return False
        return real_path(own_package[1]) in _find_dependencies(self._project, self._texts, real_path(package[1]))

    def _robots_of(self, file: Path) -> list[Path]:
        if file not in self._robots:
            self._robots[file] = find_robots_of_file(self._project, self._texts, file)
        return self._robots[file]

    def _is_affected(self, robot: Path) -> bool:
        return robot in self._proof.entries


def _find_mentions(text: str, file: Path, names: Names, old_names: frozenset[str]) -> Iterable[Mention]:
    if ".srdf" in file.name:
        uses = (use for use in occurrences_in(text, file) if (use.kind, use.name) in names)
        return (Mention(use.name, file, use.start, (use.kind,)) for use in uses)
    return mentions_in(text, file, old_names)


def find_robots_of_file(workspace: Workspace, texts: Mapping[Path, str], file: Path) -> list[Path]:
    """Return the descriptions that a configuration or launch file may refer to.

    These are the robots of its package, or else the robots with parts in the package, or else the robots of the
    package's dependencies, or else all. Several robots are reduced to those that some file mentions together with this
    file, or else to the robots in the nearest folders.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        file: a configuration or launch file.
    """
    package = enclosing_package(file.parent)
    folder = file.parent if package is None else real_path(package[1])
    robots = _find_robots_of_package(workspace, texts, folder)
    if len(robots) < 2:
        return [*robots]
    return _find_robots_named_together(workspace, texts, file, [*robots]) or _find_nearest(file, folder, robots)


def _find_robots_of_package(workspace: Workspace, texts: Mapping[Path, str], folder: Path) -> dict[Path, list[Path]]:
    """Return the descriptions that a package may refer to, with their files in the package."""
    entries = [entry for entry in workspace.index.roots(texts) if entry.name.endswith(_DESCRIPTION_SUFFIXES)]
    entries = [entry for entry in entries if ".srdf" not in entry.name and not entry.name.startswith(".")]
    own_entries = {entry: [entry] for entry in entries if entry.is_relative_to(folder)}
    if own_entries:
        return own_entries
    for entry in entries:
        parts = [file for file in workspace.index.related_files(entry, texts) if file.is_relative_to(folder)]
        if parts:
            own_entries[entry] = parts
    if own_entries:
        return own_entries
    dependencies = _find_dependencies(workspace, texts, folder)
    entries_in_dependencies = [entry for other in dependencies for entry in entries if entry.is_relative_to(other)]
    return {entry: [] for entry in entries_in_dependencies or entries}


def _find_robots_named_together(
    workspace: Workspace, texts: Mapping[Path, str], file: Path, robots: Sequence[Path]
) -> list[Path]:
    """Return the robots that mention a file, or are mentioned beside it in a launch file."""
    name = re.compile(rf"(?<![\w.-]){re.escape(file.name)}(?![\w-])")
    text = workspace.text(file, texts) or ""
    if ".srdf" in file.name:
        title = _ROBOT.search(text)
        titles = {robot: _ROBOT.search(workspace.text(robot, texts) or "") for robot in robots}
        same = [robot for robot, other in titles.items() if title is not None and other and other[1] == title[1]]
        if same:
            return same
    mentioned_robots = {robot for robot in robots if _is_named_in(robot, text)}
    for robot in robots:
        if any(
            name.search(workspace.text(related_file, texts) or "")
            for related_file in workspace.index.related_files(robot, texts)
        ):
            mentioned_robots.add(robot)
    for launch in workspace.files(_LAUNCH):
        launch_text = workspace.text(launch, texts) or ""
        if launch != file and name.search(launch_text):
            mentioned_robots |= {robot for robot in robots if _is_named_in(robot, launch_text)}
    return [robot for robot in robots if robot in mentioned_robots]


def _is_named_in(robot: Path, text: str) -> bool:
    return re.search(rf"(?<![\w.-]){re.escape(robot.name)}(?![\w-])", text) is not None


def _find_nearest(file: Path, folder: Path, robots: Mapping[Path, Sequence[Path]]) -> list[Path]:
    """Return the robots with files that share most folders of their package with a file."""

    def shared(robot_file: Path) -> int:
        names, others = (path.relative_to(folder).parts[:-1] for path in (file, robot_file))
        return len([*takewhile(lambda pair: pair[0] == pair[1], zip(names, others, strict=False))])

    depths = {robot: max(map(shared, parts), default=0) for robot, parts in robots.items()}
    return [robot for robot, depth in depths.items() if depth == max(depths.values())]


def find_names_of_robot(
    workspace: Workspace, texts: Mapping[Path, str], robot: Path
) -> frozenset[tuple[NameKind, str]]:
    """Return the links and joints of a description for all argument sets that can be expanded.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        robot: the description.
    """
    text_hashes = hash_texts(texts)
    cached = workspace.cached_results.get(("names", robot))
    if cached is None or cached[0] != text_hashes:
        expansions, _ = run_trials(workspace, texts, robot, is_partial=True, is_switched=False)
        roots = [trial.expansion.document.root for trial in expansions]
        names = frozenset(
            (kind, element.attributes.get("name", ""))
            for root in roots
            for kind in _PART_KINDS
            for element in root.elements(kind.value)
        )
        cached = workspace.cached_results["names", robot] = (text_hashes, names)
    assert isinstance(cached[1], frozenset)
    return cached[1]


def _find_dependencies(workspace: Workspace, texts: Mapping[Path, str], folder: Path) -> list[Path]:
    """Return the folders of a package's direct and indirect dependencies in the workspace."""
    manifests = {
        package_folder: _read_manifest(workspace, texts, package_folder)
        for package_folder in map(real_path, workspace.index.packages)
    }
    by_name = {
        manifest.name: manifest_folder for manifest_folder, manifest in manifests.items() if manifest is not None
    }
    folders: dict[Path, None] = {}
    pending = [folder]
    while pending:
        manifest = manifests.get(pending.pop(0))
        for dependency in manifest.dependencies if manifest is not None else ():
            other = by_name.get(dependency.name)
            if other is not None and other not in folders:
                folders[other] = None
                pending.append(other)
    return [*folders]


def _read_manifest(workspace: Workspace, texts: Mapping[Path, str], folder: Path) -> Manifest | None:
    text = workspace.text(folder / MANIFEST, texts)
    try:
        return None if text is None else Manifest(parse(text, str(folder / MANIFEST)))
    except LinkwrightError:
        return None
