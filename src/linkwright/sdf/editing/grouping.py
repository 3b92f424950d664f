"""Groups models into one model, and ungroups them."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from linkwright.diagnostics import phrase
from linkwright.geometry.single import Pose, Transform, compose
from linkwright.sdf.editing import writing
from linkwright.sdf.editing.changing import place, pose_of_entity, referenced_name, rename_references, state_of
from linkwright.sdf.editing.errors import EditError
from linkwright.sdf.editing.shapes import lengths, new_element
from linkwright.sdf.editing.text import Entity, WorldText
from linkwright.sdf.frames import transform_of
from linkwright.sdf.models import Include, Model
from linkwright.sdf.poses import MODEL, SEPARATOR
from linkwright.xmltree import Element
from linkwright.xmltree.patches import Replacement, apply, escaped, indentation, line_ending

_STEP = "  "
_DIGITS = 3
"""Decimal digits of a group's position in metres."""
_LINE = re.compile(r"(?<=\n)(?=[^\r\n])")
_CDATA = re.compile(r"<!\[CDATA\[.*?\]\]>", re.DOTALL)


def group(world: WorldText, names: Sequence[str], name: str) -> WorldText:
    """Return a world with several models grouped into one model, whose origin is their mean position.

    The models keep their poses in the world. Their entries in a saved state are removed, and the poses from there are
    written into the models.

    Args:
        world: the world.
        names: the models, at least two.
        name: the preferred name of the group, which is changed if it is not free.

    Raises:
        EditError: the models cannot be grouped.
    """
    entities = [world.entity(fromkey) for fromkey in dict.fromkeys(names)]
    _check_group(entities)
    name = world.free_name(name.strip() or "group")
    world.check_name(name)
    inside = frozenset(entity.name for entity in entities)
    x, y, z = (round(sum(entity.place[axis] for entity in entities) / len(entities), _DIGITS) for axis in range(3))
    origin: Transform = (x, y, z, 0.0, 0.0, 0.0, 1.0)
    edits: list[Replacement] = []
    for entity in entities:
        edits += [writing.removed(entry) for entry in state_of(world, entity.name)]
        base = entity.pose.relative_to
        if base.partition(SEPARATOR)[0] in inside and not state_of(world, entity.name):
            continue  # The pose remains relative to another model in the group.
        edits += _relative_pose_edits(world, entity, origin)
    edits += rename_outside_references(world, inside, name)
    text = world.text
    first = min(entities, key=lambda entity: entity.element.offset)
    start = writing.range_of(first.element)[0]
    blanks, newline = indentation(text, start) or "", line_ending(text)
    inner = blanks + _STEP
    static = f"{newline}{inner}<static>true</static>" if entities[0].static else ""
    head = f'<model name="{escaped(name)}">{newline}{inner}<pose>{lengths((x, y, z, 0.0, 0.0, 0.0))}</pose>{static}'
    parts = []
    for entity in sorted(entities, key=lambda entity: entity.element.offset):
        begin, end = writing.range_of(entity.element)
        own = [edit for edit in edits if begin <= edit.start and edit.end <= end]
        edits = [edit for edit in edits if edit not in own]
        moved = [
            Replacement(replacement.start - begin, replacement.end - begin, replacement.text) for replacement in own
        ]
        parts.append(inner + _indent(apply(text[begin:end], moved), _STEP))
    whole = newline.join([head, *parts, f"{blanks}</model>"])
    begin, end = writing.range_of(first.element)
    edits.append(Replacement(begin, end, whole))
    edits += [writing.removed(entity.element) for entity in entities if entity is not first]
    return world.edited(edits)


def ungroup(world: WorldText, name: str) -> tuple[WorldText, list[str]]:
    """Return a world in which the nested models of a group are separate models.

    The models keep their poses in the world.

    Returns:
        The changed world, and the names of the models, which were changed if they were not free.

    Raises:
        EditError: the group contains more than models, or is from another file.
    """
    entity = world.entity(name)
    model = entity.written
    if not isinstance(model, Model):
        raise EditError(phrase("'{name}' is not a group that is written in this file", name=name))
    if not entity.parts or model.joints or model.frames or model.plugins or model.links:
        raise EditError(phrase("'{name}' contains more than models, so it cannot be ungrouped", name=name))
    parts = [element for element in entity.element.elements() if element.tag in ("model", "include")]
    if len(parts) != len(entity.parts):
        raise EditError(phrase("'{name}' cannot be ungrouped: one of its includes does not exist", name=name))
    names = _names_of(world, entity, parts)
    edits: list[Replacement] = [writing.removed(entry) for entry in state_of(world, name)]
    frames = world.frames.inside(name)
    for element, old in zip(parts, _old_names(entity, parts), strict=True):
        edits += _release_edits(world, entity, element, old, names, compose(entity.place, frames.pose(old)))
    for element, attribute in writing.references(world.element):
        head, colon, tail = referenced_name(element, attribute).partition(SEPARATOR)
        part, more, rest = tail.partition(SEPARATOR)
        if head != name:
            continue
        if not colon or part not in names:
            raise EditError(phrase("'{name}' cannot be ungrouped: another element refers to it", name=name))
        written = f"{names[part]}{more}{rest}"
        edits += writing.set_reference(element, attribute, written)
    edits += [writing.removed(element) for tag in ("pose", "static") for element in entity.element.elements(tag)]
    begin, end = writing.range_of(entity.element)
    first, last = writing.content_of(entity.element)
    own = [Replacement(e.start - first, e.end - first, e.text) for e in edits if begin <= e.start and e.end <= end]
    edits = [edit for edit in edits if not (begin <= edit.start and edit.end <= end)]
    blanks = indentation(world.text, begin)
    inner = apply(world.text[first:last], own).strip()
    step = (indentation(world.text, parts[0].offset) or "").removeprefix(blanks or "")
    edits.append(Replacement(begin, end, _unindent(inner, step)))
    return world.edited(edits), list(names.values())


def rename_outside_references(world: WorldText, inside: frozenset[str], group_name: str) -> list[Replacement]:
    """Return the edits that update references to the members of a group from outside the group."""
    names = {name: f"{group_name}{SEPARATOR}{name}" for name in inside}
    ranges = [writing.range_of(world.entity(name).element) for name in inside]
    return [
        renamed_reference
        for renamed_reference in rename_references(world, names)
        if not any(start <= renamed_reference.start and renamed_reference.end <= end for start, end in ranges)
    ]


def _check_group(entities: Sequence[Entity]) -> None:
    if len(entities) < 2:
        raise EditError(phrase("a group needs at least two models"))
    light = next((entity for entity in entities if entity.kind == "light"), None)
    if light is not None:
        raise EditError(phrase("'{name}' is a light, which cannot be part of a model", name=light.name))
    other = next((entity for entity in entities if entity.static != entities[0].static), None)
    if other is not None:
        static, moving = (other, entities[0]) if other.static else (entities[0], other)
        raise EditError(
            phrase(
                "'{static}' is static and '{moving}' is not: make both the same", static=static.name, moving=moving.name
            )
        )


def _relative_pose_edits(world: WorldText, entity: Entity, origin: Transform) -> list[Replacement]:
    """Return the edits that write the pose of an entity relative to a group's origin.

    The pose of the entity in the world does not change.
    """
    written = pose_of_entity(entity)
    x, y, z = (a - b for a, b in zip(written.xyz, origin[:3], strict=True))
    local = Pose((x, y, z), written.rpy)
    placed = entity.model.placement_frame if entity.model is not None else ""
    if placed:
        inner = compose(transform_of(local), world.frames.inside(entity.name).pose(placed))
        local = writing.pose_from(inner)
    edits = place(entity, local)
    pose = entity.element.first("pose")
    if pose is not None:
        edits += [edit for name in ("relative_to", "frame") for edit in writing.remove_attribute(pose, name)]
    return edits


def _old_names(entity: Entity, parts: Sequence[Element]) -> list[str]:
    """Return the names of parts within their group, in the order of `parts`."""
    assert isinstance(entity.written, Model), "groups are models"
    assert entity.model is not None, "groups are models"
    models = [id(model.element) for model in entity.written.models]
    includes = [id(include.element) for include in entity.written.includes]
    order = {each: entity.model.models[index].name for index, each in enumerate((*models, *includes))}
    return [order[id(part)] for part in parts]


def _names_of(world: WorldText, entity: Entity, parts: Sequence[Element]) -> dict[str, str]:
    names: dict[str, str] = {}
    taken = world.taken - {entity.name}
    for old in _old_names(entity, parts):
        names[old] = world.free_name(old, taken)
        taken |= {names[old]}
    return names


def _release_edits(
    world: WorldText, entity: Entity, element: Element, old: str, names: dict[str, str], there: Transform
) -> list[Replacement]:
    """Return the edits in a member of a group that is moved out of the group.

    `old` is the name of the member, `names` maps the members' old names to new ones, and `there` is the pose of the
    member in the world.

    Raises:
        EditError: the member's pose is relative to another frame of the group.
    """
    assert entity.model is not None, "groups are models"
    model = next(model for model in entity.model.models if model.name == old)
    edits: list[Replacement] = []
    if names[old] != old:
        edits += (
            writing.set_child(element, "name", names[old], after=("uri",))
            if element.tag == "include"
            else writing.set_attribute(element, "name", names[old])
        )
    if entity.static and not model.static:
        after = ("uri", "name", "pose")
        child = element.first("static")
        edits += (
            writing.set_text(child, "true")
            if child is not None
            else [writing.inserted_in(element, [new_element("static", "true")], after=after, first=True)]
        )
    pose = element.first("pose")
    base = model.pose.relative_to
    head, colon, tail = base.partition(SEPARATOR)
    if pose is not None and head in names:
        attribute = "relative_to" if "relative_to" in pose.attributes else "frame"
        return [*edits, *writing.set_attribute(pose, attribute, f"{names[head]}{colon}{tail}")]
    if base not in ("", MODEL):
        raise EditError(phrase("'{name}' is relative to '{frame}', so it cannot leave the group", name=old, frame=base))
    if model.placement_frame:
        there = compose(there, world.frames.inside(entity.name).inside(old).pose(model.placement_frame))
    local = writing.pose_from(there)
    part = Entity(old, "model", element, Include("") if element.tag == "include" else model, model, None, there, None)
    edits += place(part, local)
    if pose is not None:
        edits += [edit for name in ("relative_to", "frame") for edit in writing.remove_attribute(pose, name)]
    return edits


def _indent(text: str, step: str) -> str:
    """Return a text with all lines except the first indented by `step`; CDATA is not changed."""
    return _outside_cdata(text, lambda part: _LINE.sub(step, part))


def _unindent(text: str, step: str) -> str:
    """Return a text with one indentation by `step` removed from each line; CDATA is not changed."""
    pattern = re.compile(rf"(?<=\n){re.escape(step)}")
    return _outside_cdata(text, lambda part: pattern.sub("", part)) if step else text


def _outside_cdata(text: str, do: Callable[[str], str]) -> str:
    kept, parts, at = [found.span() for found in _CDATA.finditer(text)], [], 0
    for start, end in kept:
        parts += [do(text[at:start]), text[start:end]]
        at = end
    return "".join([*parts, do(text[at:])])
