"""The executables of packages.

They are part of Linkwright, installed, or in the sources of a package.
"""

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
    is_misspelled,
    joined,
    phrase,
)
from linkwright.hosting.plans import VIEWER, opens_page
from linkwright.hosting.rqt_programs import PANEL_PROGRAMS, find_replacement
from linkwright.launch.errors.alternatives import find_alternative
from linkwright.launch.errors.exceptions import as_ros_error
from linkwright.launch.errors.unavailable import mark_unavailable
from linkwright.packages import PackageFinder, PackageNotFoundError, install_prefix, is_installed, is_substitute
from linkwright.packages.programs.child_python import python_command

if TYPE_CHECKING:
    from linkwright.packages.readers.installed import EntryPoint

# The readers of sources and scripts are imported only where they are used. A launch of Linkwright's own nodes does
# not need them.

BUILT_IN_TEXT = "built into Linkwright"


class Origin(Enum):
    """The origin of an executable: Linkwright, an installed package, or a package's sources."""

    LINKWRIGHT = "ours"
    INSTALLED = "installed"
    SOURCE = "source"


@dataclass(frozen=True)
class Executable:
    """An executable program of a package.

    Attributes:
        package: the name of the package.
        name: the name of the program in the package.
        origin: the origin of the program.
        path: the path of the program; None for Linkwright's own programs, and for an entry point without a script.
        entry_point: the entry point in sources; None for other programs.
    """

    package: str
    name: str
    origin: Origin
    path: Path | None = None
    entry_point: EntryPoint | None = None

    @property
    def command(self) -> list[str]:
        """The command that runs the program, as a list of arguments."""
        from linkwright.packages.programs.interpreters import needs_our_interpreter, read_interpreter_words

        if opens_page(self.package, self.name):
            return python_command(["-m", "linkwright", "run", self.package, self.name])
        if self.path is None:
            return python_command(["-m", "linkwright.node_program", self.package, self.name])
        if needs_our_interpreter(self.path):
            return python_command([str(self.path)])
        if os.access(self.path, os.X_OK):
            return [str(self.path)]
        interpreter_command = read_interpreter_words(self.path)  # scripts in sources need not be executable
        return [*interpreter_command, str(self.path)] if interpreter_command else python_command([str(self.path)])

    def __str__(self) -> str:
        return BUILT_IN_TEXT if self.origin is Origin.LINKWRIGHT else str(self.path or self.entry_point)


def is_hosted(package: str | None, executable: str) -> bool:
    """Return whether an executable is one of Linkwright's nodes.

    Such a node can run in the launcher's process.
    """
    if opens_page(package, executable):
        return True
    from linkwright.nodes import EXECUTABLES

    return (package, executable) in EXECUTABLES


def hosted_executables() -> list[tuple[str, str]]:
    """Return the package and executable of each node that can run in the launcher's process."""
    from linkwright.nodes import EXECUTABLES

    return [*EXECUTABLES, VIEWER, *PANEL_PROGRAMS]


def builtin_packages() -> set[str]:
    """Return the names of the packages whose executables come with Linkwright."""
    return {package for package, _ in hosted_executables()}


def find_executables(finder: PackageFinder, package: str) -> dict[str, Executable]:
    """Return the programs of a package, by name.

    If several programs have the same name, Linkwright's takes precedence, then the installed one, then the one in
    sources.

    Raises:
        PackageNotFoundError: PKG101, there is no such package.
    """
    own_executables = {
        name: Executable(package, name, Origin.LINKWRIGHT) for owner, name in hosted_executables() if owner == package
    }
    share = finder.find(package) if own_executables else finder.share(package)
    if share is None:
        return own_executables
    executables: dict[str, Executable] = {}
    if not is_installed(share):
        from linkwright.packages.programs.source_programs import find_source_programs

        programs = find_source_programs(share)
        executables = {
            name: Executable(package, name, Origin.SOURCE, entry_point=entry_point)
            for name, entry_point in programs.entry_points.items()
        }
        for name, path in programs.scripts.items():
            executables[name] = Executable(package, name, Origin.SOURCE, path)
    executables.update((executable.name, executable) for executable in _find_installed_executables(package, share))
    return dict(sorted({**executables, **own_executables}.items()))


def find_installed_executable(finder: PackageFinder, package: str, name: str) -> Executable | None:
    """Return an installed program of a package, or None if there is none.

    Unlike `find_executables`, this function does not prefer Linkwright's own programs.
    """
    share = finder.find(package)
    return (
        None
        if share is None
        else next(
            (executable for executable in _find_installed_executables(package, share) if executable.name == name), None
        )
    )


def find_executable(finder: PackageFinder, package: str, name: str) -> Executable:
    """Return a program of a package.

    The program has a path unless it is one of Linkwright's own. A script is created for an entry point in sources.

    Raises:
        LinkwrightError: LAUNCH131, there is no such package or executable. The error is also a LookupError, because
            launch_ros raises one. Errors about third-party programs are marked, see `mark_unavailable`.
    """
    try:
        executables = find_executables(finder, package)
    except PackageNotFoundError as error:
        raise _missing_package_error(finder, package, name, error) from error
    executable = executables.get(name)
    if executable is None:
        raise _missing_executable_error(finder, package, name, executables)
    if executable.entry_point is not None and executable.path is None:
        return replace(executable, path=_create_script(finder, executable))
    return executable


def _find_installed_executables(package: str, share: Path) -> Iterable[Executable]:
    folder = install_prefix(share) / "lib" / package
    for parent, folders, files in os.walk(folder):
        folders[:] = sorted(folder for folder in folders if not folder.startswith(".") and folder != "__pycache__")
        for name in sorted(files):
            path = Path(parent, name)
            if os.access(path, os.X_OK) and path.suffix not in (".so", ".dylib"):
                yield Executable(package, name, Origin.INSTALLED, path)


def _create_script(finder: PackageFinder, executable: Executable) -> Path:
    from linkwright.packages.programs.entry_scripts import make_script
    from linkwright.packages.programs.source_programs import find_python_root

    entry_point = executable.entry_point
    share = finder.share(executable.package)
    root = find_python_root(share, executable.package) or share
    assert entry_point is not None
    _check_module(executable, entry_point, root)
    other_roots = (
        find_python_root(folder, name) for name, folder in finder.packages().items() if not is_installed(folder)
    )
    roots = dict.fromkeys([root, *(candidate for candidate in other_roots if candidate is not None)])
    try:
        return make_script(executable.package, executable.name, entry_point, list(roots))
    except OSError as error:
        message = phrase(
            "cannot create a file for executable '{name}': {strerror}",
            name=executable.name,
            strerror=foreign(error.strerror or error),
        )
        hint = phrase("set XDG_CACHE_HOME to a writable folder")
        raise LinkwrightError(Diagnostic("LAUNCH131", message, hint=hint)) from error


def _check_module(executable: Executable, entry_point: EntryPoint, root: Path) -> None:
    """Raise an error if the module of an entry point does not exist.

    Raises:
        LinkwrightError: LAUNCH131, there is no such module.
    """
    from linkwright.packages.programs.source_programs import find_module_file

    top_package = entry_point.module.partition(".")[0]
    if find_module_file(root, entry_point.module) is not None or not (root / top_package).is_dir():
        return
    folder = root.joinpath(*entry_point.module.split(".")[:-1])
    modules = [path.stem for path in folder.glob("*.py")] if folder.is_dir() else []
    suggestion = did_you_mean(entry_point.module.rpartition(".")[2], modules)
    message = phrase(
        "executable '{name}' of package '{package}' is the entry point '{entry}', but module '{module}' does not exist",
        name=executable.name,
        package=executable.package,
        entry=entry_point,
        module=entry_point.module,
    )
    notes = (Note(phrase("searched for {path}.py", path=display_path(root.joinpath(*entry_point.module.split("."))))),)
    raise LinkwrightError(
        Diagnostic("LAUNCH131", message, notes=notes, hint=suggestion or phrase("check entry_points in setup.py"))
    )


_NO_EXECUTABLES = phrase(
    "check entry_points in setup.py, or install(TARGETS ...) in CMakeLists.txt: the package installs no executables"
)

# --- missing executables ----------------------------------------------------------------------------------------


def _missing_package_error(
    finder: PackageFinder, package: str, name: str, error: PackageNotFoundError
) -> LinkwrightError:
    own_packages, workspace_packages = builtin_packages(), finder.packages()
    instead = find_replacement(package)
    hint = did_you_mean(package, (*own_packages, *workspace_packages)) or error.diagnostics[0].hint
    message = phrase("package '{package}' of node executable '{name}' was not found", package=package, name=name)
    if instead is not None:
        message = phrase("the page has no panel that replaces '{name}'; {instead}", name=name, instead=instead)
        hint = error.diagnostics[0].hint
    alternative = find_alternative(package)
    if alternative is not None:
        message = phrase(
            "package '{package}' of node executable '{name}' was not found; {instead}",
            package=package,
            name=name,
            instead=alternative,
        )
    diagnostic = Diagnostic("LAUNCH131", message, notes=error.diagnostics[0].notes, hint=hint)
    launch_error = as_ros_error(KeyError(message), diagnostic)
    return (
        launch_error
        if instead is None and is_misspelled(package, (*own_packages, *workspace_packages))
        else mark_unavailable(launch_error)
    )


def _missing_executable_error(
    finder: PackageFinder, package: str, name: str, executables: dict[str, Executable]
) -> LinkwrightError:
    share = finder.find(package)
    message = phrase("package '{package}' has no executable '{name}'", package=package, name=name)
    notes: tuple[Note, ...] = ()
    hint = did_you_mean(name, executables)
    runs_without_ros = share is None or is_substitute(share)
    if runs_without_ros:
        message = phrase(
            "package '{package}' has no executable '{name}' that runs without ROS", package=package, name=name
        )
        alternative = find_alternative(package)
        if alternative is not None:
            message = joined((message, alternative), "; ")
    elif share is not None:
        if not is_installed(share):
            return _missing_in_sources_error(package, name, share)
        notes = (
            Note(
                phrase(
                    "searched for {folder}",
                    folder=display_path(install_prefix(share) / "lib" / package / name),
                )
            ),
        )
    if hint is None:
        hint = phrase("the package has {names}", names=joined(executables)) if executables else _NO_EXECUTABLES
    error = _lookup_error(message, notes, hint)
    return mark_unavailable(error) if runs_without_ros and not is_misspelled(name, executables) else error


def _missing_in_sources_error(package: str, name: str, share: Path) -> LinkwrightError:
    from linkwright.packages.programs.source_programs import find_source_programs

    programs = find_source_programs(share)
    if name in programs.compiled:
        message = phrase(
            "executable '{name}' of package '{package}' is a compiled program that was not built",
            name=name,
            package=package,
        )
        build_hint = phrase(
            "build it with 'colcon build --packages-select {package}' and source install/setup.bash;"
            " the build needs a C++ compiler and the ROS 2 libraries that the program uses",
            package=package,
        )
        return mark_unavailable(_lookup_error(message, (), build_hint))
    if not programs.is_complete and not is_misspelled(name, programs.names()):
        return mark_unavailable(_unknown_program_error(package, name, share))
    notes = (Note(phrase("searched the entry points and installed programs of {share}", share=display_path(share))),)
    hint = did_you_mean(name, programs.names())
    if hint is None and programs.names():
        hint = phrase("the package has {names}", names=joined(programs.names()))
    if hint is None:
        hint = phrase("add it to entry_points in setup.py, or to install(PROGRAMS ...) in CMakeLists.txt")
    return _lookup_error(
        phrase("package '{package}' has no executable '{name}'", package=package, name=name), notes, hint
    )


def _unknown_program_error(package: str, name: str, share: Path) -> LinkwrightError:
    """Return the error for a program that the sources of a package do not name.

    The package may build the program nevertheless.
    """
    message = phrase("executable '{name}' of package '{package}' is not available", name=name, package=package)
    note = Note(phrase("the files in {share} do not show which programs the package builds", share=display_path(share)))
    build_hint = phrase(
        "build it with 'colcon build --packages-select {package}' in a workspace with all of its sources",
        package=package,
    )
    return _lookup_error(message, (note,), build_hint)


def _lookup_error(message: Phrase, notes: tuple[Note, ...], hint: Phrase) -> LinkwrightError:
    return as_ros_error(LookupError(message), Diagnostic("LAUNCH131", message, notes=notes, hint=hint))
