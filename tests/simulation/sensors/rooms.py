"""Things that sensors see, and links to put sensors on."""

from __future__ import annotations

from linkwright.sdf.sensors import Lidar, Sensor
from linkwright.simulation.sensors.mount import Mount
from linkwright.simulation.simulation import Simulation
from tests.simulation.worlds import model

_SIDES = (("east", "3.05 0"), ("west", "-2.05 0"), ("north", "0 4.05"), ("south", "0 -5.05"))
CARRIER = '<model name="carrier"><static>true</static><pose>{pose}</pose><link name="link"/></model>'


def block(name: str, pose: str, size: str, *, retro: float = 0.0, color: str = "1 0 0 1") -> str:
    """A box that stands still, is seen and touched."""
    geometry = f"<geometry><box><size>{size}</size></box></geometry>"
    text = f"<laser_retro>{retro}</laser_retro>" if retro else ""
    return (
        f'<model name="{name}"><static>true</static><pose>{pose}</pose><link name="link">'
        f'<collision name="collision">{geometry}{text}</collision>'
        f'<visual name="visual">{geometry}{text}<material><diffuse>{color}</diffuse></material></visual>'
        "</link></model>"
    )


def room() -> str:
    """Four walls whose insides are at x = 3, x = -2, y = 4 and y = -5."""
    return "".join(
        block(name, f"{place} 0 0 0 0", "0.1 20 10" if name in ("east", "west") else "20 0.1 10")
        for name, place in _SIDES
    )


def carrier(pose: str = "0 0 0 0 0 0") -> str:
    """A model without shapes that carries a sensor."""
    return CARRIER.format(pose=pose)


def on_carrier(simulation: Simulation) -> Mount:
    """The place of the sensor on it."""
    return Mount(simulation, "carrier::link")


def sensor(text: str, kind: str = "lidar") -> Sensor:
    """A sensor, from what stands in its element."""
    holder = model(f'<model name="m"><link name="l"><sensor name="s" type="{kind}">{text}</sensor></link></model>')
    return holder.links[0].sensors[0]


def lidar(text: str) -> Lidar:
    """A lidar, from what stands in its element."""
    shown = sensor(f"<lidar>{text}</lidar>").lidar
    assert shown is not None
    return shown


def flat(samples: int, low: float, high: float, rest: str = "", *, near: float = 0.1, far: float = 30.0) -> Lidar:
    """A lidar of one plane; angles in rad."""
    return lidar(
        f"<scan><horizontal><samples>{samples}</samples><min_angle>{low}</min_angle><max_angle>{high}</max_angle>"
        f"</horizontal></scan><range><min>{near}</min><max>{far}</max></range>{rest}"
    )
