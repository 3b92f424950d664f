"""Executables of packages: Linkwright's own, installed ones, and those in sources."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Note,
    Phrase,
    did_you_mean,
    display_path,
    foreign,
    is_misspelt,
    joined,
    phrase,
)
from linkwright.hosting.plans import VIEWER, is_viewer
from linkwright.launch.errors.exceptions import as_ros_error
from linkwright.launch.errors.unavailable import mark_unavailable
from linkwright.packages import PackageFinder, PackageNotFoundError, install_prefix, is_installed, is_substitute
from linkwright.packages.programs.child_python import python_command

if TYPE_CHECKING:
    from linkwright.packages.readers.entry_points import EntryPoint

# The readers of sources and scripts are imported where they are used, because a launch of Linkwright's own nodes does
# not
# need them.

BUILT_IN = "built into Linkwright"


class Origin(Enum):
    """The origin of an executable."""

    OURS = "ours"
    INSTALLED = "installed"
    SOURCE = "source"


@dataclass(frozen=True)
class Executable:
    """A program of a package.

    Attributes:
        package: the name of the package.
        name: the name of the program in the package.
        origin: the origin of the program.
        path: the path of the program; None for one of Linkwright's own, and for an entry point that has no script yet.
        entry_point: the function of an entry point in sources.
    """

    package: str
    name: str
    origin: Origin
    path: Path | None = None
    entry_point: EntryPoint | None = None

    @property
    def command(self) -> list[str]:
        """The command that runs the program, as a list of arguments."""
        from linkwright.packages.programs.interpreters import interpreter_words, needs_our_interpreter

        if self.path is None:
            return python_command(["-m", "linkwright.node_program", self.package, self.name])
        if needs_our_interpreter(self.path):
            return python_command([str(self.path)])
        if os.access(self.path, os.X_OK):
            return [str(self.path)]
        words = interpreter_words(self.path)  # scripts in sources need not be executable
        return [*words, str(self.path)] if words else python_command([str(self.path)])

    def __str__(self) -> str:
        return BUILT_IN if self.origin is Origin.OURS else str(self.path or self.entry_point)


def is_hosted(package: str | None, executable: str) -> bool:
    """Return whether an executable is one of Linkwright's nodes, which can run in this process."""
    if is_viewer(package, executable):
        return True
    from linkwright.nodes import EXECUTABLES

    return (package, executable) in EXECUTABLES


def hosted_executables() -> list[tuple[str, str]]:
    """Return the package and executable of every node that can run in this process."""
    from linkwright.nodes import EXECUTABLES

    return [*EXECUTABLES, VIEWER]


def builtin_packages() -> set[str]:
    """Return the names of the packages whose executables come with Linkwright."""
    return {package for package, _ in hosted_executables()}


def executables_of(finder: PackageFinder, package: str) -> dict[str, Executable]:
    """Return the programs of a package by name.

    Of programs with the same name, Linkwright's own takes precedence, then the built one, then the one in sources.

    Raises:
        PackageNotFoundError: PKG101, there is no such package.
    """
    ours = {name: Executable(package, name, Origin.OURS) for owner, name in hosted_executables() if owner == package}
    share = finder.find(package) if ours else finder.share(package)
    if share is None:
        return ours
    found: dict[str, Executable] = {}
    if not is_installed(share):
        from linkwright.packages.programs.source_programs import source_programs

        programs = source_programs(share)
        found = {
            name: Executable(package, name, Origin.SOURCE, entry_point=entry)
            for name, entry in programs.entry_points.items()
        }
        for name, path in programs.scripts.items():
            found[name] = Executable(package, name, Origin.SOURCE, path)
    found.update((executable.name, executable) for executable in _installed(package, share))
    return dict(sorted({**found, **ours}.items()))


def find_installed_executable(finder: PackageFinder, package: str, name: str) -> Executable | None:
    """Return a built program of a package, or None if there is none.

    Unlike in `executables_of`, Linkwright's own programs do not take precedence.
    """
    share = finder.find(package)
    return (
        None
        if share is None
        else next((executable for executable in _installed(package, share) if executable.name == name), None)
    )


def find_executable(finder: PackageFinder, package: str, name: str) -> Executable:
    """Return a program of a package.

    The program has a path, unless it is one of Linkwright's own.

    Raises:
        LinkwrightError: LAUNCH131, with the searched paths and similar names. The error is also a LookupError, because
            launch_ros raises PackageNotFoundError (PKG101). Errors about third-party programs are marked, see
            `mark_unavailable`.
    """
    try:
        present = executables_of(finder, package)
    except PackageNotFoundError as error:
        raise _missing_package_error(finder, package, name, error) from error
    found = present.get(name)
    if found is None:
        raise _missing_executable_error(finder, package, name, present)
    if found.entry_point is not None and found.path is None:
        return replace(found, path=_script(finder, found))
    return found


def _installed(package: str, share: Path) -> Iterable[Executable]:
    folder = install_prefix(share) / "lib" / package
    for base, folders, files in os.walk(folder):
        folders[:] = sorted(folder for folder in folders if not folder.startswith(".") and folder != "__pycache__")
        for name in sorted(files):
            path = Path(base, name)
            if os.access(path, os.X_OK) and path.suffix not in (".so", ".dylib"):
                yield Executable(package, name, Origin.INSTALLED, path)


def _script(finder: PackageFinder, executable: Executable) -> Path:
    from linkwright.packages.programs.entry_scripts import script_for
    from linkwright.packages.programs.source_programs import python_root

    entry = executable.entry_point
    share = finder.share(executable.package)
    root = python_root(share, executable.package) or share
    assert entry is not None
    _check_module(executable, entry, root)
    others = (python_root(folder, name) for name, folder in finder.packages().items() if not is_installed(folder))
    roots = dict.fromkeys([root, *(other for other in others if other is not None)])
    try:
        return script_for(executable.package, executable.name, entry, list(roots))
    except OSError as error:
        message = phrase(
            "cannot create a file for executable '{name}': {strerror}",
            name=executable.name,
            strerror=foreign(error.strerror or error),
        )
        hint = phrase("set XDG_CACHE_HOME to a writable folder")
        raise LinkwrightError(Diagnostic("LAUNCH131", message, hint=hint)) from error


def _check_module(executable: Executable, entry: EntryPoint, root: Path) -> None:
    """Check that the module of an entry point exists, before a process is started.

    Raises:
        LinkwrightError: LAUNCH131, there is no such module.
    """
    from linkwright.packages.programs.source_programs import module_file

    top = entry.module.partition(".")[0]
    if module_file(root, entry.module) is not None or not (root / top).is_dir():
        return
    folder = root.joinpath(*entry.module.split(".")[:-1])
    modules = [path.stem for path in folder.glob("*.py")] if folder.is_dir() else []
    near = did_you_mean(entry.module.rpartition(".")[2], modules)
    message = phrase(
        "executable '{name}' of package '{package}' is the entry point '{entry}', and there is no module '{module}'",
        name=executable.name,
        package=executable.package,
        entry=entry,
        module=entry.module,
    )
    notes = (
        Note(phrase("searched for {joinpath}.py", joinpath=display_path(root.joinpath(*entry.module.split("."))))),
    )
    raise LinkwrightError(
        Diagnostic("LAUNCH131", message, notes=notes, hint=near or phrase("check entry_points in setup.py"))
    )


_NO_EXECUTABLES = phrase(
    "it installs no executables: check entry_points in its setup.py, or install(TARGETS ...) in CMakeLists.txt"
)

# --- missing executables ----------------------------------------------------------------------------------------


def _missing_package_error(
    finder: PackageFinder, package: str, name: str, error: PackageNotFoundError
) -> LinkwrightError:
    ours, theirs = builtin_packages(), finder.packages()
    hint = did_you_mean(package, (*ours, *theirs)) or error.diagnostics[0].hint
    message = phrase("package '{package}' of node executable '{name}' not found", package=package, name=name)
    diagnostic = Diagnostic("LAUNCH131", message, notes=error.diagnostics[0].notes, hint=hint)
    missing = as_ros_error(KeyError(message), diagnostic)
    return missing if is_misspelt(package, (*ours, *theirs)) else mark_unavailable(missing)


def _missing_executable_error(
    finder: PackageFinder, package: str, name: str, present: dict[str, Executable]
) -> LinkwrightError:
    share = finder.find(package)
    message = phrase("package '{package}' has no executable '{name}'", package=package, name=name)
    notes: tuple[Note, ...] = ()
    hint = did_you_mean(name, present)
    is_ours = share is None or is_substitute(share)
    if is_ours:
        message = phrase(
            "package '{package}' has no executable '{name}' that runs without ROS", package=package, name=name
        )
    elif share is not None:
        if not is_installed(share):
            return _missing_in_sources_error(package, name, share)
        notes = (
            Note(
                phrase(
                    "searched for {install_prefix}",
                    install_prefix=display_path(install_prefix(share) / "lib" / package / name),
                )
            ),
        )
    if hint is None:
        hint = phrase("the package has {present}", present=joined(present)) if present else _NO_EXECUTABLES
    error = _lookup_error(message, notes, hint)
    return mark_unavailable(error) if is_ours and not is_misspelt(name, present) else error


def _missing_in_sources_error(package: str, name: str, share: Path) -> LinkwrightError:
    from linkwright.packages.programs.source_programs import source_programs

    programs = source_programs(share)
    if name in programs.compiled:
        message = phrase(
            "executable '{name}' of package '{package}' is a compiled program that was not built",
            name=name,
            package=package,
        )
        advice = phrase(
            "build it with 'colcon build --packages-select {package}' and source install/setup.bash;"
            " that needs a C++ compiler and the ROS 2 libraries it uses",
            package=package,
        )
        return mark_unavailable(_lookup_error(message, (), advice))
    if not programs.is_complete and not is_misspelt(name, programs.names()):
        return mark_unavailable(_unknown_program_error(package, name, share))
    notes = (Note(phrase("searched the entry points and installed programs of {share}", share=display_path(share))),)
    hint = did_you_mean(name, programs.names())
    if hint is None and programs.names():
        hint = phrase("the package has {names}", names=joined(programs.names()))
    if hint is None:
        hint = phrase("name it in entry_points of setup.py, or in install(PROGRAMS ...) of CMakeLists.txt")
    return _lookup_error(
        phrase("package '{package}' has no executable '{name}'", package=package, name=name), notes, hint
    )


def _unknown_program_error(package: str, name: str, share: Path) -> LinkwrightError:
    """Return the error for a program that a package's sources do not show but may build."""
    message = phrase("executable '{name}' of package '{package}' is not available", name=name, package=package)
    note = Note(phrase("the files in {share} do not show which programs it builds", share=display_path(share)))
    advice = phrase(
        "build it with 'colcon build --packages-select {package}' in a workspace with all of its sources",
        package=package,
    )
    return _lookup_error(message, (note,), advice)


def _lookup_error(message: Phrase, notes: tuple[Note, ...], hint: Phrase) -> LinkwrightError:
    return as_ros_error(LookupError(message), Diagnostic("LAUNCH131", message, notes=notes, hint=hint))
