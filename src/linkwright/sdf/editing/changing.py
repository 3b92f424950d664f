"""Changes, copies and deletions of the models and lights of a world.

In a world that Gazebo classic saved, ``<state>`` repeats all poses and takes precedence. Therefore moving, renaming or
deleting an entity also changes the state, including the poses of the entity's links.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import isfinite

from linkwright.diagnostics import phrase
from linkwright.geometry.single import IDENTITY, Pose, Transform, compose, invert
from linkwright.sdf.editing import writing
from linkwright.sdf.editing.errors import EditError
from linkwright.sdf.editing.shapes import (
    compute_solid_properties,
    format_lengths,
    format_number,
    format_tensor,
    is_size,
    make_element,
    make_geometry,
    make_inertial,
)
from linkwright.sdf.editing.text import Entity, WorldText
from linkwright.sdf.frames import FrameError, transform_of
from linkwright.sdf.links import Collision, Visual
from linkwright.sdf.models import Include, Model
from linkwright.sdf.poses import SEPARATOR
from linkwright.sdf.values import POSE as POSE_NUMBERS
from linkwright.sdf.values import pose_of
from linkwright.xmltree import Element
from linkwright.xmltree.patches import Replacement, indentation, line_ending

_NEW_MASS_KG = 1.0
_FIRST_INCLUDE_TAGS = ("uri", "name")
"""The pose of an include is inserted after these elements."""


@dataclass(frozen=True, slots=True)
class Change:
    """The properties of an entity to change.

    A property that is None keeps its value.

    Attributes:
        name: the name of the entity.
        pose: the pose in the world: x, y, z in m, roll, pitch, yaw in rad.
        size: the size of a model that consists of one simple shape, as in `SimpleShape`.
        new_name: the new name, or None to keep the name.
        static: whether the model is fixed and never moves.
        color: the color of a simple shape or a light: red, green, blue and alpha, from 0 to 1.
    """

    name: str
    pose: tuple[float, ...] | None = None
    size: tuple[float, ...] | None = None
    new_name: str | None = None
    static: bool | None = None
    color: tuple[float, ...] | None = None


def change(world: WorldText, changes: Iterable[Change]) -> WorldText:
    """Return a world with changes applied to models and lights.

    Args:
        world: the world, which stays unchanged.
        changes: the changes, at most one per entity.

    Raises:
        EditError: an entity cannot be changed in this way.
    """
    changes = list(changes)
    values: list[Replacement] = []
    poses: dict[str, Pose] = {}
    for edit in changes:
        values += _make_property_edits(world.entity(edit.name), edit)
        if edit.pose is not None:
            poses[edit.name] = pose_in_world(edit.pose)
    world = _apply_poses(world, poses, values)
    names = {change.name: change.new_name for change in changes if change.new_name not in (None, change.name)}
    return _rename_entities(world, {old: new for old, new in names.items() if new is not None})


def copy(world: WorldText, names: Sequence[str], offset: Sequence[float]) -> tuple[WorldText, list[str]]:
    """Return a world with copies of models and lights.

    Args:
        world: the world, which stays unchanged.
        names: the entities to copy.
        offset: the displacement of each copy from its original: x, y, z in m.

    Returns:
        The changed world, and the names of the copies.

    Raises:
        EditError: an entity does not exist or cannot be copied.
    """
    if len(offset) != 3 or not all(map(isfinite, offset)):
        raise EditError(phrase("an offset must have three finite numbers: x y z"))
    edits: list[Replacement] = []
    poses: dict[str, Pose] = {}
    used_names = set(world.used_names)
    for name in dict.fromkeys(names):
        entity = world.entity(name)
        free_name = world.choose_free_name(name, used_names)
        used_names.add(free_name)
        x, y, z = (a + b for a, b in zip(entity.world_pose[:3], offset, strict=True))
        poses[free_name] = Pose((x, y, z), pose_of_entity(entity).rpy)
        edits.append(_make_copy_edit(entity, free_name))
    return _apply_poses(world.apply_edits(edits), poses), list(poses)


def delete(world: WorldText, names: Iterable[str]) -> WorldText:
    """Return a world without some models and lights, and their entries in a saved state.

    Raises:
        EditError: an entity does not exist, or a remaining element refers to it.
    """
    deleted = {name: world.entity(name) for name in names}
    elements = {id(entity.element) for entity in deleted.values()}
    for child in world.element.elements():
        if id(child) in elements:
            continue
        for element, attribute in _list_references(child):
            model_name = get_referenced_name(element, attribute).partition(SEPARATOR)[0]
            if model_name in deleted:
                user = child.attributes.get("name") or child.tag
                raise EditError(phrase("'{name}' cannot be deleted: '{user}' refers to it", name=model_name, user=user))
    edits = [writing.make_removal_edit(entity.element) for entity in deleted.values()]
    edits += [writing.make_removal_edit(entry) for name in deleted for entry in find_state_entries(world, name)]
    return world.apply_edits(edits)


def pose_in_world(numbers: Sequence[float]) -> Pose:
    """Return a pose from six numbers that a user has entered.

    The numbers are x, y, z in m, and roll, pitch, yaw in rad.

    Raises:
        EditError: the numbers are not finite, or there are not six of them.
    """
    if len(numbers) != 6 or not all(map(isfinite, numbers)):
        raise EditError(phrase("a pose must have six finite numbers: x y z roll pitch yaw"))
    x, y, z, roll, pitch, yaw = map(float, numbers)
    return Pose((x, y, z), (roll, pitch, yaw))


def pose_of_entity(entity: Entity) -> Pose:
    """Return the pose of an entity in the world.

    A pose that is written in the frame of the world keeps its exact numbers.
    """
    written_pose = entity.pose
    if (
        written_pose.pose.quaternion is None
        and not written_pose.relative_to
        and transform_of(written_pose.pose) == entity.world_pose
    ):
        return written_pose.pose
    return writing.pose_from_transform(entity.world_pose)


def make_move_edits(world: WorldText, entity: Entity, pose: Pose) -> list[Replacement]:
    """Return the edits that move an entity to a pose in the world.

    The entity's own pose may be given in any frame. Its poses in a saved state are also changed.

    Raises:
        EditError: the frame of the entity's pose does not exist.
    """
    new_transform = transform_of(pose)
    edits = make_entity_pose_edits(entity, _convert_to_written_frame(world, entity, pose))
    for entry in find_state_entries(world, entity.name):
        edits += _make_state_move_edits(entry, entity.world_pose, new_transform, pose)
    return edits


def make_entity_pose_edits(entity: Entity, pose: Pose) -> list[Replacement]:
    """Return the edits that write the ``<pose>`` of an entity, in its declared frame."""
    element = entity.element.first("pose")
    if element is not None:
        return writing.make_pose_edits(element, pose)
    preceding_tags = _FIRST_INCLUDE_TAGS if isinstance(entity.written, Include) else ()
    return [
        writing.make_insertion_edit(
            entity.element, [writing.make_pose_element(pose)], after=preceding_tags, first=not preceding_tags
        )
    ]


def find_state_entries(world: WorldText, name: str) -> list[Element]:
    """Return the entries of the last saved state for an entity."""
    state = world.state
    entries = () if state is None else (*state.elements("model"), *state.elements("light"))
    return [entry for entry in entries if entry.attributes.get("name") == name]


def get_referenced_name(element: Element, attribute: str | None) -> str:
    """Return the name that an element refers to, in an attribute or in its text.

    The name is in the text if `attribute` is None.
    """
    return element.text().strip() if attribute is None else element.attributes[attribute]


def make_reference_renaming_edits(world: WorldText, names: dict[str, str]) -> list[Replacement]:
    """Return the edits that update references to renamed entities and to their parts.

    `names` maps old names to new ones.
    """
    edits: list[Replacement] = []
    for element, attribute in writing.references(world.element):
        reference = get_referenced_name(element, attribute)
        head, colon, tail = reference.partition(SEPARATOR)
        new = names.get(head)
        if new is None:
            continue
        text = f"{new}{colon}{tail}"
        edits += (
            writing.make_text_edits(element, text)
            if attribute is None
            else writing.make_attribute_edits(element, attribute, text)
        )
    return edits


# --- simple properties ---------------------------------------------------------------------------------------------


def _make_property_edits(entity: Entity, change: Change) -> list[Replacement]:
    edits: list[Replacement] = []
    if change.size is not None and (entity.shape is None or tuple(change.size) != entity.shape.size):
        edits += _make_size_edits(entity, tuple(change.size))
    if change.color is not None:
        edits += _make_color_edits(entity, change.color)
    if change.static is not None and change.static != entity.is_static:
        edits += _make_static_edits(entity, change.static, change.size)
    return edits


def _make_size_edits(entity: Entity, size: tuple[float, ...]) -> list[Replacement]:
    shape = entity.shape
    if shape is None:
        raise EditError(phrase("'{name}' cannot be resized: it is not a simple shape", name=entity.name))
    if not is_size(shape.kind, size):
        raise EditError(
            phrase("'{numbers}' is not a valid size for a {kind}", numbers=" ".join(map(str, size)), kind=shape.kind)
        )
    assert isinstance(entity.written, Model), "only models that are written here have a shape"
    link = entity.written.links[0]
    edits: list[Replacement] = []
    shapes: tuple[Visual | Collision, ...] = (*link.visuals, *link.collisions)
    for part in shapes:
        assert part.element is not None, "it was read from the text"
        for new in make_geometry(shape.kind, size):
            edits += _copy_values(part.element, new)
    old_properties, new_properties = (
        compute_solid_properties(shape.kind, shape.size),
        compute_solid_properties(shape.kind, size),
    )
    inertial_element = link.inertial
    if (
        inertial_element is not None
        and inertial_element.element is not None
        and not inertial_element.auto
        and old_properties.mass > 0
    ):
        properties = new_properties.with_mass(inertial_element.mass * new_properties.mass / old_properties.mass)
        edits += writing.make_child_edits(inertial_element.element, "mass", format_number(properties.mass))
        old_pose = inertial_element.element.first("pose")
        if old_pose is not None and properties.center.any():
            x, y, z = properties.center.tolist()
            edits += writing.make_pose_edits(old_pose, Pose((x, y, z)))
        inertia = inertial_element.element.first("inertia")
        if inertia is None:
            new = make_element(
                "inertia", *(make_element(tag, text) for tag, text in format_tensor(properties).items() if text != "0")
            )
            edits.append(writing.make_insertion_edit(inertial_element.element, [new]))
        else:
            for tag, text in format_tensor(properties).items():
                if inertia.first(tag) is not None or text != "0":
                    edits += writing.make_child_edits(inertia, tag, text)
    return edits


def _copy_values(owner: Element, new: Element) -> list[Replacement]:
    """Return the edits that give a child of `owner` the values of a new element.

    If there is no child with the same tag, the new element is inserted.
    """
    edits: list[Replacement] = []
    existing_elements = list(owner.elements(new.tag))
    if not existing_elements:
        return [writing.make_insertion_edit(owner, [new])]
    children = list(new.elements())
    if new.tag == "pose":
        x, y, z, roll, pitch, yaw = (float(word) for word in new.text().split())
        return writing.make_pose_edits(existing_elements[0], Pose((x, y, z), (roll, pitch, yaw)))
    if not children:
        numbers = [float(word) for word in new.text().split()]
        return writing.make_number_edits(existing_elements[0], numbers)
    counts_by_tag: dict[str, int] = {}
    for child in children:
        index = counts_by_tag.get(child.tag, 0)
        counts_by_tag[child.tag] = index + 1
        existing_children = list(existing_elements[0].elements(child.tag))
        if index < len(existing_children) and not any(True for _ in child.elements()):
            edits += writing.make_number_edits(existing_children[index], [float(word) for word in child.text().split()])
        else:
            edits += _copy_values(existing_elements[0], child)
    return edits


def _make_color_edits(entity: Entity, color: Sequence[float]) -> list[Replacement]:
    if len(color) != 4 or not all(isfinite(value) and 0 <= value <= 1 for value in color):
        raise EditError(phrase("a color must have four numbers from 0 to 1: red green blue alpha"))
    if entity.kind == "light" and not isinstance(entity.written, Include):
        return writing.make_child_edits(entity.element, "diffuse", color)
    if entity.shape is None or not isinstance(entity.written, Model):
        raise EditError(phrase("the color of '{name}' cannot be changed: it is not a simple shape", name=entity.name))
    edits: list[Replacement] = []
    for visual in entity.written.links[0].visuals:
        assert visual.element is not None, "it was read from the text"
        material = visual.element.first("material")
        if material is None:
            text = format_lengths(tuple(color))
            parts = (make_element("ambient", text), make_element("diffuse", text))
            edits.append(writing.make_insertion_edit(visual.element, [make_element("material", *parts)]))
            continue
        script = material.first("script")  # the script would override the colors
        missing = [tag for tag in ("ambient", "diffuse") if material.first(tag) is None]
        for tag in ("ambient", "diffuse"):
            if tag not in missing:
                edits += writing.make_child_edits(material, tag, color)
        new = [make_element(tag, format_lengths(tuple(color))) for tag in missing]
        if script is not None:
            edits.append(writing.make_replacement_edit(script, new))
        elif new:
            edits.append(writing.make_insertion_edit(material, new))
    return edits


def _make_static_edits(entity: Entity, static: bool, size: Sequence[float] | None) -> list[Replacement]:
    if entity.kind != "model":
        raise EditError(phrase("'{name}' is a light, which never moves", name=entity.name))
    text = "true" if static else "false"
    child = entity.element.first("static")
    if child is not None:
        edits = writing.make_text_edits(child, text)
    else:
        preceding_tags = ("uri", "name", "pose") if isinstance(entity.written, Include) else ("pose",)
        first = entity.element.first("pose") is None and not isinstance(entity.written, Include)
        edits = [
            writing.make_insertion_edit(
                entity.element, [make_element("static", text)], after=preceding_tags, first=first
            )
        ]
    if not static and entity.shape is not None and isinstance(entity.written, Model):
        link = entity.written.links[0]
        if link.inertial is None and link.element is not None:
            new = make_inertial(entity.shape.kind, tuple(size or entity.shape.size), _NEW_MASS_KG)
            edits.append(writing.make_insertion_edit(link.element, [new], first=True))
    return edits


# --- names ---------------------------------------------------------------------------------------------------------


def _rename_entities(world: WorldText, names: dict[str, str]) -> WorldText:
    edits: list[Replacement] = []
    for old, new in names.items():
        entity = world.entity(old)
        world.check_name(new)
        edits += _make_name_edits(entity, new)
        for entry in find_state_entries(world, old):
            edits += writing.make_attribute_edits(entry, "name", new)
    if len(set(names.values())) < len(names):
        raise EditError(phrase("two entities cannot have the same name"))
    return world.apply_edits([*edits, *make_reference_renaming_edits(world, names)])


def _make_name_edits(entity: Entity, name: str) -> list[Replacement]:
    if isinstance(entity.written, Include):
        return writing.make_child_edits(entity.element, "name", name, after=("uri",))
    return writing.make_attribute_edits(entity.element, "name", name)


def _make_copy_edit(entity: Entity, name: str) -> Replacement:
    """Return the edit that inserts a copy of an entity after it, under another name.

    The copy is on separate lines if the entity is on separate lines.
    """
    text, (start, end) = writing.get_source_text(entity.element), writing.find_element_offsets(entity.element)
    copy = text[start:end]
    for edit in sorted(_make_name_edits(entity, name), key=lambda edit: edit.start, reverse=True):
        copy = copy[: edit.start - start] + edit.text + copy[edit.end - start :]
    indent = indentation(text, start)
    between = "" if indent is None else f"{line_ending(text)}{indent}"
    return Replacement(end, end, between + copy)


# --- poses ---------------------------------------------------------------------------------------------------------


def _apply_poses(world: WorldText, poses: dict[str, Pose], edits: Sequence[Replacement] = ()) -> WorldText:
    """Return the world with `edits` applied and entities at new poses.

    An entity whose pose is relative to another entity is moved after that entity.
    """
    unattached_names = [name for name in poses if not world.entity(name).pose.relative_to]
    edits = [
        *edits,
        *(edit for name in unattached_names for edit in make_move_edits(world, world.entity(name), poses[name])),
    ]
    world = world.apply_edits(edits)
    for name in sorted(poses.keys() - set(unattached_names), key=lambda name: (_count_pose_chain(world, name), name)):
        world = world.apply_edits(make_move_edits(world, world.entity(name), poses[name]))
    return world


def _convert_to_written_frame(world: WorldText, entity: Entity, pose: Pose) -> Pose:
    """Return a world pose in the reference frame of an entity's pose.

    Raises:
        EditError: this frame does not exist.
    """
    relative_to = entity.pose.relative_to
    placement_frame = entity.model.placement_frame if entity.model is not None else ""
    if isinstance(entity.written, Model | Include):
        placement_frame = entity.written.placement_frame or placement_frame
    if not relative_to and not placement_frame:
        return pose
    try:
        local = compose(invert(world.frames.pose(relative_to)) if relative_to else IDENTITY, transform_of(pose))
        if placement_frame:
            local = compose(local, world.frames.inside(entity.name).pose(placement_frame))
    except FrameError as error:
        reason = phrase("'{name}' is relative to '{frame}', which cannot be placed", name=entity.name, frame=error.name)
        raise EditError(reason) from None
    return writing.pose_from_transform(local)


def _make_state_move_edits(entry: Element, old: Transform, new: Transform, pose: Pose) -> list[Replacement]:
    """Return the edits that move an entity and its parts in a saved state.

    All poses in a saved state are in the frame of the world.
    """
    displacement = compose(new, invert(old))
    edits: list[Replacement] = []
    for element in entry.walk():
        pose_element = element.first("pose") if element.tag in ("model", "link", "light") else None
        if pose_element is None:
            continue
        if element is entry:
            edits += writing.make_pose_edits(pose_element, pose)
            continue
        try:
            numbers = POSE_NUMBERS.read(pose_element.text())
            old_pose = transform_of(pose_of(numbers, degrees=False, rotation_format="euler_rpy"))
        except ValueError:
            continue
        edits += writing.make_pose_edits(pose_element, writing.pose_from_transform(compose(displacement, old_pose)))
    return edits


def _count_pose_chain(world: WorldText, name: str) -> int:
    """Return the number of entities in the chain of relative poses that ends with an entity."""
    depth, visited_names = 0, set[str]()
    entity = world.entities.get(name)
    while entity is not None and entity.name not in visited_names:
        visited_names.add(entity.name)
        entity = world.entities.get(entity.pose.relative_to.partition(SEPARATOR)[0])
        depth += 1
    return depth


def _list_references(child: Element) -> list[tuple[Element, str | None]]:
    container = Element("world")
    container.children.append(child)
    return list(writing.references(container))
