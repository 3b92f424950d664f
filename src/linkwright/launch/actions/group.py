"""Groups of actions with a scope of their own."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from linkwright.launch.actions.configurations import (
    PopLaunchConfigurations,
    PushLaunchConfigurations,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
)
from linkwright.launch.actions.environment import PopEnvironment, PushEnvironment, ResetEnvironment
from linkwright.launch.context import LaunchContext
from linkwright.launch.entity import Action, LaunchDescriptionEntity, as_entities
from linkwright.launch.substitution import SomeSubstitutionsType


class GroupAction(Action):
    """Actions that are visited together.

    Args:
        actions: the actions.
        scoped: whether launch configurations and environment variables set inside end with the group.
        forwarding: whether those from outside are seen inside.
        launch_configurations: name -> value of configurations that are set for the group.
    """

    def __init__(
        self,
        actions: Iterable[LaunchDescriptionEntity],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._actions = as_entities(actions)
        self._scoped = scoped
        self._forwarding = forwarding
        self._configurations = dict(launch_configurations or {})
        if not scoped and not forwarding:
            raise ValueError("GroupAction without scope must forward: forwarding=False needs scoped=True")

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """The actions of the group, with what opens and closes its scope."""
        setting: list[LaunchDescriptionEntity] = [
            SetLaunchConfiguration(name, value) for name, value in self._configurations.items()
        ]
        if not self._scoped:
            return [*setting, *self._actions]
        opening: list[LaunchDescriptionEntity] = [PushLaunchConfigurations(), PushEnvironment()]
        if not self._forwarding:
            setting = [ResetEnvironment(), ResetLaunchConfigurations(self._configurations)]
        return [*opening, *setting, *self._actions, PopEnvironment(), PopLaunchConfigurations()]

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity]:  # noqa: ARG002
        """The actions, to be visited next."""
        return self.get_sub_entities()
