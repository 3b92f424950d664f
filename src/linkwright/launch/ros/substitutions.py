"""Substitutions that ask where packages are, and for parameters of the scope."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import LinkwrightError, did_you_mean
from linkwright.launch.context import LaunchContext
from linkwright.launch.frontend.expose import expose_substitution
from linkwright.launch.places import error_at, located
from linkwright.launch.ros.executables import find_executable
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    SubstitutionFailure,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from linkwright.launch.substitutions import PathJoinSubstitution
from linkwright.workspace import current_finder, install_prefix

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

Parsed = tuple[type[Substitution], dict[str, Any]]


class FindPackage(Substitution):
    """What finds something about a package; derived classes say what. With ``/`` it gives a path below it."""

    def __init__(self, package: SomeSubstitutionsType) -> None:
        self._package = normalize_to_list_of_substitutions(package)

    @classmethod
    def parse(cls, data: Sequence[Any]) -> Parsed:
        """Reads the package."""
        _check_count(cls, data, 1)
        return cls, {"package": data[0]}

    @property
    def package(self) -> list[Substitution]:
        """The package, as substitutions."""
        return self._package

    def describe(self) -> str:
        """The package."""
        return f"{type(self).__name__}(pkg={describe(self._package)})"

    def find(self, package_name: str) -> str:
        """What is asked for about a package."""
        raise NotImplementedError

    def __truediv__(self, other: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([self, other])

    def perform(self, context: LaunchContext) -> str:
        """The path.

        Raises:
            PackageNotFoundError: PKG101, if there is no such package.
        """
        return self.find(perform_substitutions(context, self._package))


@expose_substitution("find-pkg-prefix")
class FindPackagePrefix(FindPackage):
    """The install prefix of a package."""

    def find(self, package_name: str) -> str:
        """The prefix."""
        return str(install_prefix(current_finder().share(package_name)))


@expose_substitution("find-pkg-share")
class FindPackageShare(FindPackage):
    """The share folder of a package."""

    def find(self, package_name: str) -> str:
        """The folder."""
        return str(current_finder().share(package_name))


@expose_substitution("exec-in-pkg")
class ExecutableInPackage(Substitution):
    """The path of an executable of a package."""

    def __init__(self, executable: SomeSubstitutionsType, package: SomeSubstitutionsType) -> None:
        self._executable = normalize_to_list_of_substitutions(executable)
        self._package = normalize_to_list_of_substitutions(package)

    @classmethod
    def parse(cls, data: Sequence[Any]) -> Parsed:
        """Reads the executable and the package."""
        _check_count(cls, data, 2)
        return cls, {"executable": data[0], "package": data[1]}

    @property
    def executable(self) -> list[Substitution]:
        """The executable, as substitutions."""
        return self._executable

    @property
    def package(self) -> list[Substitution]:
        """The package, as substitutions."""
        return self._package

    def describe(self) -> str:
        """Package and executable."""
        return f"ExecInPkg(pkg={describe(self._package)}, exec={describe(self._executable)})"

    def perform(self, context: LaunchContext) -> str:
        """The path.

        Raises:
            LinkwrightError: LAUNCH131, if there is no such package or executable; a SubstitutionFailure or the like of
                launch_ros too.
        """
        package = perform_substitutions(context, self._package)
        executable = perform_substitutions(context, self._executable)
        try:
            return str(_path(package, executable))
        except LinkwrightError as error:
            raise located(error, self.place) from error


@expose_substitution("param")
class ParameterSubstitution(Substitution):
    """The value of a parameter that `SetParameter` gave in the scope."""

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self._name = normalize_to_list_of_substitutions(name)

    @classmethod
    def parse(cls, data: Sequence[Any]) -> Parsed:
        """Reads the name."""
        _check_count(cls, data, 1)
        return cls, {"name": data[0]}

    @property
    def name(self) -> list[Substitution]:
        """The name, as substitutions."""
        return self._name

    def describe(self) -> str:
        """The name."""
        return f"Parameter(name={describe(self._name)})"

    def perform(self, context: LaunchContext) -> str:
        """The value, as text.

        Raises:
            SubstitutionFailure: LAUNCH137, no such parameter was set.
        """
        name = perform_substitutions(context, self._name)
        known = {
            item[0]: item[1]
            for item in context.launch_configurations.get("global_params", ())
            if isinstance(item, tuple)
        }
        if name not in known:
            message = f"no SetParameter in the scope gives a parameter '{name}'"
            failure = SubstitutionFailure(f"parameter '{name}' not found")
            raise error_at(self.place, "LAUNCH137", message, did_you_mean(name, known), promises=failure)
        return str(known[name])


def _path(package: str, executable: str) -> Path:
    found = find_executable(current_finder(), package, executable)
    if found.path is None:
        from linkwright.launch.ros.entry_scripts import script_for_ours

        return script_for_ours(package, executable)
    return found.path


def _check_count(cls: type, data: Sequence[Any], count: int) -> None:
    if len(data) != count:
        words = "argument" if count == 1 else "arguments"
        raise AttributeError(f"{cls.__name__} substitution expects {count} {words}, and it is given {len(data)}")
