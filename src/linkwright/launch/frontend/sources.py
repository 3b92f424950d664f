"""Sources of launch descriptions: existing descriptions, and launch files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.errors.locations import Located, with_location
from linkwright.launch.frontend.launch_file import load_launch_file, load_markup_launch_file
from linkwright.launch.frontend.python_file import load_python_launch_file
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    TextSubstitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class LaunchDescriptionSource(Located):
    """A source of a launch description: an existing description, or a file to load it from.

    Args:
        launch_description: the description, if it already exists.
        location: the path of the file; empty if the description already exists.
        method: a text for listings that describes how the description is loaded.
    """

    def __init__(
        self,
        launch_description: LaunchDescription | None = None,
        location: SomeSubstitutionsType | Path = "",
        method: str = "unspecified mechanism from a script",
    ) -> None:
        self._description = launch_description
        self._location = normalize_to_list_of_substitutions(location)
        self._method = method
        self._evaluated_location: str | None = None

    @property
    def location(self) -> str:
        """The evaluated path, or a text with the substitutions before the evaluation."""
        if self._evaluated_location is not None:
            return self._evaluated_location
        return " + ".join(map(repr, self._location))

    @property
    def location_path(self) -> Path | None:
        """The absolute path, or None.

        None means that the path is not evaluated yet, or that there is no file.
        """
        return Path.cwd() / self._evaluated_location if self._evaluated_location else None

    @property
    def method(self) -> str:
        """A text for listings that describes how the description is loaded."""
        return self._method

    def get_launch_description(self, context: LaunchContext) -> LaunchDescription:
        """Return the description.

        The first call loads it from its file.

        Raises:
            LinkwrightError: the file has errors.
        """
        if self._evaluated_location is None:
            self._evaluated_location = perform_substitutions(context, self._location)
        return self._load()

    def try_get_launch_description_without_context(self) -> LaunchDescription | None:
        """Return the description, or None if it is not loaded and its path needs a launch context.

        The path needs a context if it contains substitutions other than text.
        """
        if self._description is None and all(
            isinstance(substitution, TextSubstitution) for substitution in self._location
        ):
            self._evaluated_location = "".join(
                part.text for part in self._location if isinstance(part, TextSubstitution)
            )
            return self._load()
        return self._description

    def _load(self) -> LaunchDescription:
        assert self._evaluated_location is not None
        if self._description is None:
            try:
                self._description = self._get_launch_description(self._evaluated_location)
            except LinkwrightError as error:
                raise with_location(error, self.source_location) from error
        return self._description

    def _get_launch_description(self, location: str) -> LaunchDescription:
        """Load the description from the file.

        Users' classes override this method, so it keeps its name in ROS.
        """
        raise NotImplementedError(f"{type(self).__name__} does not implement how to read '{location}'")


class PythonLaunchDescriptionSource(LaunchDescriptionSource):
    """A Python launch file.

    Args:
        launch_file_path: the path of the file; a list is joined without separators, as in ROS.
    """

    def __init__(self, launch_file_path: SomeSubstitutionsType | Path) -> None:
        super().__init__(None, launch_file_path, "interpreted python launch file")

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return load_python_launch_file(Path.cwd() / location)


class FrontendLaunchDescriptionSource(LaunchDescriptionSource):
    """An XML or YAML launch file.

    Args:
        launch_file_path: the path of the file.
        method: a text for listings that describes how the file is loaded.
        parser: the parser; None to select it by the file name.
    """

    def __init__(
        self,
        launch_file_path: SomeSubstitutionsType | Path,
        *,
        method: str = "interpreted frontend launch file",
        parser: Any = None,
    ) -> None:
        super().__init__(None, launch_file_path, method)
        self._parser = parser

    def _get_launch_description(self, location: str) -> LaunchDescription:
        path = Path.cwd() / location
        if self._parser is None:
            return load_markup_launch_file(path)
        entity, parser = self._parser.load(path)
        description: LaunchDescription = parser.parse_description(entity)
        return description


class XMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """An XML launch file.

    Args:
        launch_file_path: the path of the file.
    """

    def __init__(self, launch_file_path: SomeSubstitutionsType | Path) -> None:
        super().__init__(launch_file_path, method="interpreted XML launch file")

    def _get_launch_description(self, location: str) -> LaunchDescription:
        from linkwright.launch.frontend.xml import Parser

        entity, parser = Parser.load(Path.cwd() / location)
        return parser.parse_description(entity)


class YAMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """A YAML launch file.

    Args:
        launch_file_path: the path of the file.
    """

    def __init__(self, launch_file_path: SomeSubstitutionsType | Path) -> None:
        super().__init__(launch_file_path, method="interpreted YAML launch file")

    def _get_launch_description(self, location: str) -> LaunchDescription:
        from linkwright.launch.frontend.yaml import Parser

        entity, parser = Parser.load(Path.cwd() / location)
        return parser.parse_description(entity)


class AnyLaunchDescriptionSource(LaunchDescriptionSource):
    """A launch file in any language.

    The file name determines the language. If it does not, the markup languages are tried first, and then Python.

    Args:
        launch_file_path: the path of the file.
    """

    def __init__(self, launch_file_path: SomeSubstitutionsType | Path) -> None:
        super().__init__(None, launch_file_path, "any launch file")

    def _get_launch_description(self, location: str) -> LaunchDescription:
        return load_launch_file(Path.cwd() / location)
