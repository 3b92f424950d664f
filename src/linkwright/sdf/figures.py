"""Models that display actors and roads."""

from __future__ import annotations

from math import atan2, hypot

from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.geometry.single import Pose, Vector3
from linkwright.sdf.actors import Actor
from linkwright.sdf.links import Collision, Link, Visual
from linkwright.sdf.materials import Material
from linkwright.sdf.models import Model
from linkwright.sdf.plugins import library_name
from linkwright.sdf.poses import RawPose
from linkwright.sdf.shapes import Mesh
from linkwright.sdf.worlds import Road

ACTOR_COLLISIONS_LIBRARY = "ActorCollisionsPlugin"
"""The plugin of Gazebo Classic that lets an actor collide."""
ACTOR_WALK_LIBRARY = "ActorPlugin"
"""The plugin of Gazebo Classic that lets an actor walk to targets at random, around obstacles."""
_SKIN_NAME = "skin"
"""The name of the link that shows the skin, and the prefix of its visuals."""
_ROAD_THICKNESS = 0.01
"""The thickness of a road, in m."""
_ASPHALT = Material(ambient=(0.2, 0.2, 0.2, 1.0), diffuse=(0.25, 0.25, 0.25, 1.0))


_SKIN_COLOR = Material(ambient=(0.5, 0.4, 0.35, 1.0), diffuse=(0.75, 0.6, 0.5, 1.0))
_CLOTHES = Material(ambient=(0.15, 0.2, 0.35, 1.0), diffuse=(0.25, 0.35, 0.6, 1.0))
_PERSON_SHAPES: tuple[tuple[Capsule | Sphere, Vector3, Material], ...] = (
    (Capsule(0.1, 0.7), (0.0, 0.1, -0.55), _CLOTHES),
    (Capsule(0.1, 0.7), (0.0, -0.1, -0.55), _CLOTHES),
    (Capsule(0.18, 0.3), (0.0, 0.0, 0.2), _CLOTHES),
    (Sphere(0.13), (0.0, 0.0, 0.64), _SKIN_COLOR),
)
"""Shape, position and material of the legs, trunk and head of a person 1.8 m tall.

Lengths are in m, and positions are relative to the hips, which are 1 m above the feet.
"""


def make_actor_model(actor: Actor, hips: Vector3 | None = (0.0, 0.0, 0.0)) -> Model:
    """Return the model of an actor: the shapes of its links, and its skin.

    An actor with `ACTOR_COLLISIONS_LIBRARY` collides: its links with their collisions, and its skin as a plain figure
    of a person's size, which replaces the boxes that Gazebo puts around the bones.

    Args:
        actor: the actor to display.
        hips: the position of the skeleton's first joint in the coordinates of the skin's mesh, before its scale is
            applied; Gazebo puts this joint at the pose of the actor. None if the skin does not exist: a plain figure of
            a person's size replaces the skin.
    """
    collides = any(library_name(plugin.filename) == ACTOR_COLLISIONS_LIBRARY for plugin in actor.plugins)
    links = [
        Link(
            link.name,
            pose=link.pose,
            visuals=link.visuals,
            collisions=link.collisions if collides else (),
            element=link.element,
        )
        for link in actor.links
    ]
    body = tuple(
        Collision(f"{_SKIN_NAME}{index}", shape, RawPose(Pose(position)), element=actor.element)
        for index, (shape, position, _) in enumerate(_PERSON_SHAPES)
        if collides
    )
    if actor.skin is not None and hips is None:
        visuals = tuple(
            Visual(f"{_SKIN_NAME}{index}", shape, RawPose(Pose(position)), material, element=actor.element)
            for index, (shape, position, material) in enumerate(_PERSON_SHAPES)
        )
        links.append(Link(_SKIN_NAME, visuals=visuals, collisions=body, element=actor.element))
    elif actor.skin is not None and hips is not None:
        scale = actor.skin.scale
        x, y, z = (-scale * hip for hip in hips)
        mesh = Mesh(actor.skin.filename, (scale, scale, scale))
        visual = Visual(_SKIN_NAME, mesh, RawPose(Pose((x, y, z))), element=actor.element)
        links.append(Link(_SKIN_NAME, visuals=(visual,), collisions=body, element=actor.element))
    return Model(actor.name, static=True, links=tuple(links), element=actor.element)


def make_road_model(road: Road) -> Model:
    """Return the model of a road: a strip with its top surface at the height of the points."""
    visuals: list[Visual] = []
    for start, end in zip(road.points, road.points[1:], strict=False):
        (x, y, z), (dx, dy, dz) = start, (end[0] - start[0], end[1] - start[1], end[2] - start[2])
        length = hypot(dx, dy, dz)
        if not length or not road.width > 0:
            continue
        middle = (x + dx / 2, y + dy / 2, z + dz / 2 - _ROAD_THICKNESS / 2)
        pose = RawPose(Pose(middle, (0.0, -atan2(dz, hypot(dx, dy)), atan2(dy, dx))))
        visuals.append(Visual(f"part{len(visuals)}", Box((length, road.width, _ROAD_THICKNESS)), pose, _ASPHALT))
        joint_pose = RawPose(Pose((end[0], end[1], end[2] - _ROAD_THICKNESS / 2)))
        visuals.append(Visual(f"part{len(visuals)}", Cylinder(road.width / 2, _ROAD_THICKNESS), joint_pose, _ASPHALT))
    link = Link("link", visuals=tuple(visuals[:-1]), element=road.element)
    return Model(road.name or "road", static=True, links=(link,), element=road.element)
