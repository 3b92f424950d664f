"""Lossless editing of worlds: an edit changes the text only where necessary."""

from linkwright.sdf.editing.adding import NewShape, add_include, add_light, add_shape
from linkwright.sdf.editing.changing import Change, change, copy, delete, pose_of_entity
from linkwright.sdf.editing.errors import EditError
from linkwright.sdf.editing.grouping import group, ungroup
from linkwright.sdf.editing.text import Entity, WorldText

__all__ = [
    "Change",
    "EditError",
    "Entity",
    "NewShape",
    "WorldText",
    "add_include",
    "add_light",
    "add_shape",
    "change",
    "copy",
    "delete",
    "group",
    "pose_of_entity",
    "ungroup",
]
