"""Convert the lights of a world to the page's form."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.geometry.single import Transform, rotate
from linkwright.page.protocol.worlds import LightScene
from linkwright.sdf.frames import FrameError, Frames, placed_links
from linkwright.sdf.lights import Light
from linkwright.sdf.worlds import World

_DOWN = (0.0, 0.0, -1.0)


def convert_lights(world: World) -> list[LightScene]:
    """Return the lights of a world and of its links that are on.

    A light of the world is omitted if its pose is unknown. If the pose of any link is unknown, the lights of all links
    are omitted.

    Args:
        world: the world, with its includes resolved.
    """
    return [*_convert_world_lights(world), *_convert_link_lights(world)]


def _convert_world_lights(world: World) -> Iterator[LightScene]:
    frames = Frames(world)
    for light in world.lights:
        if light.light_on and (not light.pose.relative_to or light.pose.relative_to in frames):
            yield _convert_light(light, None, frames.placed(light.pose))


def _convert_link_lights(world: World) -> Iterator[LightScene]:
    try:
        links = list(placed_links(world))
    except FrameError:
        return
    for placed_link in links:
        for light in placed_link.link.lights:
            if light.light_on:
                yield _convert_light(
                    light, placed_link.name, placed_link.frames.in_link(light.pose, placed_link.link.name)
                )


def _convert_light(light: Light, link: str | None, pose: Transform) -> LightScene:
    x, y, z = rotate(pose[3:], light.direction)
    length = (x * x + y * y + z * z) ** 0.5
    scene = LightScene(
        kind=light.type,  # type: ignore[arg-type]  # the reader accepts only these types
        link=link,
        position=list(pose[:3]),
        direction=[x / length, y / length, z / length] if length > 0.0 else list(_DOWN),
        color=[light.intensity * channel for channel in light.diffuse[:3]],
        shadows=light.cast_shadows,
    )
    if light.type != "directional":
        attenuation = light.attenuation
        scene.range = attenuation.range
        scene.fading = [attenuation.constant, attenuation.linear, attenuation.quadratic]
    if light.type == "spot" and light.spot is not None:
        scene.cone = [light.spot.inner_angle, light.spot.outer_angle]
    return scene
