"""Objects for sensors to detect, and links that carry sensors."""

from __future__ import annotations

from linkwright.sdf.sensors import Lidar, Sensor
from linkwright.simulation.sensors.mount import Mount
from linkwright.simulation.simulation import Simulation
from tests.simulation.worlds import model

_SIDES = (("east", "3.05 0"), ("west", "-2.05 0"), ("north", "0 4.05"), ("south", "0 -5.05"))
CARRIER = '<model name="carrier"><static>true</static><pose>{pose}</pose><link name="link"/></model>'


def block(name: str, pose: str, size: str, *, retro: float = 0.0, color: str = "1 0 0 1") -> str:
    """Return a fixed box with a collision and a visual."""
    geometry = f"<geometry><box><size>{size}</size></box></geometry>"
    text = f"<laser_retro>{retro}</laser_retro>" if retro else ""
    return (
        f'<model name="{name}"><static>true</static><pose>{pose}</pose><link name="link">'
        f'<collision name="collision">{geometry}{text}</collision>'
        f'<visual name="visual">{geometry}{text}<material><diffuse>{color}</diffuse></material></visual>'
        "</link></model>"
    )


def room() -> str:
    """Return four walls whose inner faces are at x = 3, x = -2, y = 4 and y = -5."""
    return "".join(
        block(name, f"{position} 0 0 0 0", "0.1 20 10" if name in ("east", "west") else "20 0.1 10")
        for name, position in _SIDES
    )


def carrier(pose: str = "0 0 0 0 0 0") -> str:
    """Return a model without shapes for a sensor."""
    return CARRIER.format(pose=pose)


def carrier_mount(simulation: Simulation) -> Mount:
    """Return the mount of a sensor on the carrier."""
    return Mount(simulation, "carrier::link")


def sensor(text: str, kind: str = "lidar") -> Sensor:
    """Return the sensor with this content of its element."""
    holder = model(f'<model name="m"><link name="l"><sensor name="s" type="{kind}">{text}</sensor></link></model>')
    return holder.links[0].sensors[0]


def lidar(text: str) -> Lidar:
    """Return the lidar with this content of its element."""
    element = sensor(f"<lidar>{text}</lidar>").lidar
    assert element is not None
    return element


def single_row_lidar(
    samples: int, low: float, high: float, extra: str = "", *, min_range: float = 0.1, max_range: float = 30.0
) -> Lidar:
    """Return a lidar with one row; angles in rad."""
    return lidar(
        f"<scan><horizontal><samples>{samples}</samples><min_angle>{low}</min_angle><max_angle>{high}</max_angle>"
        f"</horizontal></scan><range><min>{min_range}</min><max>{max_range}</max></range>{extra}"
    )
