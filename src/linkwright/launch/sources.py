"""Where launch descriptions come from."""

from __future__ import annotations

from pathlib import Path

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.context import LaunchContext
from linkwright.launch.description import LaunchDescription
from linkwright.launch.places import Place, located
from linkwright.launch.python_file import load_python_launch_file
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    TextSubstitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class LaunchDescriptionSource:
    """A launch description, or the file to get it from.

    Args:
        launch_description: the description, if it is there already.
        location: the path of the file otherwise.
        method: how it comes to be, for those who read about it.
    """

    def __init__(
        self,
        launch_description: LaunchDescription | None = None,
        location: SomeSubstitutionsType = "",
        method: str = "unspecified mechanism from a script",
    ) -> None:
        self._description = launch_description
        self._location = normalize_to_list_of_substitutions(location)
        self._method = method
        self._path: Path | None = None
        self.place = Place.of_caller()

    @property
    def location(self) -> str:
        """The path; before it is known, a description of it."""
        return str(self._path) if self._path else describe(self._location)

    @property
    def location_path(self) -> Path | None:
        """The path, once it is known; None for a description that comes from no file."""
        return self._path

    @property
    def method(self) -> str:
        """How the description comes to be."""
        return self._method

    def get_launch_description(self, context: LaunchContext) -> LaunchDescription:
        """The description.

        Raises:
            LinkwrightError: LAUNCH101 to LAUNCH107, what is wrong with the file.
        """
        if self._description is None:
            self._load(Path(perform_substitutions(context, self._location)))
        assert self._description is not None
        return self._description

    def try_get_launch_description_without_context(self) -> LaunchDescription | None:
        """The description, if nothing but its text is needed to find it."""
        if self._description is None and all(isinstance(part, TextSubstitution) for part in self._location):
            self._load(Path("".join(part.text for part in self._location if isinstance(part, TextSubstitution))))
        return self._description

    def _load(self, path: Path) -> None:
        self._path = Path.cwd() / path
        try:
            self._description = load_python_launch_file(self._path)
        except LinkwrightError as error:
            raise located(error, self.place) from error


class PythonLaunchDescriptionSource(LaunchDescriptionSource):
    """A Python launch file.

    Args:
        launch_file_path: its path; a list is joined as it stands, as in ROS.
    """

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(None, launch_file_path, "interpreted python launch file")


class AnyLaunchDescriptionSource(LaunchDescriptionSource):
    """A launch file whose kind is told by its name."""

    def __init__(self, launch_file_path: SomeSubstitutionsType | Substitution) -> None:
        super().__init__(None, launch_file_path, "any launch file")
