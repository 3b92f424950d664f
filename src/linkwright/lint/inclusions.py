"""The includes in unexpanded descriptions, and the files that they may resolve to."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.packages.manifest import package_name

_INCLUDE = lazy_pattern(r"""<xacro:include\b[^>]*?\bfilename\s*=\s*["']([^"']+)["']""")
_ARGUMENT = lazy_pattern(r"<xacro:arg\b[^>]*>")
_ATTRIBUTE = lazy_pattern(r"""\b(name|default)\s*=\s*["']([^"']+)["']""")
_ARGUMENT_USE = lazy_pattern(r"\$\(arg\s+(\S+?)\s*\)")
_OPTIONAL_VARIABLE = lazy_pattern(r"\$\(optenv\s+\S+\s+([^)]*)\)")
_PATH_IN_PACKAGE = lazy_pattern(r"\$\(find\s+([\w-]+)\s*\)[/\\]*(.*)")
_PACKAGE_SUBSTITUTION = lazy_pattern(r"\$\(find\s+((?:[^()]|\([^()]*\))*)\)[/\\]*")
_EXPRESSION = lazy_pattern(r"\$\{[^{}]*\}|\$\([^()]*\)")
_MIN_LITERAL_CHARACTERS = len("_.xacro")
"""The minimum number of literal characters of a computed path. A shorter one could mean any file."""


@dataclass(frozen=True, slots=True)
class Inclusion:
    """An include of another file.

    Attributes:
        package: the package in a ``$(find ...)`` in front of the path; empty if there is none.
        path: the path in the package, or relative to the file with the include; it can contain expressions.
        pattern: a regular expression for the ends of the possible paths if the path is computed, even if only from an
            argument with a default; empty for other paths.
    """

    package: str
    path: str
    pattern: str = ""

    @property
    def name(self) -> str:
        """The name of the included file, without folders."""
        return Path(self.path).name

    def may_lead(self, includer: Path, file: Path, packages: Mapping[str, Sequence[Path]]) -> bool:
        """Return whether this include can refer to a file.

        If its path cannot be resolved, any file with the included name is possible. If it names a
        package, files of other packages are excluded.

        Args:
            includer: the absolute path of the file with the include.
            file: the absolute path of the other file.
            packages: the absolute folders of the known packages, by name.
        """
        if file.name != self.name:
            return False
        if self.package:
            folders = packages.get(self.package)
            if folders is None:
                return not any(
                    file.is_relative_to(folder) for package_folders in packages.values() for folder in package_folders
                )
            exact = [folder / self.path for folder in folders]
            return file in exact or (
                any(map(file.is_relative_to, folders)) and not any(path.is_file() for path in exact)
            )
        if "$" in self.path:
            return True
        relative = Path(os.path.normpath(includer.parent / self.path))
        return file == relative or not relative.is_file()

    def find_files(self, includer: Path, packages: Mapping[str, Sequence[Path]]) -> list[Path]:
        """Return the existing files to which this include refers; none if its path is computed.

        Args:
            includer: the absolute path of the file with the include.
            packages: the absolute folders of the known packages, by name.
        """
        folders = packages.get(self.package, ()) if self.package else (includer.parent,)
        return [folder / self.path for folder in folders if "$" not in self.path and (folder / self.path).is_file()]

    def may_compute(self, file: Path) -> bool:
        """Return whether the path is computed, and some values of its expressions lead to a file."""
        return bool(self.pattern) and re.search(f"(?:^|/){self.pattern}$", str(file)) is not None


def inclusions_in(text: str) -> Iterator[Inclusion]:
    """Yield the includes in the text of a description.

    Arguments and `$(optenv ...)` are replaced by their default values.
    """
    arguments = [dict(_ATTRIBUTE.findall(tag)) for tag in _ARGUMENT.findall(text)]
    defaults = {argument["name"]: argument.get("default", "") for argument in arguments if "name" in argument}
    for filename in _INCLUDE.findall(text):
        resolved = _ARGUMENT_USE.sub(lambda match: defaults.get(match[1], ""), filename)
        resolved = _OPTIONAL_VARIABLE.sub(r"\1", resolved).strip()
        in_package = _PATH_IN_PACKAGE.fullmatch(resolved)
        package, path = in_package.groups() if in_package else ("", resolved)
        yield Inclusion(package, path, _make_pattern(filename.strip()))


def _make_pattern(filename: str) -> str:
    """Return the pattern of an include from its path as written; see `Inclusion.pattern`."""
    package = _PACKAGE_SUBSTITUTION.match(filename)
    literals = _EXPRESSION.split(filename[package.end() :] if package else filename)
    is_computed = len(literals) > 1 or (package is not None and "$" in package[1])
    return (
        "[^/]*".join(map(re.escape, literals))
        if is_computed and len("".join(literals)) >= _MIN_LITERAL_CHARACTERS
        else ""
    )


def folders_by_package(folders: Iterable[Path]) -> dict[str, list[Path]]:
    """Return the folders of packages by package name."""
    folders_by_name: dict[str, list[Path]] = {}
    for folder in folders:
        name = package_name(folder)
        if name is not None:
            folders_by_name.setdefault(name, []).append(folder)
    return folders_by_name
