"""Bodies under water: buoyancy, added mass, damping and currents against their formulas."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.simulation.server.server import ServerOptions
from tests.simulation.fluids.server import running_server, weightless_server
from tests.simulation.test_plugins import SECOND_NS

LINK = "uuv::base_link"
MASS = 1000.0
TWIST = "geometry_msgs/msg/TwistStamped"


def water(parts: str, density: float = 1000.0, more: str = "") -> str:
    return (
        '<plugin name="w" filename="libuuv_underwater_object_ros_plugin.so">'
        f"<fluid_density>{density}</fluid_density><flow_velocity_topic>hydrodynamics/current_velocity"
        f'</flow_velocity_topic>{more}<link name="base_link">{parts}</link></plugin>'
    )


def model_of(parts: str = "", kind: str = "fossen") -> str:
    return f"<hydrodynamic_model><type>{kind}</type>{parts}</hydrodynamic_model>"


def vehicle(pose: str, *plugins: str, mass: float = MASS, center: str = "0 0 0") -> str:
    return (
        f'<model name="uuv"><pose>{pose}</pose><link name="base_link"><inertial><pose>{center} 0 0 0</pose>'
        f"<mass>{mass}</mass><inertia><ixx>100</ixx><iyy>100</iyy><izz>100</izz></inertia></inertial></link>"
        f"{''.join(plugins)}</model>"
    )


BOX = "<box><width>2</width><length>1</length><height>1</height></box>"
DAMPING = model_of("<linear_damping>-2000 -2000 -2000 -300 -300 -300</linear_damping>")


def velocity(server) -> np.ndarray:
    return np.array(server.simulation.link_velocity(LINK)[0])


async def test_vehicle_floats_at_share_of_its_height():
    """Of 2 m3, 1.6 m3 displace 1,600 kg: 80 % of the height of 1 m is under water."""
    parts = water(f"<volume>2</volume>{BOX}{DAMPING}")
    async with running_server(vehicle("0 0 -3 0 0 0", parts, mass=1600.0)) as (server, _, log):
        server.advance(30 * SECOND_NS)
        assert server.simulation.link_pose(LINK)[2] == pytest.approx(0.5 - 0.8, abs=0.002)
        assert not log


async def test_heave_has_period_of_mass_and_waterplane():
    """The waterplane is the volume divided by the height."""
    async with running_server(vehicle("0 0 0.05 0 0 0", water(f"<volume>2</volume>{BOX}{model_of()}")), step=0.001) as (
        server,
        _,
        __,
    ):
        heights = []
        for _ in range(600):
            server.advance(SECOND_NS // 100)
            heights.append(server.simulation.link_pose(LINK)[2])
    rising = [index for index in range(1, len(heights)) if heights[index - 1] < 0.0 <= heights[index]]
    assert np.diff(rising).mean() / 100 == pytest.approx(2 * pi * sqrt(MASS / (1000 * 9.81 * 2.0)), rel=0.01)


async def test_body_above_surface_sinks_in_uuv_simulator():
    parts = water(f"<volume>4</volume>{BOX}{DAMPING}")
    for mistakes, height in ((False, 0.25), (True, 0.0)):
        options = ServerOptions(gazebo_mistakes=mistakes)
        async with running_server(vehicle("0 0 -1 0 0 0", parts), options=options) as (server, _, __):
            server.advance(30 * SECOND_NS)
            assert server.simulation.link_pose(LINK)[2] == pytest.approx(height, abs=0.06)


async def test_neutral_vehicle_hangs_and_rights_itself_by_its_center_of_buoyancy():
    parts = water(
        f"<neutrally_buoyant>1</neutrally_buoyant><center_of_buoyancy>0 0 0.3</center_of_buoyancy>{BOX}{DAMPING}"
    )
    async with running_server(vehicle("0 0 -10 0.3 0.2 0", parts)) as (server, _, __):
        server.advance(30 * SECOND_NS)
        assert server.simulation.link_pose(LINK)[2] == pytest.approx(-10.0, abs=0.01)
        assert server.simulation.data.xmat[server.simulation.body(LINK)][8] > 0.9999


async def test_righting_has_period_of_metacentric_height():
    """The period of a small roll is 2 pi sqrt(I / (rho g V h))."""
    parts = water(
        f"<neutrally_buoyant>1</neutrally_buoyant><center_of_buoyancy>0 0 0.3</center_of_buoyancy>{BOX}{model_of()}"
    )
    async with running_server(vehicle("0 0 -10 0.05 0 0", parts), step=0.001) as (server, _, __):
        rolls = []
        for _ in range(600):
            server.advance(SECOND_NS // 100)
            rolls.append(server.simulation.link_pose(LINK)[3])
    rising = [index for index in range(1, len(rolls)) if rolls[index - 1] < 0.0 <= rolls[index]]
    assert np.diff(rising).mean() / 100 == pytest.approx(2 * pi * sqrt(100 / (MASS * 9.81 * 0.3)), rel=0.02)


async def test_surface_vessel_has_its_draught_and_metacentric_heights():
    vessel = (
        "<submerged_height>0.3</submerged_height><metacentric_width>0.5</metacentric_width>"
        f"<metacentric_length>2</metacentric_length>{BOX}{DAMPING}"
    )
    async with running_server(vehicle("0 0 0.2 0.1 0.05 0", water(vessel))) as (server, _, log):
        wrench = server.simulation.data.xfrc_applied[server.simulation.body(LINK)]
        lift = MASS / (1000 * 0.3) * 0.3 * 1000 * 9.81
        assert wrench[2] == pytest.approx(lift, rel=1e-6)
        assert wrench[3:5] == pytest.approx([-0.5 * np.sin(0.1) * lift, -2 * np.sin(0.05) * lift], rel=0.02)
        server.advance(30 * SECOND_NS)
        assert 0.5 - server.simulation.link_pose(LINK)[2] == pytest.approx(0.3, abs=0.001)
        assert server.simulation.data.xmat[server.simulation.body(LINK)][8] > 0.9999
        assert not log


@pytest.mark.parametrize(
    ("coefficients", "expected"),
    [
        ("<linear_damping>-50 0 0 0 0 0</linear_damping>", 2.0),
        ("<quadratic_damping>-25 0 0 0 0 0</quadratic_damping>", 2.0),
        ("<linear_damping_forward_speed>-25 0 0 0 0 0</linear_damping_forward_speed>", 2.0),
        ("<linear_damping>" + "-50 " + "0 " * 35 + "</linear_damping>", 2.0),
    ],
)
async def test_vehicle_reaches_speed_at_which_damping_equals_force(coefficients, expected):
    body = vehicle("0 0 -10 0 0 0", water(model_of(coefficients)), mass=100.0)
    async with weightless_server(body) as (server, _, log):
        server.simulation.push(LINK, (100.0, 0.0, 0.0), by="test")
        server.advance(30 * SECOND_NS)
        assert velocity(server)[0] == pytest.approx(expected, rel=0.005)
        assert not log


async def test_added_mass_is_that_of_axes_forward_right_down():
    """A force along x accelerates a coupled body along y to the left, where y points right in the description."""
    matrix = np.diag([500.0, 200.0, 300.0, 10.0, 10.0, 10.0])
    matrix[0, 1] = matrix[1, 0] = 100.0
    numbers = " ".join(str(value) for value in matrix.ravel())
    async with weightless_server(
        vehicle("0 0 -10 0 0 0", water(model_of(f"<added_mass>{numbers}</added_mass>"))), step=0.001
    ) as (server, _, __):
        server.simulation.push(LINK, (100.0, 0.0, 0.0), by="test")
        server.advance(SECOND_NS // 5)
        inertia = MASS * np.eye(2) + np.array([[500.0, -100.0], [-100.0, 200.0]])
        assert velocity(server)[:2] / 0.2 == pytest.approx(np.linalg.solve(inertia, [100.0, 0.0]), rel=0.01)


@pytest.mark.parametrize(
    ("kind", "parameters", "added_mass", "drag"),
    [
        ("sphere", "<radius>0.5</radius>", 2 / 3 * 1000 * pi * 0.125, 0.5 * 1000 * 0.5 * pi * 0.25),
        ("box", "<length>2</length><width>1</width><height>0.5</height><cd>0.8</cd>", 0.0, 0.5 * 1000 * 0.8 * 0.5),
        (
            "cylinder",
            "<radius>0.25</radius><length>3</length><axis>k</axis>",
            1000 * pi * 0.0625 * 3,
            0.5 * 1000 * 0.82 * 0.25 * 3,
        ),
    ],
)
async def test_simple_shapes_have_their_added_mass_and_drag(kind, parameters, added_mass, drag):
    body = vehicle("0 0 -10 0 0 0", water(f"{BOX}{model_of(parameters, kind)}"))
    async with weightless_server(body, step=0.001) as (server, _, log):
        server.simulation.push(LINK, (50.0, 0.0, 0.0), by="test")
        server.advance(SECOND_NS // 10)
        assert velocity(server)[0] / 0.1 == pytest.approx(50.0 / (MASS + added_mass), rel=0.02)
        server.simulation.push(LINK, (4 * drag, 0.0, 0.0), by="test")
        server.advance(15 * SECOND_NS)  # nine times the longest time constant
        assert velocity(server)[0] == pytest.approx(2.0, rel=0.01)
        assert not log


@pytest.mark.parametrize("follows", [True, False])
async def test_vehicle_drifts_with_current_unless_told_not_to(follows):
    more = f"<use_global_current>{str(follows).lower()}</use_global_current>"
    async with weightless_server(vehicle("0 0 -10 0 0 0", water(DAMPING, more=more))) as (server, graph, _):
        message = get_message(TWIST)()
        message.twist.linear.x, message.twist.linear.y = 0.5, -0.25
        graph.create_node("sea").create_publisher(TWIST, "/hydrodynamics/current_velocity", 10).publish(message)
        await graph.settle()
        server.advance(10 * SECOND_NS)
        assert velocity(server)[:2] == pytest.approx([0.5, -0.25] if follows else [0.0, 0.0], abs=0.005)


@pytest.mark.parametrize(
    ("parts", "text"),
    [
        (model_of(kind="submarine"), "must be fossen, sphere, cylinder or box"),
        (model_of("<added_mass>1 2 3</added_mass>"), "<hydrodynamic_model> needs 36 numbers in <added_mass>"),
        (model_of("<linear_damping>much</linear_damping>"), "needs 36 numbers in <linear_damping>"),
        ("<center_of_buoyancy>0 1</center_of_buoyancy>", "<link> needs 3 numbers in <center_of_buoyancy>"),
        ("<volume>big</volume>", "<link> needs a number in <volume>"),
        (model_of(kind="sphere"), "<hydrodynamic_model> needs a number greater than 0 in <radius>"),
    ],
)
async def test_invalid_parameters_are_reported(parts, text):
    async with running_server(vehicle("0 0 0 0 0 0", water(parts))) as (_, __, log):
        assert any(text in record.text for record in log), [record.text for record in log]
