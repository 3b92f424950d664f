"""Bodies that float: draught, period and stability against their formulas."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

from linkwright.simulation.plugins.water import WaterSurface
from tests.simulation.fluids.server import running_server
from tests.simulation.test_plugins import SECOND_NS
from tests.simulation.worlds import box, model

WATER_AND_AIR = (
    '<plugin name="gz::sim::systems::Buoyancy" filename="gz-sim-buoyancy-system"><graded_buoyancy>'
    "<default_density>1000</default_density><density_change><above_depth>{surface}</above_depth><density>0</density>"
    "</density_change></graded_buoyancy>{extra}</plugin>"
)
DAMPING = (
    '<plugin name="gz::sim::systems::Hydrodynamics" filename="gz-sim-hydrodynamics-system"><link_name>link</link_name>'
    "<xU>-2000</xU><yV>-2000</yV><zW>-2000</zW><kP>-300</kP><mQ>-300</mQ><nR>-300</nR></plugin>"
)


def buoyancy_plugin(surface: float = 0.0, extra: str = "") -> str:
    return WATER_AND_AIR.format(surface=surface, extra=extra)


def floating_model(shape: str, volume: float, pose: str, density: float = 500.0, plugin: str = DAMPING) -> str:
    """Return a model of this density, whose motion dies out."""
    mass = density * volume
    inertia = "".join(f"<{name}>{mass / 6}</{name}>" for name in ("ixx", "iyy", "izz"))
    return (
        f'<model name="float"><pose>{pose}</pose><link name="link"><inertial><mass>{mass}</mass><inertia>{inertia}'
        f'</inertia></inertial><collision name="collision"><geometry>{shape}</geometry></collision></link>{plugin}'
        "</model>"
    )


def link_height(server, link: str = "float::link") -> float:
    return server.simulation.link_pose(link)[2]


@pytest.mark.parametrize(
    ("shape", "volume", "draught"),
    [
        ("<box><size>1 2 0.4</size></box>", 0.8, 0.2),
        ("<sphere><radius>0.5</radius></sphere>", 4 / 3 * pi * 0.125, 0.5),
        ("<cylinder><radius>0.5</radius><length>0.4</length></cylinder>", pi * 0.25 * 0.4, 0.2),
        ("<capsule><radius>0.3</radius><length>0.6</length></capsule>", pi * 0.09 * (0.6 + 0.4), 0.6),
        ("<ellipsoid><radii>0.6 0.4 0.3</radii></ellipsoid>", 4 / 3 * pi * 0.6 * 0.4 * 0.3, 0.3),
    ],
)
async def test_body_of_half_density_of_water_is_half_immersed(shape, volume, draught):
    async with running_server(buoyancy_plugin(surface=1.0), floating_model(shape, volume, "0 0 1.1 0 0 0")) as (
        server,
        _,
        log,
    ):
        server.advance(10 * SECOND_NS)
        assert link_height(server) == pytest.approx(1.0, abs=0.002)
        assert not log


async def test_draught_follows_density_of_box():
    shape = "<box><size>1 1 0.4</size></box>"
    async with running_server(buoyancy_plugin(), floating_model(shape, 0.4, "0 0 0.2 0 0 0", density=900.0)) as (
        server,
        _,
        __,
    ):
        server.advance(10 * SECOND_NS)
        assert link_height(server) == pytest.approx(0.2 - 0.9 * 0.4, abs=0.001)


async def test_heave_has_period_of_mass_and_waterplane():
    """Without damping, the period is 2 pi sqrt(m / (rho g A))."""
    shape = "<box><size>1 1 0.4</size></box>"
    async with running_server(buoyancy_plugin(), floating_model(shape, 0.4, "0 0 0.05 0 0 0", plugin="")) as (
        server,
        _,
        __,
    ):
        heights = []
        for _ in range(400):
            server.advance(SECOND_NS // 100)
            heights.append(link_height(server))
    rising = [index for index in range(1, len(heights)) if heights[index - 1] < 0.0 <= heights[index]]
    periods = np.diff(rising) / 100
    assert len(periods) >= 2
    assert periods.mean() == pytest.approx(2 * pi * sqrt(200 / (1000 * 9.81 * 1.0)), rel=0.01)


async def test_flat_box_rights_itself_and_tall_box_capsizes():
    """The metacentric height of a box of half the density of water is b2 / (6 h) - h / 4."""
    flat_box = floating_model("<box><size>1 1 0.4</size></box>", 0.4, "0 0 0 0.2 0 0")
    tall = floating_model("<box><size>0.3 0.3 1</size></box>", 0.09, "0 0 0 0.2 0 0")
    for body, is_stable in ((flat_box, True), (tall, False)):
        async with running_server(buoyancy_plugin(), body) as (server, _, __):
            server.advance(20 * SECOND_NS)
            simulation = server.simulation
            up_component = simulation.data.xmat[simulation.body("float::link")].reshape(3, 3)[2, 2]
            assert bool(up_component > 0.999) is is_stable, up_component


async def test_uniform_fluid_lifts_only_enabled_bodies():
    plugin = (
        '<plugin name="b" filename="gz-sim-buoyancy-system"><uniform_fluid_density>500</uniform_fluid_density>'
        "<enable>light</enable></plugin>"
    )
    parts = box("light", "0 0 5 0 0 0", mass=250.0), box("heavy", "5 0 5 0 0 0", mass=250.0)
    async with running_server(plugin, *parts) as (server, _, log):
        server.advance(SECOND_NS // 2)
        velocity, _ = server.simulation.link_velocity("light::link")
        assert velocity[2] == pytest.approx((500 / 250 - 1) * 9.81 * 0.5, rel=0.01)
        velocity, _ = server.simulation.link_velocity("heavy::link")
        assert velocity[2] == pytest.approx(-9.81 * 0.5, rel=0.01)
        assert not log


async def test_lift_follows_gravity_and_ends_with_plugin():
    plugin = '<plugin name="b" filename="gz-sim-buoyancy-system"/>'
    async with running_server(plugin, box("float", "0 0 5 0 0 0", mass=500.0)) as (server, _, __):
        server.simulation.set_gravity((0.0, 0.0, -1.62))
        server.advance(SECOND_NS // 100)
        start, _ = server.simulation.link_velocity("float::link")
        server.advance(SECOND_NS)
        velocity, _ = server.simulation.link_velocity("float::link")
        assert velocity[2] - start[2] == pytest.approx((1000 / 500 - 1) * 1.62, rel=0.01)
        assert server.simulation.data.body("float::link").xfrc_applied[2] == pytest.approx(1000 * 1.62)
    assert not server.simulation.data.body("float::link").xfrc_applied.any()


async def test_body_that_is_spawned_later_floats_too():
    async with running_server(buoyancy_plugin()) as (server, _, __):
        server.advance(SECOND_NS)
        server.simulation.spawn(model(floating_model("<box><size>1 1 0.4</size></box>", 0.4, "0 0 0 0 0 0")), "float")
        server.advance(5 * SECOND_NS)
        assert link_height(server) == pytest.approx(0.0, abs=0.01)


async def test_classic_plugin_lifts_model_by_stated_volume():
    plugin = (
        '<plugin name="b" filename="libBuoyancyPlugin.so"><fluid_density>1000</fluid_density>'
        '<link name="link"><center_of_volume>0 0 0.1</center_of_volume><volume>0.5</volume></link></plugin>'
    )
    part = box("float", "0 0 5 0 0 0", mass=250.0).replace("</model>", f"{plugin}</model>")
    async with running_server(part) as (server, _, log):
        server.advance(SECOND_NS // 2)
        velocity, _ = server.simulation.link_velocity("float::link")
        assert velocity[2] == pytest.approx(9.81 * 0.5, rel=0.01)
        assert not log


@pytest.mark.parametrize(
    ("plugin", "message"),
    [
        (
            buoyancy_plugin().replace("<density>0</density>", "<density>air</density>"),
            "<density_change> needs a number in <density>",
        ),
        (
            buoyancy_plugin().replace("<above_depth>0.0</above_depth>", ""),
            "<density_change> needs a number in <above_depth>",
        ),
    ],
)
async def test_invalid_layer_is_reported(plugin, message):
    async with running_server(plugin) as (_, __, log):
        assert any(message in record.text for record in log), [record.text for record in log]


UNIFORM = '<plugin name="gz::sim::systems::Buoyancy" filename="gz-sim-buoyancy-system"/>'
OIL = "<density_change><above_depth>0.2</above_depth><density>800</density></density_change></graded_buoyancy>"


@pytest.mark.parametrize(
    ("plugin", "level"),
    [
        (buoyancy_plugin(surface=1.5), 1.5),
        (buoyancy_plugin(surface=1.5).replace("</graded_buoyancy>", OIL), 1.5),
        (UNIFORM, None),
    ],
)
async def test_water_has_level_only_if_something_lighter_is_above(plugin, level):
    async with running_server(plugin) as (server, _, __):
        water = server.find_water()
        assert water == (None if level is None else WaterSurface(level))
