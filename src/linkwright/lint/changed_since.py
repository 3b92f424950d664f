"""The changes of the working tree since a commit, and the findings of this commit."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from linkwright.descriptions.revisions import CommitFiles
from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, phrase
from linkwright.files.git_repository import GitRepository
from linkwright.lint.affected import TextFiles
from linkwright.lint.known_findings import Key, count_keys
from linkwright.lint.targets import Targets, find_targets

Check = Callable[[Targets, Sequence[Path]], Sequence[Diagnostic]]
"""A function that returns the findings about targets, which were found in some paths."""


class WorkingTreeChanges:
    """The changes of the working tree since a commit.

    Args:
        paths: the files and folders to check.
        name: the commit in git's notation.
        with_packages: whether to also check the packages of files.

    Attributes:
        root: the root folder of the working tree.

    Raises:
        LinkwrightError: CLI341 to CLI346, git cannot find or read the commit.
    """

    def __init__(self, paths: Sequence[Path], name: str, *, with_packages: bool) -> None:
        folder = paths[0] if paths[0].is_dir() else paths[0].parent
        self._repository = GitRepository(folder, display_path(paths[0]), _HINT, downloads_lfs=False)
        self.root = self._repository.root
        self._commit = self._repository.require_commit(name)
        self._name = name
        self._paths = paths
        self._with_packages = with_packages
        self._changed_files = self._repository.changed_files(self._commit)
        self._new_names = {file.old_path: file.new_path for file in self._changed_files if file.old_path}

    def targets(self) -> Targets:
        """Return the descriptions that changed files can affect, and the packages with such files."""
        changed = (file.new_path for file in self._changed_files)
        return self._affected_paths(self.root, self._paths, filter(None, changed))

    def known_findings(self, check: Check) -> dict[Key, int]:
        """Return how many findings the commit has under each key.

        The keys contain the new names of the files.
        """
        files = CommitFiles(self._repository, self._commit, self._name, must_be_complete=False)
        try:
            paths = [path for path in map(files.root.joinpath, self._old_names()) if path.exists()]
            targets = self._affected_paths(files.root, paths, filter(None, self._new_names))
            if not targets.files and not targets.packages:
                return {}
            return count_keys(check(targets, paths), files.root, self._new_names)
        finally:
            files.close()

    def _old_names(self) -> list[str]:
        """Return the paths relative to the root, with their names in the commit.

        Raises:
            LinkwrightError: CLI342, a path is outside the repository.
        """
        old_names = {new: old for old, new in self._new_names.items() if new}
        names = []
        for path in self._paths:
            real_path = Path(os.path.realpath(path))
            if not real_path.is_relative_to(self.root):
                message = phrase("'{path}' is not in the git repository of the other paths", path=display_path(path))
                raise LinkwrightError(Diagnostic("CLI342", message, hint=_HINT))
            name = real_path.relative_to(self.root).as_posix()
            names.append(old_names.get(name) or name)
        return names

    def _affected_paths(self, root: Path, paths: Sequence[Path], changed: Iterable[str]) -> Targets:
        targets = find_targets(paths, with_packages=self._with_packages)
        changed_names = set(changed)
        names = {_to_relative(file, root): file for file in targets.files}
        affected = TextFiles(root).affected(changed_names, names.keys())
        folders = [_to_relative(folder, root) for folder in targets.packages]
        changed_folders = {
            folder for folder in folders if any(Path(name).is_relative_to(folder) for name in changed_names | affected)
        }
        return Targets(
            tuple(file for name, file in names.items() if name in affected),
            tuple(folder for folder in targets.packages if _to_relative(folder, root) in changed_folders),
            targets.named_files,
            targets.named_parts,
        )


_HINT = phrase("leave out `--changed`; outside a repository, `--baseline` hides known findings")


def _to_relative(path: Path, root: Path) -> str:
    return Path(os.path.relpath(os.path.realpath(path), root)).as_posix()
