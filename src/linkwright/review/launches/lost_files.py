"""Find nodes that no longer get a parameter file which has their parameters."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.parameters.names import find_node_name
from linkwright.review.files.parameters.yaml_values import read_yaml_values
from linkwright.review.launches.conditional_settings import SettingPair
from linkwright.review.launches.matching import compute_name_similarity
from linkwright.review.launches.outlines import PARAMETER, Entry, LaunchOutline, without_condition
from linkwright.review.launches.programs.default_names import find_default_name, find_package_folders
from linkwright.review.sources.names import CPP_SUFFIXES, PYTHON_SUFFIX
from linkwright.review.texts.list_changes import nested_list_items
from linkwright.review.versions import Version

_FILES = "parameters"
_FILE = re.compile(r"\$\(find(?:-pkg-share)? (?P<package>[\w.-]+)\)/(?P<path>[\w./-]+\.ya?ml)")
_SECTION = "ros__parameters."
_ALL_NODES = "**"
_SUFFIXES = (".yaml", ".yml")
_MIN_SIMILARITY_OF_FILES = 0.85
_MIN_SHARE_OF_NAMES = 0.5
"""The least similarity of the names of a removed and an added file, and the share of common parameters."""


class LostFiles:
    """Finds the parameter files that nodes of a launch file no longer get.

    Args:
        old: the outline of the old file, with the old version of the repository.
        new: the outline of the new file, with the new version.
        changed_files: the changed files of the review.
    """

    def __init__(
        self,
        old: tuple[LaunchOutline, Version],
        new: tuple[LaunchOutline, Version],
        changed_files: Sequence[ChangedFile] = (),
    ) -> None:
        self._changed_files = changed_files
        self._old_outline, self._old = old
        self._new_outline, self._new = new

    def find_reason(self, entry: Entry, pairs: Sequence[SettingPair]) -> Phrase | None:
        """Return the reason why a node that loses a file starts without its parameters, or None.

        Parameters that another file of the node has, or that the launch file sets itself, are not lost.

        Args:
            entry: the new action.
            pairs: its changed settings.
        """
        changed = next((pair for pair in pairs if pair.name == _FILES and pair.old), None)
        node = self._find_node(entry)
        if changed is None or entry.kind != "node" or node is None:
            return None
        old_files, new_files = (
            {_get_path(text): text for text in map(outline.resolve, nested_list_items(files) if files else ())}
            for outline, files in ((self._old_outline, changed.old), (self._new_outline, changed.new))
        )
        kept = {name for file in new_files for name in self._read_names(self._new, file, node) or ()}
        kept |= {_normalize(without_condition(name)) for name in entry.settings if name.startswith(PARAMETER)}
        is_unknown = any(self._read_names(self._new, file, node) is None for file in new_files)
        for file in (file for file in old_files if file not in new_files):
            names = self._read_names(self._old, file, node) or set()
            if not names or names & kept or not self._may_read(entry.name, names):
                continue
            if (
                self._is_loaded_otherwise(file)
                or self._is_renamed(file, new_files, node)
                or (is_unknown and self._has_other_section(file, node))
            ):
                continue
            return phrase("the node starts without the parameters in '{file}'", file=PurePosixPath(file).name)
        return None

    def _is_renamed(self, file: str, new_files: Iterable[str], node: str) -> bool:
        """Return whether a node gets a file under its new name, also one that took the place of a removed file.

        Such a file has a similar name and at least half of the parameters, maybe in another section.
        """
        path = self._find_path(self._old, file)
        renamed = {(changed.old_path, changed.new_path) for changed in self._changed_files}
        for other in new_files:
            new_path = self._find_path(self._new, other)
            if path is None or new_path is None:
                continue
            if (path, new_path) in renamed:
                return True
            if (path, None) in renamed and (None, new_path) in renamed and _have_similar_paths(path, new_path):
                old, new = (
                    {name.rpartition(".")[2] for name in self._read_names(version, text, node) or ()}
                    for version, text in ((self._old, file), (self._new, other))
                )
                if len(old & new) >= _MIN_SHARE_OF_NAMES * len(old):
                    return True
        return False

    def _find_path(self, version: Version, file: str) -> str | None:
        """Return the path of a parameter file relative to the root, or None if it is unknown."""
        match = _FILE.match(file)
        share = None if match is None else version.share_of(match["package"], version.root)
        return None if match is None or share is None else version.relative(share / match["path"])

    def _may_read(self, program: str, names: Iterable[str]) -> bool:
        """Return whether a program may read parameters. One of the repository has the name of at least one of them."""
        folder = find_package_folders(self._new.root).get(program.partition("/")[0])
        path = None if folder is None else self._new.relative(folder)
        if path is None:
            return True
        words = {name.rpartition(".")[2] for name in names}
        texts = (self._new.text(source) for source in self._new.paths((*CPP_SUFFIXES, PYTHON_SUFFIX), path))
        return any(word in text for text in texts for word in words)

    def _is_loaded_otherwise(self, file: str) -> bool:
        """Return whether a file of ROS 1 newly loads a file for several nodes."""
        others = [entry.name for entry in self._new_outline.entries if entry.kind == "parameters"]
        return any(_get_path(self._new_outline.resolve(name)) == file for name in others)

    def _find_node(self, entry: Entry) -> str | None:
        """Return the name of a node, or None if it is unknown."""
        name = entry.settings.get("name")
        if name is None:
            return find_default_name(self._new.root, entry.name)
        name = self._new_outline.resolve(name)
        return None if "$(" in name else name.rpartition("/")[2]

    def _read_names(self, version: Version, file: str, node: str) -> set[str] | None:
        """Return the parameters that a file has for a node, or None if the file is unknown."""
        match = _FILE.match(file)
        share = None if match is None else version.share_of(match["package"], version.root)
        if match is None or share is None or ".." in match["path"] or not (share / match["path"]).is_file():
            return None
        path = version.relative(share / match["path"])
        return None if path is None else _read_names(version, path, node, is_ros1=self._old_outline.is_ros1)

    def _has_other_section(self, file: str, node: str) -> bool:
        """Return whether another parameter file of the repository may have the parameters of a node."""
        name = PurePosixPath(file).name
        section = re.compile(rf"^[ \t]*[\"']?[\w/]*\b{re.escape(node)}[\"']?[ \t]*:", re.MULTILINE)
        paths: Iterable[str] = self._new.paths(_SUFFIXES)
        others = [path for path in paths if PurePosixPath(path).name != name]
        return self._old_outline.is_ros1 or any(section.search(self._new.text(path)) for path in others)


def _read_names(version: Version, path: str, node: str, *, is_ros1: bool) -> set[str] | None:
    """Return the parameters that a file has for a node, or None if it cannot be read."""
    try:
        values = read_yaml_values(version.text(path))
    except UnreadableFileError:
        return None
    if is_ros1:
        return set(values)
    sections = {name: find_node_name(name) for name in values}
    nodes = (node, _ALL_NODES)
    return {
        name.rpartition(_SECTION)[2]
        for name, section in sections.items()
        if section is not None and section.strip("/").rpartition("/")[2].rpartition(".")[2] in nodes
    }


def _get_path(file: str) -> str:
    """Return the path of a file without its conditions and options."""
    match = _FILE.match(file)
    return file if match is None else match[0]


def _have_similar_paths(old: str, new: str) -> bool:
    """Return whether two files of a folder have similar names."""
    paths = PurePosixPath(old), PurePosixPath(new)
    similarity = compute_name_similarity(paths[0].stem, paths[1].stem)
    return paths[0].parent == paths[1].parent and similarity >= _MIN_SIMILARITY_OF_FILES


def _normalize(setting: str) -> str:
    return setting.removeprefix(PARAMETER).lstrip("~/").replace("/", ".")
