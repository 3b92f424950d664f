"""Four wheels with a differential drive: they slip in every turn."""

from __future__ import annotations

from math import pi

import pytest

from linkwright.control.odometry import get_yaw
from tests.simulation.test_movers import drive
from tests.simulation.test_plugins import running_server
from tests.simulation.worlds import GROUND, box

WHEEL_RADIUS, TRACK_WIDTH = 0.1, 0.4
SIDES = tuple((end, side) for end in ("front", "back") for side in ("left", "right"))


def skid_robot(length: float, surface: str = "") -> str:
    """Return a robot of 9 kg with four wheels; the length is the distance of its axles."""
    text = box("robot", "0 0 0.2 0 0 0", "0.6 0.3 0.1", 5.0)
    for end, side in SIDES:
        x, y = (
            (length / 2 if end == "front" else -length / 2),
            (TRACK_WIDTH / 2 if side == "left" else -TRACK_WIDTH / 2),
        )
        wheel = (
            f'<link name="{end}_{side}"><pose>{x} {y} -0.1 {pi / 2} 0 0</pose><inertial><mass>1</mass><inertia>'
            '<ixx>0.003</ixx><iyy>0.003</iyy><izz>0.005</izz></inertia></inertial><collision name="c"><geometry>'
            f"<cylinder><radius>{WHEEL_RADIUS}</radius><length>0.05</length></cylinder></geometry>{surface}</collision></link>"
            f'<joint name="{end}_{side}_joint" type="revolute"><parent>link</parent><child>{end}_{side}</child>'
            '<axis><xyz expressed_in="__model__">0 1 0</xyz></axis></joint>'
        )
        text = text.replace("</model>", f"{wheel}</model>")
    joints = "".join(f"<{side}_joint>{end}_{side}_joint</{side}_joint>" for end, side in SIDES)
    sizes = f"<wheel_separation>{TRACK_WIDTH}</wheel_separation><wheel_diameter>{2 * WHEEL_RADIUS}</wheel_diameter>"
    plugin = f'<plugin name="drive" filename="libgazebo_ros_diff_drive.so"><num_wheel_pairs>2</num_wheel_pairs>{joints}'
    return text.replace("</model>", f"{plugin}{sizes}</plugin></model>")


def friction_element(mu: float, mu2: float) -> str:
    """Return a surface."""
    return f"<surface><friction><ode><mu>{mu}</mu><mu2>{mu2}</mu2></ode></friction></surface>"


@pytest.mark.parametrize(
    "surface", ["", friction_element(100.0, 50.0), friction_element(1.0, 0.05)], ids=["default", "rubber", "mu2"]
)
@pytest.mark.parametrize("length", [0.2, 0.4])
async def test_skid_steering_turn_rate_matches_coulomb_friction(length, surface):
    async with running_server(GROUND, skid_robot(length, surface)) as (server, graph, log):
        await drive(server, graph, yaw_rate=0.5, seconds=1.0)
        begin = get_yaw(server.simulation.model_pose("robot"))
        await drive(server, graph, yaw_rate=0.5, seconds=1.0)
        share = (get_yaw(server.simulation.model_pose("robot")) - begin) / 0.5
        expected = TRACK_WIDTH**2 / (TRACK_WIDTH**2 + length**2)
        assert 0.8 * expected < share < 1.05 * expected
        assert not log


@pytest.mark.parametrize("surface", ["", friction_element(1.0, 0.05)], ids=["default", "mu2"])
async def test_skid_steering_drives_straight(surface):
    async with running_server(GROUND, skid_robot(0.4, surface)) as (server, graph, log):
        await drive(server, graph, 0.5, seconds=1.0)
        begin = server.simulation.model_pose("robot")
        await drive(server, graph, 0.5, seconds=1.0)
        end = server.simulation.model_pose("robot")
        assert end[0] - begin[0] == pytest.approx(0.5, abs=0.01)
        assert (end[1], get_yaw(end)) == pytest.approx((0.0, 0.0), abs=1e-3)
        assert not log
