"""Substitutions that ask where packages are."""

from __future__ import annotations

from linkwright.launch.context import LaunchContext
from linkwright.launch.ros.executables import find_executable
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from linkwright.launch.substitutions import PathJoinSubstitution
from linkwright.workspace import current_finder, install_prefix


class FindPackagePrefix(Substitution):
    """The install prefix of a package. With ``/`` it gives a path below it."""

    def __init__(self, package: SomeSubstitutionsType) -> None:
        self._package = normalize_to_list_of_substitutions(package)

    @property
    def package(self) -> list[Substitution]:
        """The package, as substitutions."""
        return self._package

    def describe(self) -> str:
        """The package."""
        return f"{type(self).__name__}(pkg={describe(self._package)})"

    def __truediv__(self, other: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([self, other])

    def perform(self, context: LaunchContext) -> str:
        """The prefix.

        Raises:
            LinkwrightError: PKG101, if there is no such package.
        """
        package = perform_substitutions(context, self._package)
        return str(install_prefix(current_finder().share(package)))


class FindPackageShare(FindPackagePrefix):
    """The share folder of a package. With ``/`` it gives a path below it."""

    def perform(self, context: LaunchContext) -> str:
        """The folder.

        Raises:
            LinkwrightError: PKG101, if there is no such package.
        """
        return str(current_finder().share(perform_substitutions(context, self._package)))


class ExecutableInPackage(Substitution):
    """The path of an executable of a package."""

    def __init__(self, executable: SomeSubstitutionsType, package: SomeSubstitutionsType) -> None:
        self._executable = normalize_to_list_of_substitutions(executable)
        self._package = normalize_to_list_of_substitutions(package)

    def describe(self) -> str:
        """Package and executable."""
        return f"ExecInPkg(pkg={describe(self._package)}, exec={describe(self._executable)})"

    def perform(self, context: LaunchContext) -> str:
        """The path.

        Raises:
            LinkwrightError: LAUNCH131, if there is no such package or executable.
        """
        package = perform_substitutions(context, self._package)
        executable = perform_substitutions(context, self._executable)
        return str(find_executable(current_finder(), package, executable))
