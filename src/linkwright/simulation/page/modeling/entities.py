"""Conversions between an edited world and the messages of the pages that edit it."""

from __future__ import annotations

from linkwright.packages import PackageFinder
from linkwright.page.protocol.message import PageMessage
from linkwright.page.protocol.simulation import (
    AddEntity,
    ChangeEntities,
    CopyEntities,
    DeleteEntities,
    EntityChange,
    GroupEntities,
    ModelChoice,
    ModelChoices,
    UngroupEntity,
    WorldEntity,
)
from linkwright.sdf.editing import (
    Change,
    Entity,
    WorldText,
    add_include,
    add_light,
    add_shape,
    change,
    copy,
    delete,
    group,
    pose_of_entity,
    ungroup,
)
from linkwright.sdf.models import Include
from linkwright.sdf.resources import Missing, ResourceFinder, find_model_file


def list_entities(world: WorldText) -> list[WorldEntity]:
    """Return the models and lights of a world as messages for pages."""
    return [_to_message(entity) for entity in world.entities.values()]


def _to_message(entity: Entity) -> WorldEntity:
    pose, shape = pose_of_entity(entity), entity.shape
    color = shape.color if shape is not None else entity.light.diffuse if entity.light is not None else None
    return WorldEntity(
        name=entity.name,
        kind=entity.kind,
        pose=[*pose.xyz, *pose.rpy],
        static=entity.is_static,
        shape=shape.kind if shape is not None else None,
        size=list(shape.size) if shape is not None else [],
        color=list(color) if color is not None else None,
        address=entity.written.uri.strip() if isinstance(entity.written, Include) else None,
        parts=list(entity.member_names),
    )


def list_model_choices(packages: PackageFinder) -> ModelChoices:
    """Return the message that lists the models on the search path, sorted by name."""
    folders = ResourceFinder(packages).models()
    names = sorted(name for name, folder in folders.items() if not isinstance(find_model_file(folder), Missing))
    return ModelChoices([ModelChoice(name, f"model://{name}") for name in names])


def apply_edit(world: WorldText, message: PageMessage) -> WorldText:
    """Return the world after applying the edit that a page requests.

    Raises:
        EditError: the edit is not possible.
    """
    match message:
        case AddEntity("model", address, pose, _):
            return add_include(world, address, pose)[0]
        case AddEntity("box" | "cylinder" | "sphere" | "wall" | "ramp" as kind, _, pose, size):
            return add_shape(world, kind, pose, size)[0]
        case AddEntity("point_light", _, pose, _):
            return add_light(world, "point", pose)[0]
        case AddEntity("directional_light", _, pose, _):
            return add_light(world, "directional", pose)[0]
        case AddEntity(_, _, pose, _):
            return add_light(world, "spot", pose)[0]
        case ChangeEntities(changes):
            return change(world, map(_to_change, changes))
        case CopyEntities(names, offset):
            return copy(world, names, offset)[0]
        case DeleteEntities(names):
            return delete(world, names)
        case GroupEntities(names, name):
            return group(world, names, name)
        case UngroupEntity(name):
            return ungroup(world, name)[0]
        case _:
            raise TypeError(f"{type(message).__name__} is not an edit of a world")


def _to_change(change: EntityChange) -> Change:
    return Change(
        change.name,
        pose=None if change.pose is None else tuple(change.pose),
        size=None if change.size is None else tuple(change.size),
        new_name=change.new_name,
        static=change.static,
        color=None if change.color is None else tuple(change.color),
    )
