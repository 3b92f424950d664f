"""The installers of a pack: a script for each system, and the Python program they start."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from linkwright.files.whole_files import write_whole_file
from linkwright.learning.packing.pack_folder import PackFolder, PackSettings
from linkwright.learning.packing.targets import SYSTEMS

_TEMPLATE_FOLDER = Path(__file__).with_name("installer")
_TEMPLATES_BY_FILE = {
    "install.py": "install.py",
    "install.sh": "install.sh",
    "install.command": "install.sh",
    "install.bat": "install.bat",
    "no-python.txt": "no-python.txt",
    "README.txt": "README.txt",
}
"""The files of a pack -> their templates. macOS opens files named ``.command`` in a terminal."""
_EXECUTABLE_FILES = {"install.sh", "install.command"}
_FILES_WITH_WINDOWS_LINE_ENDS = {"install.bat", "no-python.txt", "README.txt"}
"""The files with the line ends of Windows, whose command interpreter and old editors need them."""


def write_installers(folder: PackFolder, settings: PackSettings) -> None:
    """Write the installers of a pack.

    Raises:
        OSError: a file cannot be written.
    """
    pythons = sort_pythons(settings.missing, settings.pythons)
    replacements = {
        "@PYTHONS@": " ".join(pythons),
        "@DIGITS@": " ".join(version.replace(".", "") for version in pythons),
        "@VERSION@": settings.version,
        "@SYSTEMS@": ", ".join(SYSTEMS[system].label for system in settings.systems),
    }
    for name, template in _TEMPLATES_BY_FILE.items():
        text = (_TEMPLATE_FOLDER / template).read_text(encoding="utf-8")
        for placeholder, value in replacements.items():
            text = text.replace(placeholder, value)
        if name in _FILES_WITH_WINDOWS_LINE_ENDS:
            text = text.replace("\n", "\r\n")
        write_whole_file(folder.path / name, text)
        if name in _EXECUTABLE_FILES:
            with suppress(OSError):  # memory sticks often have no permissions
                (folder.path / name).chmod(0o755)


def sort_pythons(missing: Mapping[str, Mapping[str, Sequence[str]]], pythons: Sequence[str]) -> list[str]:
    """Return the Python versions, those with the fewest missing parts first, then the newest."""

    def rank(python: str) -> tuple[int, int]:
        parts = [len(texts["en"]) for target, texts in missing.items() if target.endswith(f"-py{python}")]
        return sum(parts), -int(python.partition(".")[2])

    return sorted(pythons, key=rank)
