"""Substitutions on strings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.declared_substitution import (
    DeclaredSubstitution,
    TextLists,
    Texts,
)
from linkwright.launch.model.substitution import (
    perform_substitutions,
)


class StringJoinSubstitution(DeclaredSubstitution, tag="string-join", shown="StringJoin({delimiter}, {substitutions})"):
    """Texts joined with a delimiter between them.

    Args:
        substitutions: the texts, each of which may consist of several substitutions.
        delimiter: the text between two items.
    """

    substitutions: TextLists = TextLists()
    delimiter: Texts = Texts(default="")

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[Any, dict[str, Any]]:
        """Return the class and keyword arguments for a delimiter and texts.

        Raises:
            ValueError: there are not enough arguments.
        """
        if len(data) < 2:
            raise ValueError("string-join substitution expects a delimiter and at least 1 more argument")
        return cls, {"delimiter": data[0], "substitutions": data[1:]}

    def perform(self, context: LaunchContext) -> str:
        """Return the joined text."""
        delimiter = perform_substitutions(context, self.delimiter)
        return delimiter.join(
            perform_substitutions(context, substitution_list) for substitution_list in self.substitutions
        )


class _OneTextSubstitution(DeclaredSubstitution):
    """The base class of substitutions on a single text."""

    value: Texts = Texts()


class StringStripSubstitution(_OneTextSubstitution, tag="string-strip"):
    """A text without leading and trailing whitespace."""

    def perform(self, context: LaunchContext) -> str:
        """Return the stripped text."""
        return perform_substitutions(context, self.value).strip()


class IsEmptySubstitution(_OneTextSubstitution, tag="is-empty"):
    """A substitution that evaluates to ``true`` if a text is empty, otherwise to ``false``."""

    def perform(self, context: LaunchContext) -> str:
        """Return ``true`` if the text is empty, otherwise ``false``."""
        return "false" if perform_substitutions(context, self.value) else "true"


class NotEmptySubstitution(_OneTextSubstitution, tag="not-empty"):
    """A substitution that evaluates to ``true`` if a text is not empty, otherwise to ``false``."""

    def perform(self, context: LaunchContext) -> str:
        """Return ``true`` if the text is not empty, otherwise ``false``."""
        return "true" if perform_substitutions(context, self.value) else "false"
