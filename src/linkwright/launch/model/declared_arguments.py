"""The arguments that a launch description declares."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.model.actions.arguments import DeclareLaunchArgument
from linkwright.launch.model.actions.configurations import ResetLaunchConfigurations
from linkwright.launch.model.entity import LaunchDescriptionEntity

_DEEPEST = 100
"""The maximum depth of the search: a file that includes itself under a condition has no end before it runs."""


def declared_arguments(
    entities: Iterable[LaunchDescriptionEntity], conditional_inclusion: bool = False
) -> list[DeclareLaunchArgument]:
    """Return the arguments that entities, their children and their includes declare.

    Descriptions that cannot be read before the launch are not searched. The first declaration of a name counts.
    Declarations under a condition are marked by ``conditionally_included``. Declarations after a
    `ResetLaunchConfigurations` cannot be given from outside and are omitted.
    """
    return list(_Declarations.by(entities, conditional=conditional_inclusion).arguments.values())


def undeclared_names(entities: Iterable[LaunchDescriptionEntity], names: Iterable[str]) -> list[str]:
    """Return the names that a description does not declare.

    The result is empty if some included descriptions cannot be read before the launch.
    """
    found = _Declarations.by(entities)
    return [] if found.incomplete else [name for name in names if name not in found.names]


class _TooDeepError(Exception):
    """Raised when entities are nested more deeply than the limit of the search."""


class _Declarations:
    """The declarations found in entities.

    Attributes:
        arguments: name -> declaration, for arguments that can be given from outside.
        names: all declared names, including names that an including file sets.
        incomplete: whether some entities could not be searched.
    """

    def __init__(self) -> None:
        self.arguments: dict[str, DeclareLaunchArgument] = {}
        self.names: set[str] = set()
        self.incomplete = False

    @classmethod
    def by(cls, entities: Iterable[LaunchDescriptionEntity], *, conditional: bool = False) -> _Declarations:
        """Return the declarations of entities and their descendants."""
        found = cls()
        with suppress(_TooDeepError):
            found.collect(entities, conditional=conditional)
        return found

    def collect(
        self,
        entities: Iterable[LaunchDescriptionEntity],
        *,
        conditional: bool = False,
        set_outside: tuple[str, ...] = (),
        depth: int = 1,
    ) -> None:
        """Add the declarations of entities and their descendants.

        Args:
            entities: the entities to search.
            conditional: whether the entities are visited under a condition.
            set_outside: the names that an including file sets.
            depth: the depth of the entities, from 1.

        Raises:
            _TooDeepError: the entities are nested too deeply.
        """
        if depth > _DEEPEST:
            self.incomplete = True
            raise _TooDeepError
        for entity in entities:
            if isinstance(entity, ResetLaunchConfigurations):
                return
            if isinstance(entity, DeclareLaunchArgument):
                entity.conditionally_included = conditional or entity.condition is not None
                self.names.add(entity.name)
                if entity.name not in set_outside:
                    self.arguments.setdefault(entity.name, entity)
                continue
            inside = set_outside + entity.arguments_given_inside()
            try:
                below = entity.describe_sub_entities()
                maybe = entity.describe_conditional_sub_entities()
                self.incomplete |= entity.hides_entities()
            except LinkwrightError:
                self.incomplete = True
                continue  # the launch reports this error when it visits the include
            self.collect(below, conditional=conditional, set_outside=inside, depth=depth + 1)
            for _, some in maybe:
                self.collect(some, conditional=True, set_outside=inside, depth=depth + 1)
