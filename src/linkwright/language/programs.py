"""The packages, executables and components that a launch file can use.

They are found without executing any code.
"""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from linkwright.language.format import Target
from linkwright.launch.ros.executables import builtin_packages, hosted_executables
from linkwright.lint.targets import find_files_and_packages
from linkwright.nodes import COMPONENTS
from linkwright.packages import PackageFinder, enclosing_package, install_prefix, is_installed
from linkwright.packages.programs.source_programs import find_module_file, find_python_root, find_source_programs
from linkwright.packages.readers.entry_points import read_text
from linkwright.packages.readers.installed import EntryPoint
from linkwright.packages.share_layout import find_source, find_substituted_executables

_PACKAGE_USE = re.compile(
    r"""\$\(find(?:-pkg-share|-pkg-prefix)?\s+([a-z]\w+)\)|package://([a-z]\w+)/|\bpkg\s*[=:]\s*["']?([a-z]\w+)"""
    r"""|\bpackage\s*=\s*["']([a-z]\w+)["']"""
    r"""|(?:get_package_share_\w+|FindPackageShare)\(\s*["']([a-z]\w+)["']"""
)
_FILES_WITH_PACKAGES = (
    ".launch.py",
    "_launch.py",
    ".launch.xml",
    ".launch.yaml",
    ".xacro",
    ".urdf",
    ".sdf",
    ".world",
    ".rviz",
)
_MAX_FILES = 200
_MAX_BYTES = 300_000
_COMPONENT_REGISTRATION = re.compile(r"(?i)\brclcpp_components_register_nodes?\s*\(([^)]*)\)")
_CLASS = re.compile(r"\b[A-Za-z_]\w*(?:::\w+)+")
DEPENDENCY = re.compile(r"<(?:exec_|run_)?depend\b[^<>]*>\s*([a-z]\w*)\s*<")
"""The dependency tags of ``package.xml`` that name packages needed at run time."""
BUILD_DEPENDENCY = re.compile(r"<(?:build_|buildtool_)?depend\b[^<>]*>\s*([a-z]\w*)\s*<")
"""The dependency tags of ``package.xml`` that name packages needed at build time."""


@dataclass(frozen=True, slots=True)
class Program:
    """An executable of a package.

    Attributes:
        name: its name.
        origin: the entry point or file that it comes from, or ``Linkwright``.
        target: the location of its source or script, or None if there is none.
    """

    name: str
    origin: str
    target: Target | None = None


def find_used_packages(folder: Path) -> list[str]:
    """Return the packages that the files of a package use, the most used first."""
    files, _ = find_files_and_packages(folder, _FILES_WITH_PACKAGES)
    use_counts: Counter[str] = Counter()
    for file in files[:_MAX_FILES]:
        try:
            text = file.read_text(encoding="utf-8", errors="replace") if file.stat().st_size < _MAX_BYTES else ""
        except OSError:
            continue
        use_counts.update({name for use in _PACKAGE_USE.finditer(text) for name in use.groups() if name})
    return [name for name, _ in use_counts.most_common()]


def package_names(finder: PackageFinder, file: Path) -> list[str]:
    """Return all package names: the file's own first, then its dependencies, then the others."""
    own_package = enclosing_package(file.parent)
    first = (
        [] if own_package is None else [own_package[0], *DEPENDENCY.findall(read_text(own_package[1] / "package.xml"))]
    )
    known_packages = {*finder.packages(), *replaced_packages()}
    return [*dict.fromkeys(first), *sorted(known_packages - {*first})]


def replaced_packages() -> set[str]:
    """Return the packages that nodes or modules of Linkwright replace, installed or not."""
    return {*builtin_packages(), *find_substituted_executables()}


def find_programs(finder: PackageFinder, package: str) -> dict[str, Program]:
    """Return the executables of a package by name, or an empty dictionary if there are none."""
    programs: dict[str, Program] = {}
    share = finder.find(package)
    if share is not None and share.is_dir():
        if not is_installed(share):
            programs = {program.name: program for program in _programs_in_sources(share, package)}
        for path in sorted((install_prefix(share) / "lib" / package).glob("*")):
            if path.is_file() and path.suffix not in (".so", ".dylib") and os.access(path, os.X_OK):
                programs[path.name] = Program(path.name, str(path), Target(path))
    hosted_names = {name for owner, name in hosted_executables() if owner == package}
    for name in sorted(hosted_names | find_substituted_executables().get(package, frozenset())):
        programs.setdefault(name, Program(name, "Linkwright"))
    return programs


def _programs_in_sources(share: Path, package: str) -> Iterator[Program]:
    programs = find_source_programs(share, runs_setup=False)
    root = find_python_root(share, package) or share
    for name, entry in programs.entry_points.items():
        yield Program(name, f"{entry.module}:{entry.function}", _find_entry_target(root, entry))
    for name, path in programs.scripts.items():
        yield Program(name, str(path.relative_to(share)), Target(Path(find_source(str(path)))))
    build = Path(find_source(str(share / "CMakeLists.txt")))
    text = read_text(build) if programs.compiled else ""
    for name in sorted(programs.compiled):
        match = re.search(rf"(?i)(?:add_executable\s*\(\s*|EXECUTABLE\s+)({re.escape(name)})\b", text)
        yield Program(name, "CMakeLists.txt", Target(build, *(match.span(1) if match else (0, 0))))


def _find_entry_target(root: Path, entry: EntryPoint) -> Target | None:
    file = find_module_file(root, entry.module)
    if file is None:
        return None
    file = Path(find_source(str(file)))
    match = re.search(rf"^(?:async )?def ({re.escape(entry.function)})\b", read_text(file), re.MULTILINE)
    return Target(file, *(match.span(1) if match else (0, 0)))


def find_components(finder: PackageFinder, package: str) -> dict[str, Target | None]:
    """Return the components of a package by class, with the location of the registration."""
    components: dict[str, Target | None] = {}
    share = finder.find(package)
    if share is not None:
        build = Path(find_source(str(share / "CMakeLists.txt")))
        for command in _COMPONENT_REGISTRATION.finditer(read_text(build)):
            for name in _CLASS.finditer(command[1]):
                start = command.start(1) + name.start()
                components[name[0]] = Target(build, start, start + len(name[0]))
        index = install_prefix(share) / "share/ament_index/resource_index/rclcpp_components" / package
        for line in read_text(index).splitlines():
            components.setdefault(line.partition(";")[0].strip(), None)
    components.update((name, None) for owner, name in COMPONENTS if owner == package and name not in components)
    components.pop("", None)
    return components
