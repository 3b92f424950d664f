"""Stands in for ``launch``, the launch system of ROS 2."""

from launch import (
    actions,
    conditions,
    descriptions,
    event_handlers,
    events,
    frontend,
    launch_description_sources,
    logging,
    substitutions,
)
from linkwright.launch.conditions import Condition
from linkwright.launch.context import LaunchContext
from linkwright.launch.description import LaunchDescription
from linkwright.launch.entity import Action, LaunchDescriptionEntity, SomeEntitiesType, SomeEntitiesType_types_tuple
from linkwright.launch.entity import SomeEntitiesType as SomeActionsType
from linkwright.launch.entity import SomeEntitiesType_types_tuple as SomeActionsType_types_tuple
from linkwright.launch.event_handlers import BaseEventHandler, EventHandler
from linkwright.launch.events import Event
from linkwright.launch.introspector import LaunchIntrospector
from linkwright.launch.service import LaunchService
from linkwright.launch.sources import LaunchDescriptionSource
from linkwright.launch.substitution import SomeSubstitutionsType, SomeSubstitutionsType_types_tuple, Substitution
from linkwright.standins.imported_names import submodules_of

__all__ = [
    "Action",
    "BaseEventHandler",
    "Condition",
    "Event",
    "EventHandler",
    "LaunchContext",
    "LaunchDescription",
    "LaunchDescriptionEntity",
    "LaunchDescriptionSource",
    "LaunchIntrospector",
    "LaunchService",
    "SomeActionsType",
    "SomeActionsType_types_tuple",
    "SomeEntitiesType",
    "SomeEntitiesType_types_tuple",
    "SomeSubstitutionsType",
    "SomeSubstitutionsType_types_tuple",
    "Substitution",
    "actions",
    "conditions",
    "descriptions",
    "event_handlers",
    "events",
    "frontend",
    "launch_description_sources",
    "logging",
    "substitutions",
]

__getattr__ = submodules_of(__name__)
