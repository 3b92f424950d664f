"""Stands in for ``launch``, the launch system of ROS 2."""

from launch import actions, conditions, event_handlers, events, launch_description_sources, logging, substitutions
from linkwright.launch.conditions import Condition
from linkwright.launch.context import LaunchContext
from linkwright.launch.description import LaunchDescription
from linkwright.launch.entity import Action, LaunchDescriptionEntity, SomeEntitiesType
from linkwright.launch.event_handlers import EventHandler
from linkwright.launch.events import Event
from linkwright.launch.sources import LaunchDescriptionSource
from linkwright.launch.substitution import SomeSubstitutionsType, SomeSubstitutionsType_types_tuple, Substitution

__all__ = [
    "Action",
    "Condition",
    "Event",
    "EventHandler",
    "LaunchContext",
    "LaunchDescription",
    "LaunchDescriptionEntity",
    "LaunchDescriptionSource",
    "SomeEntitiesType",
    "SomeSubstitutionsType",
    "SomeSubstitutionsType_types_tuple",
    "Substitution",
]
