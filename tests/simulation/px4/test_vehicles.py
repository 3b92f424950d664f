"""Vehicles under water of PX4: lift, its layer at the surface, damping and Coriolis forces against their formulas."""

from __future__ import annotations

import numpy as np
import pytest

from tests.simulation.fluids.server import running_server, weightless_server
from tests.simulation.test_plugins import SECOND_NS

MASS = 10.0


def vehicle(z: float, parameters: str, mass: float = MASS) -> str:
    return (
        f'<model name="hippo"><pose>0 0 {z} 0 0 0</pose><link name="base_link"><inertial><mass>{mass}</mass><inertia>'
        f"<ixx>{mass}</ixx><iyy>{mass}</iyy><izz>{mass}</izz></inertia></inertial></link>"
        '<plugin name="uuv" filename="libgazebo_uuv_plugin.so"><robotNamespace/><baseLinkName>base_link</baseLinkName>'
        f"{parameters}</plugin></model>"
    )


def lift(factor: float, origin: str = "0 0 0") -> str:
    return (
        f"<buoyancy><link_name>base_link</link_name><origin>{origin}</origin><compensation>{factor}</compensation>"
        "<height_scale_limit>0.1</height_scale_limit></buoyancy>"
    )


def wrench(server) -> np.ndarray:
    simulation = server.simulation
    return simulation.data.xfrc_applied[simulation.body("hippo::base_link")].copy()


@pytest.mark.parametrize(("z", "share"), [(-5.0, 1.0), (-0.1, 1.0), (0.0, 0.5), (0.05, 0.25), (0.2, 0.0)])
async def test_lift_falls_in_the_layer_at_the_surface(z, share):
    async with running_server(vehicle(z, lift(1.1))) as (server, _, log):
        server.advance(SECOND_NS // 100)
        assert wrench(server)[2] == pytest.approx(1.1 * MASS * 9.81 * share, rel=0.01, abs=0.6)
        assert not log, [record.text for record in log]


async def test_lift_above_the_center_of_mass_rights_the_vehicle():
    async with running_server(vehicle(-5.0, lift(1.0, "0.2 0 0"))) as (server, _, __):
        server.advance(SECOND_NS // 100)
        assert wrench(server)[4] == pytest.approx(-0.2 * MASS * 9.81, rel=0.01)


async def test_damped_vehicle_slows_exponentially():
    async with weightless_server(vehicle(-5.0, "<dampingLinear>5 0 0</dampingLinear>"), step=0.001) as (server, _, __):
        server.advance(SECOND_NS // 1000)
        server.simulation.set_model_velocity("hippo", (2.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        server.advance(2 * SECOND_NS)
        speed = server.simulation.link_velocity("hippo::base_link")[0][0]
        assert speed == pytest.approx(2.0 * np.exp(-1.0), rel=0.01)


async def test_added_mass_couples_the_motions():
    text = vehicle(-5.0, "<addedMassLinear>3 4 5</addedMassLinear><addedMassAngular>6 7 8</addedMassAngular>", 1e6)
    linear, angular = np.array((1.0, -0.5, 0.2)), np.array((0.1, 0.3, -0.2))
    async with weightless_server(text) as (server, _, __):
        server.simulation.set_model_velocity("hippo", tuple(linear), tuple(angular))
        server.advance(SECOND_NS // 100)
        momentum, spin = np.array((3.0, 4.0, 5.0)) * linear, np.array((6.0, 7.0, 8.0)) * angular
        torque = -np.cross(momentum, linear) - np.cross(spin, angular)
        assert wrench(server) == pytest.approx((*-np.cross(momentum, angular), *torque), rel=0.02, abs=0.02)
