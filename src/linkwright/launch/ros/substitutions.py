"""Substitutions for the folders of packages, and for the parameters of the scope."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkwright.diagnostics import LinkwrightError, did_you_mean, phrase
from linkwright.launch.errors.exceptions import SubstitutionFailure
from linkwright.launch.errors.locations import error_at, with_location
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.declared_substitution import (
    AnyOptionalTexts,
    DeclaredSubstitution,
    Texts,
)
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    perform_substitutions,
)
from linkwright.launch.model.substitutions import PathJoinSubstitution
from linkwright.launch.model.substitutions.configuration import normalize_default
from linkwright.launch.ros.executables import find_executable
from linkwright.packages import current_finder
from linkwright.packages.share_layout import find_prefix

if TYPE_CHECKING:
    from pathlib import Path


class _LaunchRosSubstitution(DeclaredSubstitution):
    """The base class of the substitutions of ``launch_ros``."""

    @classmethod
    def wrong_count_error(cls, expected: str, argument_count: int) -> Exception:
        """Return an AttributeError for a wrong number of arguments, as ROS does."""
        return AttributeError(f"{cls.__name__} substitution expects {expected}, but got {argument_count}")


class FindPackage(_LaunchRosSubstitution, shown="{kind}(pkg={package})"):
    """The base class of substitutions that evaluate to a folder of a package.

    The operator ``/`` appends a path to the folder.
    """

    package: Texts = Texts()

    def find(self, package_name: str) -> str:
        """Return the path of the folder of a package."""
        raise NotImplementedError

    def __truediv__(self, other: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([self, other])

    def perform(self, context: LaunchContext) -> str:
        """Return the path of the folder.

        Raises:
            PackageNotFoundError: PKG101, there is no such package.
        """
        return self.find(perform_substitutions(context, self.package))


class FindPackagePrefix(FindPackage, tag="find-pkg-prefix"):
    """A substitution that evaluates to the install prefix of a package."""

    def find(self, package_name: str) -> str:
        """Return the install prefix of a package."""
        return str(find_prefix(package_name, current_finder().share(package_name)))


class FindPackageShare(FindPackage, tag="find-pkg-share"):
    """A substitution that evaluates to the share folder of a package."""

    def find(self, package_name: str) -> str:
        """Return the share folder of a package."""
        return str(current_finder().share(package_name))


class ExecutableInPackage(
    _LaunchRosSubstitution, tag="exec-in-pkg", shown="ExecInPkg(pkg={package}, exec={executable})"
):
    """A substitution that evaluates to the path of an executable of a package."""

    executable: Texts = Texts()
    package: Texts = Texts()

    def perform(self, context: LaunchContext) -> str:
        """Return the path of the executable.

        Raises:
            LinkwrightError: LAUNCH131, there is no such package or executable. As in launch_ros, the error is also a
                SubstitutionFailure or an instance of a similar class.
        """
        package = perform_substitutions(context, self.package)
        executable = perform_substitutions(context, self.executable)
        try:
            return str(_find_executable_path(package, executable))
        except LinkwrightError as error:
            raise with_location(error, self.source_location) from error


class ParameterSubstitution(_LaunchRosSubstitution, tag="param", shown="Parameter(name={name})"):
    """A substitution that evaluates to the value of a parameter set by `SetParameter`."""

    name: Texts = Texts()
    default: AnyOptionalTexts = AnyOptionalTexts(default=None, kw_only=True, read=normalize_default)

    def perform(self, context: LaunchContext) -> str:
        """Return the value as text.

        Raises:
            SubstitutionFailure: LAUNCH137, no such parameter is set in the scope, and there is no default.
        """
        name = perform_substitutions(context, self.name)
        scope_values = {
            item[0]: item[1]
            for item in context.launch_configurations.get("global_params", ())
            if isinstance(item, tuple)
        }
        if name not in scope_values:
            if self.default is not None:
                return perform_substitutions(context, self.default)
            message = phrase("no SetParameter in the scope sets parameter '{name}'", name=name)
            failure = SubstitutionFailure(f"parameter '{name}' not found")
            raise error_at(
                self.source_location, "LAUNCH137", message, did_you_mean(name, scope_values), ros_error=failure
            )
        return str(scope_values[name])


def _find_executable_path(package: str, executable: str) -> Path:
    program = find_executable(current_finder(), package, executable)
    if program.path is None:
        from linkwright.packages.programs.entry_scripts import make_script_for_own_node

        return make_script_for_own_node(package, executable)
    return program.path
