"""The type stubs of the messages that the packages of a workspace define."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from linkwright.files.scratch_folders import ScratchFolder
from linkwright.messages import catalog
from linkwright.messages.definitions.interfaces import KINDS
from linkwright.messages.definitions.library import Library
from linkwright.messages.stub_files import package_stubs
from linkwright.packages import PackageFinder
from linkwright.packages.active import use_finder
from linkwright.packages.interface_files import find_interface_files


class WorkspaceStubs:
    """A temporary folder with type stubs for the interface packages of a workspace.

    Args:
        folders: the folders of the workspace.

    Attributes:
        folder: the temporary folder.
    """

    def __init__(self, folders: Sequence[Path]) -> None:
        self._folders = list(folders)
        self._scratch = ScratchFolder("stubs")
        self.folder = Path(self._scratch.name)
        self._written: dict[str, str] = {}

    def update(self) -> list[Path]:
        """Write the stubs of the current interface files, and return the changed files."""
        stubs = self._generate_stubs()
        changed = [
            self.folder / path for path in {*stubs, *self._written} if stubs.get(path) != self._written.get(path)
        ]
        self._written = stubs
        for file in changed:
            text = stubs.get(file.relative_to(self.folder).as_posix())
            if text is None:
                file.unlink(missing_ok=True)
            else:
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text, encoding="utf-8")
        return sorted(changed)

    def close(self) -> None:
        """Remove the folder."""
        self._scratch.cleanup()

    def _generate_stubs(self) -> dict[str, str]:
        finder, library = PackageFinder(start=self._folders), Library()
        stubs: dict[str, str] = {}
        with use_finder(finder):
            for package, share in finder.packages().items():
                names = [f"{package}/{kind}/{name}" for kind in KINDS for name in find_interface_files(share, kind)]
                if names and package not in catalog.list_packages():
                    stubs |= package_stubs(package, names, library)
        return stubs
