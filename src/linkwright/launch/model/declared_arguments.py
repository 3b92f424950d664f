"""The arguments that a launch description declares."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.model.actions.arguments import DeclareLaunchArgument
from linkwright.launch.model.actions.configurations import ResetLaunchConfigurations
from linkwright.launch.model.entity import LaunchDescriptionEntity

_MAX_DEPTH = 100
"""The maximum depth of the search, because a file may include itself under a condition."""


def find_declared_arguments(
    entities: Iterable[LaunchDescriptionEntity], conditional_inclusion: bool = False
) -> list[DeclareLaunchArgument]:
    """Return the arguments that entities, their children and their includes declare.

    The search omits descriptions that cannot be read before the launch. The first declaration of a name counts.
    Declarations under a condition have `conditionally_included` set. Arguments that are declared after a
    `ResetLaunchConfigurations` cannot be set from outside, so they are omitted.
    """
    return list(_Declarations.of_entities(entities, conditional=conditional_inclusion).arguments.values())


def find_undeclared_names(entities: Iterable[LaunchDescriptionEntity], names: Iterable[str]) -> list[str]:
    """Return the given names that a launch description does not declare as arguments.

    The result is empty if the declarations of some included descriptions are unknown before the launch.
    """
    declarations = _Declarations.of_entities(entities)
    return [] if declarations.is_incomplete else [name for name in names if name not in declarations.names]


class _TooDeepError(Exception):
    """Raised when entities are nested more deeply than the limit of the search."""


class _Declarations:
    """The arguments that entities declare.

    Attributes:
        arguments: maps names to declarations, for arguments that can be set from outside.
        names: all declared names, including names that an including file sets.
        is_incomplete: whether some entities could not be searched.
    """

    def __init__(self) -> None:
        self.arguments: dict[str, DeclareLaunchArgument] = {}
        self.names: set[str] = set()
        self.is_incomplete = False

    @classmethod
    def of_entities(cls, entities: Iterable[LaunchDescriptionEntity], *, conditional: bool = False) -> _Declarations:
        """Return the declarations of entities and their descendants."""
        declarations = cls()
        with suppress(_TooDeepError):
            declarations.collect(entities, conditional=conditional)
        return declarations

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
            set_outside: the names of arguments that an including file sets.
            depth: the depth of the entities, from 1.

        Raises:
            _TooDeepError: the entities are nested too deeply.
        """
        if depth > _MAX_DEPTH:
            self.is_incomplete = True
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
            inner_set_names = set_outside + entity.arguments_given_inside()
            try:
                children = entity.describe_sub_entities()
                conditional_children = entity.describe_conditional_sub_entities()
                self.is_incomplete |= entity.hides_entities()
            except LinkwrightError:
                self.is_incomplete = True
                continue  # the launch reports this error when it visits the include
            self.collect(children, conditional=conditional, set_outside=inner_set_names, depth=depth + 1)
            for _, conditional_entities in conditional_children:
                self.collect(conditional_entities, conditional=True, set_outside=inner_set_names, depth=depth + 1)
