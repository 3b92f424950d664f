"""Group models into one model, and ungroup them."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from linkwright.diagnostics import phrase
from linkwright.geometry.single import Pose, Transform, compose
from linkwright.sdf.editing import writing
from linkwright.sdf.editing.changing import (
    find_state_entries,
    get_referenced_name,
    make_entity_pose_edits,
    make_reference_renaming_edits,
    pose_of_entity,
)
from linkwright.sdf.editing.errors import EditError
from linkwright.sdf.editing.shapes import format_lengths, make_element
from linkwright.sdf.editing.text import Entity, WorldText
from linkwright.sdf.frames import transform_of
from linkwright.sdf.models import Include, Model
from linkwright.sdf.poses import MODEL, SEPARATOR
from linkwright.xmltree import Element
from linkwright.xmltree.patches import Replacement, apply, escape, indentation, line_ending

_INDENT_STEP = "  "
_POSITION_DIGITS = 3
"""Decimal digits of a group's position in meters."""
_LINE_START = re.compile(r"(?<=\n)(?=[^\r\n])")
_CDATA = re.compile(r"<!\[CDATA\[.*?\]\]>", re.DOTALL)


def group(world: WorldText, names: Sequence[str], name: str) -> WorldText:
    """Return a world with several models grouped into one, at their mean position.

    The models keep their poses in the world. Their entries in a saved state are removed, and the poses from there are
    written into the models.

    Args:
        world: the world to edit.
        names: at least two models.
        name: the preferred name of the group, which is changed if it is not free.

    Raises:
        EditError: the models cannot be grouped.
    """
    entities = [world.entity(entity_name) for entity_name in dict.fromkeys(names)]
    _check_group(entities)
    name = world.choose_free_name(name.strip() or "group")
    world.check_name(name)
    member_names = frozenset(entity.name for entity in entities)
    x, y, z = (
        round(sum(entity.world_pose[axis] for entity in entities) / len(entities), _POSITION_DIGITS)
        for axis in range(3)
    )
    origin: Transform = (x, y, z, 0.0, 0.0, 0.0, 1.0)
    edits: list[Replacement] = []
    for entity in entities:
        edits += [writing.make_removal_edit(entry) for entry in find_state_entries(world, entity.name)]
        reference_frame = entity.pose.relative_to
        if reference_frame.partition(SEPARATOR)[0] in member_names and not find_state_entries(world, entity.name):
            continue  # The pose remains relative to another model in the group.
        edits += _make_relative_pose_edits(world, entity, origin)
    edits += make_outside_reference_edits(world, member_names, name)
    text = world.text
    first_entity = min(entities, key=lambda entity: entity.element.offset)
    start = writing.find_element_offsets(first_entity.element)[0]
    outer_indent, newline = indentation(text, start) or "", line_ending(text)
    inner_indent = outer_indent + _INDENT_STEP
    static_element = f"{newline}{inner_indent}<static>true</static>" if entities[0].is_static else ""
    pose_element = f"<pose>{format_lengths((x, y, z, 0.0, 0.0, 0.0))}</pose>"
    group_start = f'<model name="{escape(name)}">{newline}{inner_indent}{pose_element}{static_element}'
    member_texts = []
    for entity in sorted(entities, key=lambda entity: entity.element.offset):
        begin, end = writing.find_element_offsets(entity.element)
        member_edits = [edit for edit in edits if begin <= edit.start and edit.end <= end]
        edits = [edit for edit in edits if edit not in member_edits]
        local_edits = [
            Replacement(replacement.start - begin, replacement.end - begin, replacement.text)
            for replacement in member_edits
        ]
        member_texts.append(inner_indent + _indent(apply(text[begin:end], local_edits), _INDENT_STEP))
    group_text = newline.join([group_start, *member_texts, f"{outer_indent}</model>"])
    begin, end = writing.find_element_offsets(first_entity.element)
    edits.append(Replacement(begin, end, group_text))
    edits += [writing.make_removal_edit(entity.element) for entity in entities if entity is not first_entity]
    return world.apply_edits(edits)


def ungroup(world: WorldText, name: str) -> tuple[WorldText, list[str]]:
    """Replace a group in a world by its nested models.

    The models keep their poses in the world.

    Returns:
        The changed world, and the names of the models, which were changed if they were not free.

    Raises:
        EditError: the group contains more than models, or is from another file.
    """
    entity = world.entity(name)
    model = entity.written
    if not isinstance(model, Model):
        raise EditError(phrase("'{name}' is not a group in this file", name=name))
    if not entity.member_names or model.joints or model.frames or model.plugins or model.links:
        raise EditError(phrase("'{name}' cannot be ungrouped: it contains more than models", name=name))
    member_elements = [element for element in entity.element.elements() if element.tag in ("model", "include")]
    if len(member_elements) != len(entity.member_names):
        raise EditError(phrase("'{name}' cannot be ungrouped: one of its includes does not exist", name=name))
    new_names = _choose_member_names(world, entity, member_elements)
    edits: list[Replacement] = [writing.make_removal_edit(entry) for entry in find_state_entries(world, name)]
    frames = world.frames.inside(name)
    for element, old in zip(member_elements, _list_old_names(entity, member_elements), strict=True):
        edits += _make_release_edits(
            world, entity, element, old, new_names, compose(entity.world_pose, frames.pose(old))
        )
    for element, attribute in writing.references(world.element):
        head, colon, tail = get_referenced_name(element, attribute).partition(SEPARATOR)
        member_name, separator, nested_name = tail.partition(SEPARATOR)
        if head != name:
            continue
        if not colon or member_name not in new_names:
            raise EditError(phrase("'{name}' cannot be ungrouped: another element refers to it", name=name))
        new_reference = f"{new_names[member_name]}{separator}{nested_name}"
        edits += writing.make_reference_edits(element, attribute, new_reference)
    edits += [
        writing.make_removal_edit(element) for tag in ("pose", "static") for element in entity.element.elements(tag)
    ]
    begin, end = writing.find_element_offsets(entity.element)
    content_start, content_end = writing.find_content_offsets(entity.element)
    content_edits = [
        Replacement(e.start - content_start, e.end - content_start, e.text)
        for e in edits
        if begin <= e.start and e.end <= end
    ]
    edits = [edit for edit in edits if not (begin <= edit.start and edit.end <= end)]
    outer_indent = indentation(world.text, begin)
    content = apply(world.text[content_start:content_end], content_edits).strip()
    inner_step = (indentation(world.text, member_elements[0].offset) or "").removeprefix(outer_indent or "")
    edits.append(Replacement(begin, end, _unindent(content, inner_step)))
    return world.apply_edits(edits), list(new_names.values())


def make_outside_reference_edits(world: WorldText, member_names: frozenset[str], group_name: str) -> list[Replacement]:
    """Return the edits that update references to the members of a group from outside the group."""
    names = {name: f"{group_name}{SEPARATOR}{name}" for name in member_names}
    ranges = [writing.find_element_offsets(world.entity(name).element) for name in member_names]
    return [
        renamed_reference
        for renamed_reference in make_reference_renaming_edits(world, names)
        if not any(start <= renamed_reference.start and renamed_reference.end <= end for start, end in ranges)
    ]


def _check_group(entities: Sequence[Entity]) -> None:
    if len(entities) < 2:
        raise EditError(phrase("a group needs at least two models"))
    light = next((entity for entity in entities if entity.kind == "light"), None)
    if light is not None:
        raise EditError(phrase("'{name}' is a light: only models can be grouped", name=light.name))
    mismatch = next((entity for entity in entities if entity.is_static != entities[0].is_static), None)
    if mismatch is not None:
        static_entity, moving_entity = (mismatch, entities[0]) if mismatch.is_static else (entities[0], mismatch)
        raise EditError(
            phrase(
                "'{static}' is static and '{moving}' is not: make both static, or neither",
                static=static_entity.name,
                moving=moving_entity.name,
            )
        )


def _make_relative_pose_edits(world: WorldText, entity: Entity, origin: Transform) -> list[Replacement]:
    """Return the edits that write the pose of an entity relative to a group's origin.

    The pose of the entity in the world does not change.
    """
    world_pose = pose_of_entity(entity)
    x, y, z = (a - b for a, b in zip(world_pose.xyz, origin[:3], strict=True))
    local_pose = Pose((x, y, z), world_pose.rpy)
    placement_frame = entity.model.placement_frame if entity.model is not None else ""
    if placement_frame:
        placement_transform = compose(transform_of(local_pose), world.frames.inside(entity.name).pose(placement_frame))
        local_pose = writing.pose_from_transform(placement_transform)
    edits = make_entity_pose_edits(entity, local_pose)
    pose = entity.element.first("pose")
    if pose is not None:
        edits += [
            edit for name in ("relative_to", "frame") for edit in writing.make_attribute_removal_edits(pose, name)
        ]
    return edits


def _list_old_names(entity: Entity, parts: Sequence[Element]) -> list[str]:
    """Return the names that elements have within their group, in the order of `parts`."""
    assert isinstance(entity.written, Model), "groups are models"
    assert entity.model is not None, "groups are models"
    models = [id(model.element) for model in entity.written.models]
    includes = [id(include.element) for include in entity.written.includes]
    order = {element_id: entity.model.models[index].name for index, element_id in enumerate((*models, *includes))}
    return [order[id(part)] for part in parts]


def _choose_member_names(world: WorldText, entity: Entity, parts: Sequence[Element]) -> dict[str, str]:
    names: dict[str, str] = {}
    used_names = world.used_names - {entity.name}
    for old in _list_old_names(entity, parts):
        names[old] = world.choose_free_name(old, used_names)
        used_names |= {names[old]}
    return names


def _make_release_edits(
    world: WorldText, entity: Entity, element: Element, old_name: str, names: dict[str, str], world_pose: Transform
) -> list[Replacement]:
    """Return the edits that move a member out of its group.

    `old_name` is the name of the member, `names` maps the members' old names to new ones, and `world_pose` is the pose
    of the member in the world.

    Raises:
        EditError: the member's pose is relative to another frame of the group.
    """
    assert entity.model is not None, "groups are models"
    model = next(model for model in entity.model.models if model.name == old_name)
    edits: list[Replacement] = []
    if names[old_name] != old_name:
        edits += (
            writing.make_child_edits(element, "name", names[old_name], after=("uri",))
            if element.tag == "include"
            else writing.make_attribute_edits(element, "name", names[old_name])
        )
    if entity.is_static and not model.static:
        preceding_tags = ("uri", "name", "pose")
        child = element.first("static")
        edits += (
            writing.make_text_edits(child, "true")
            if child is not None
            else [
                writing.make_insertion_edit(element, [make_element("static", "true")], after=preceding_tags, first=True)
            ]
        )
    pose = element.first("pose")
    reference_frame = model.pose.relative_to
    head, colon, tail = reference_frame.partition(SEPARATOR)
    if pose is not None and head in names:
        attribute = "relative_to" if "relative_to" in pose.attributes else "frame"
        return [*edits, *writing.make_attribute_edits(pose, attribute, f"{names[head]}{colon}{tail}")]
    if reference_frame not in ("", MODEL):
        raise EditError(
            phrase(
                "'{name}' cannot leave the group: its pose is relative to '{frame}'",
                name=old_name,
                frame=reference_frame,
            )
        )
    if model.placement_frame:
        world_pose = compose(world_pose, world.frames.inside(entity.name).inside(old_name).pose(model.placement_frame))
    member_pose = writing.pose_from_transform(world_pose)
    member = Entity(
        old_name, "model", element, Include("") if element.tag == "include" else model, model, None, world_pose, None
    )
    edits += make_entity_pose_edits(member, member_pose)
    if pose is not None:
        edits += [
            edit for name in ("relative_to", "frame") for edit in writing.make_attribute_removal_edits(pose, name)
        ]
    return edits


def _indent(text: str, step: str) -> str:
    """Return a text with all lines except the first indented by `step`, but CDATA unchanged."""
    return _edit_outside_cdata(text, lambda part: _LINE_START.sub(step, part))


def _unindent(text: str, step: str) -> str:
    """Return a text with `step` removed from the start of each line, but CDATA unchanged."""
    pattern = re.compile(rf"(?<=\n){re.escape(step)}")
    return _edit_outside_cdata(text, lambda part: pattern.sub("", part)) if step else text


def _edit_outside_cdata(text: str, edit: Callable[[str], str]) -> str:
    cdata_spans, chunks, position = [match.span() for match in _CDATA.finditer(text)], [], 0
    for start, end in cdata_spans:
        chunks += [edit(text[position:start]), text[start:end]]
        position = end
    return "".join([*chunks, edit(text[position:])])
