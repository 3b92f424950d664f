"""A boat with two round hulls and a propeller, and the plugins that float, slow, push and measure it."""

from __future__ import annotations

MASS, HULL_RADIUS, HULL_LENGTH, DENSITY = 150.0, 0.2, 2.5, 1000.0
LINK = "boat::hull"

PROPELLER = (
    '<link name="propeller"><pose>-1.2 0 0 0 0 0</pose><inertial><mass>0.1</mass><inertia><ixx>0.01</ixx>'
    "<iyy>0.01</iyy><izz>0.01</izz></inertia></inertial></link>"
    '<joint name="shaft" type="revolute"><parent>hull</parent><child>propeller</child><axis><xyz>1 0 0</xyz></axis>'
    "</joint>"
    '<plugin name="gz::sim::systems::Thruster" filename="gz-sim-thruster-system"><joint_name>shaft</joint_name>'
    "<propeller_diameter>0.2</propeller_diameter><thrust_coefficient>0.5</thrust_coefficient></plugin>"
)


def hull_plugin(y: float, wavefield: str = "", level: float = 0.0) -> str:
    """Return the plugin of one hull, with two points."""
    return (
        f'<plugin name="vrx::Surface" filename="libSurface.so"><link_name>hull</link_name>'
        f"<hull_length>{HULL_LENGTH}</hull_length><hull_radius>{HULL_RADIUS}</hull_radius>"
        f"<fluid_level>{level}</fluid_level><fluid_density>{DENSITY}</fluid_density>"
        f"<points><point>0.8 {y} 0</point><point>-0.8 {y} 0</point></points>{wavefield}</plugin>"
    )


def drag_plugin(derivatives: str = "") -> str:
    """Return the resistance of the water: zero, but for the given derivatives."""
    names = ("xDotU", "yDotV", "zDotW", "kDotP", "mDotQ", "nDotR", "xU", "yV", "zW", "kP", "mQ", "nR")
    zeros = "".join(f"<{name}>0</{name}>" for name in names if f"<{name}>" not in derivatives)
    return (
        '<plugin name="vrx::SimpleHydrodynamics" filename="libSimpleHydrodynamics.so"><link_name>hull</link_name>'
        f"{derivatives}{zeros}</plugin>"
    )


def boat(pose: str, *plugins: str) -> str:
    """Return the boat with plugins."""
    return (
        f'<model name="boat"><pose>{pose}</pose><link name="hull"><inertial><mass>{MASS}</mass><inertia><ixx>60</ixx>'
        f"<iyy>120</iyy><izz>150</izz></inertia></inertial></link>{''.join(plugins)}</model>"
    )


def two_hulls(wavefield: str = "") -> str:
    """Return the plugins of both hulls."""
    return hull_plugin(0.6, wavefield) + hull_plugin(-0.6, wavefield)
