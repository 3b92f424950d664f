"""Collecting parameters from the files of a package (``launch_param_builder``)."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.launch.moveit.files import ParameterValueType, load_file, load_xacro, load_yaml
from linkwright.packages import current_finder

if TYPE_CHECKING:
    from typing_extensions import Self


class ParameterBuilder:
    """Collects parameters; every method but the last returns the builder, so that calls can be chained.

    Args:
        package_name: the package that paths start from.

    Raises:
        PackageNotFoundError: PKG101, there is no such package.
    """

    def __init__(self, package_name: str) -> None:
        self._package_path = current_finder().share(package_name)
        self._parameters: dict[str, Any] = {}

    def yaml(
        self,
        file_path: str | Path,
        parameter_namespace: str | None = None,
        mappings: Mapping[str, Any] | None = None,
    ) -> Self:
        """Add what a YAML file says, below a name if one is given."""
        content = load_yaml(self._package_path / file_path, mappings) or {}
        target = self._parameters.setdefault(parameter_namespace, {}) if parameter_namespace else self._parameters
        target.update(content)
        return self

    def file_parameter(self, parameter_name: str, file_path: str | Path) -> Self:
        """Add the text of a file."""
        self._parameters[parameter_name] = load_file(self._package_path / file_path)
        return self

    def xacro_parameter(
        self, parameter_name: str, file_path: str | Path, mappings: Mapping[str, Any] | None = None
    ) -> Self:
        """Add a model."""
        self._parameters[parameter_name] = load_xacro(self._package_path / file_path, mappings)
        return self

    def parameter(self, parameter_name: str, parameter_value: ParameterValueType) -> Self:
        """Add a value."""
        self._parameters[parameter_name] = parameter_value
        return self

    def to_dict(self) -> dict[str, Any]:
        """The parameters."""
        return self._parameters
