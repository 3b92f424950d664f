"""The substitution that expands a model with arguments that are known when the launch runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.errors.places import located
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.markup.expose import expose_substitution
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from linkwright.launch.moveit.files import load_xacro


@expose_substitution("xacro")
class Xacro(Substitution):
    """The text of a model.

    Args:
        file_path: the file.
        mappings: name -> value of its arguments.
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
        """The class and its arguments, for a path.

        Raises:
            TypeError: there is more than a path.
        """
        if len(data) != 1:
            raise TypeError("xacro substitution expects one argument, the path; use $(command 'xacro ...') for more")
        return cls, {"file_path": data[0]}

    @property
    def file_path(self) -> list[Substitution]:
        """The file, as substitutions."""
        return self._file_path

    @property
    def mappings(self) -> dict[SomeSubstitutionsType, SomeSubstitutionsType]:
        """The arguments, as they were given."""
        return self._mappings

    def describe(self) -> str:
        """The file."""
        return f"Xacro({describe(self._file_path)})"

    def perform(self, context: LaunchContext) -> str:
        """The text.

        Raises:
            DescriptionError: what is wrong with the model.
        """
        arguments = {_text(context, name): _text(context, value) for name, value in self._mappings.items()}
        try:
            return load_xacro(Path(perform_substitutions(context, self._file_path)), arguments)
        except LinkwrightError as error:
            raise located(error, self.place) from error


def _text(context: LaunchContext, value: Any) -> str:
    return perform_substitutions(context, normalize_to_list_of_substitutions(value))
