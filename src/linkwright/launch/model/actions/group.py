"""Groups of actions with their own scope."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from linkwright.launch.model.action import Action
from linkwright.launch.model.actions.configurations import (
    PopLaunchConfigurations,
    PushLaunchConfigurations,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
)
from linkwright.launch.model.actions.environment import PopEnvironment, PushEnvironment, ResetEnvironment
from linkwright.launch.model.actions.named import parse_pairs
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.entity import LaunchDescriptionEntity, as_entities
from linkwright.launch.model.markup.expose import expose_action

if TYPE_CHECKING:
    from linkwright.launch.model.markup.entity import Entity, Parser

_KEEP = "keep"


@expose_action("group")
class GroupAction(Action):
    """A group of actions that are visited together.

    Args:
        actions: the actions of the group.
        scoped: whether the changes to launch configurations and environment variables end with the group.
        forwarding: whether a scoped group inherits the launch configurations and environment variables from outside.
        launch_configurations: maps the names of launch configurations to set in the group to their values.
    """

    def __init__(
        self,
        actions: Iterable[LaunchDescriptionEntity],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: Mapping[Any, Any] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__actions = as_entities(actions)
        self._scoped = scoped
        self._forwarding = forwarding
        self._configurations = dict(launch_configurations or {})
        self.__following: tuple[Any, list[LaunchDescriptionEntity]] | None = None

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag, its ``keep`` tags and its actions."""
        _, kwargs = super().parse(entity, parser)
        for name in ("scoped", "forwarding"):
            value = entity.get_attr(name, data_type=bool, optional=True, can_be_str=False)
            if value is not None:
                kwargs[name] = value
        configurations = parse_pairs(entity, parser, _KEEP)
        if configurations is not None:
            kwargs["launch_configurations"] = configurations
        kwargs["actions"] = [parser.parse_action(child) for child in entity.children if child.type_name != _KEEP]
        return cls, kwargs

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the actions of the group, between the actions that open and close its scope."""
        # Users' classes replace '_GroupAction__actions' (its name in ROS) in 'execute'. Therefore, the list is built
        # again when that attribute has changed.
        if self.__following is None or self.__following[0] is not self.__actions:
            self.__following = self.__actions, self._enclose_in_scope()
        return self.__following[1]

    def _enclose_in_scope(self) -> list[LaunchDescriptionEntity]:
        set_actions: list[LaunchDescriptionEntity] = [
            SetLaunchConfiguration(name, value) for name, value in self._configurations.items()
        ]
        if not self._scoped:
            return [*set_actions, *self.__actions]
        open_actions: list[LaunchDescriptionEntity] = [PushLaunchConfigurations(), PushEnvironment()]
        if not self._forwarding:
            set_actions = [ResetEnvironment(), ResetLaunchConfigurations(self._configurations)]
        return [*open_actions, *set_actions, *self.__actions, PopEnvironment(), PopLaunchConfigurations()]

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the actions to visit next."""
        return self.get_sub_entities()
