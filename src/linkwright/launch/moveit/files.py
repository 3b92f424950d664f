"""Readers for the files of a MoveIt configuration (``launch_param_builder.utils``).

The files contain text, YAML or xacro. The substitution `Xacro` expands xacro files.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from linkwright.diagnostics import LinkwrightError, display_path, foreign, missing_file_hint, package_hint, phrase
from linkwright.hosting.xacro_calls import Descriptions, XacroCall, current_descriptions
from linkwright.launch.errors.locations import SourceLocation, error_at, with_location
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.markup.expose import expose_substitution
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from linkwright.packages import current_finder

ParameterValueType = str | int | float | bool | list[str] | list[int] | list[float] | list[bool] | bytes

_TEMPLATE_MARKS = ("{{", "{%", "{#")


class ParameterBuilderFileNotFoundError(KeyError):
    """Raised when a parameter file does not exist."""


def load_file(file_path: str | Path, mappings: Mapping[str, Any] | None = None) -> str:
    """Return the text of a file, rendered as a jinja2 template if mappings are given.

    Raises:
        ParameterBuilderFileNotFoundError: LAUNCH153, the file does not exist.
        LinkwrightError: LAUNCH153, the file cannot be read.
    """
    text = _read_text(Path(file_path))
    return text if mappings is None else _render_template(text, Path(file_path), mappings)


def load_yaml(file_path: str | Path, mappings: Mapping[str, Any] | None = None) -> Any:
    """Return the content of a YAML file.

    The file may be a jinja2 template.

    Raises:
        ParameterBuilderFileNotFoundError: LAUNCH153, the file does not exist.
        LinkwrightError: LAUNCH153, the file cannot be read, or is not YAML.
    """
    import yaml

    path = Path(file_path)
    text = _read_text(path)
    if mappings or any(mark in text for mark in _TEMPLATE_MARKS):
        text = _render_template(text, path, mappings or {})
    try:
        return yaml.safe_load(text)
    except yaml.YAMLError as error:
        message = phrase("parameter file '{path}' is not YAML: {error}", path=display_path(path), error=foreign(error))
        raise error_at(SourceLocation.of_caller(), "LAUNCH153", message, ros_error=error) from error


def load_xacro(file_path: str | Path, mappings: Mapping[str, Any] | None = None) -> str:
    """Return the expanded text of a xacro or URDF file.

    Raises:
        ParameterBuilderFileNotFoundError: LAUNCH153, the file does not exist.
        DescriptionError: the file has errors.
    """
    path = Path(file_path)
    _check_exists(path)
    arguments = tuple((str(name), str(value)) for name, value in (mappings or {}).items())
    descriptions = current_descriptions() or Descriptions(current_finder())
    return descriptions.expand(XacroCall(Path.cwd() / path, arguments))


def get_path(package_name: str, file_path: str | Path) -> str:
    """Return the path of a file in the share folder of a package.

    Raises:
        PackageNotFoundError: PKG101, there is no such package.
    """
    return str(current_finder().share(package_name) / file_path)


def _read_text(path: Path) -> str:
    _check_exists(path)
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else error.reason
        message = phrase(
            "parameter file '{path}' cannot be read: {reason}", path=display_path(path), reason=foreign(reason)
        )
        raise error_at(SourceLocation.of_caller(), "LAUNCH153", message, ros_error=error) from error


def _check_exists(path: Path) -> None:
    if not path.exists():
        message = phrase("parameter file '{path}' does not exist", path=display_path(path))
        ros_error = ParameterBuilderFileNotFoundError(f"File {path} doesn't exist")
        raise error_at(SourceLocation.of_caller(), "LAUNCH153", message, missing_file_hint(path), ros_error=ros_error)


def _render_template(text: str, path: Path, mappings: Mapping[str, Any]) -> str:
    try:
        import jinja2
    except ImportError as error:
        message = phrase(
            "parameter file '{path}' is a jinja2 template, but jinja2 is not installed",
            path=display_path(path),
        )
        raise error_at(SourceLocation.of_caller(), "LAUNCH153", message, package_hint("jinja2")) from error
    try:
        template = jinja2.Template(text)
        template.globals.update(radians=math.radians, degrees=math.degrees)
        return str(template.render(mappings))
    except jinja2.TemplateError as error:
        message = phrase("template '{path}' cannot be rendered: {error}", path=display_path(path), error=foreign(error))
        raise error_at(SourceLocation.of_caller(), "LAUNCH153", message, ros_error=error) from error


@expose_substitution("xacro")
class Xacro(Substitution):
    """A substitution that evaluates to the expanded text of a xacro or URDF file.

    Args:
        file_path: the path of the file.
        mappings: maps the names of xacro arguments to their values.
    """

    def __init__(
        self,
        file_path: SomeSubstitutionsType,
        *,
        mappings: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
    ) -> None:
        super().__init__()
        self._file_path = normalize_to_list_of_substitutions(file_path)
        self._mappings = dict(mappings or {})

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[type[Substitution], dict[str, Any]]:
        """Return the class and keyword arguments for a path.

        Raises:
            TypeError: there is not exactly one argument.
        """
        if len(data) != 1:
            raise TypeError("xacro substitution expects one argument, the path; use $(command 'xacro ...') for more")
        return cls, {"file_path": data[0]}

    @property
    def file_path(self) -> list[Substitution]:
        """The path of the file, as substitutions."""
        return self._file_path

    @property
    def mappings(self) -> dict[SomeSubstitutionsType, SomeSubstitutionsType]:
        """The values of the xacro arguments, as passed to the constructor."""
        return self._mappings

    def describe(self) -> str:
        """Return a text with the path of the file."""
        return f"Xacro({describe(self._file_path)})"

    def perform(self, context: LaunchContext) -> str:
        """Expand the file, and return the resulting text.

        Raises:
            DescriptionError: the file has errors.
        """
        arguments = {_evaluate(context, name): _evaluate(context, value) for name, value in self._mappings.items()}
        try:
            return load_xacro(Path(perform_substitutions(context, self._file_path)), arguments)
        except LinkwrightError as error:
            raise with_location(error, self.source_location) from error


def _evaluate(context: LaunchContext, value: Any) -> str:
    return perform_substitutions(context, normalize_to_list_of_substitutions(value))
