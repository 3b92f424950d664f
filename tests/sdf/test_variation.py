"""Variation of masses, friction and noise."""

from linkwright.sdf.variation import with_friction, with_mass, with_noise
from tests.simulation.worlds import model

TEXT = """<model name="outer"><link name="bare"/>
<model name="inner"><link name="link"><inertial><mass>2</mass>
<inertia><ixx>0.1</ixx><iyy>0.2</iyy><izz>0.3</izz></inertia></inertial>
<collision name="c"><geometry><sphere><radius>1</radius></sphere></geometry></collision>
<sensor name="s" type="imu"><imu><linear_acceleration><x><noise type="gaussian"><mean>1</mean><stddev>0.5</stddev>
<dynamic_bias_correlation_time>300</dynamic_bias_correlation_time></noise></x></linear_acceleration></imu></sensor>
</link></model></model>"""


def test_mass_and_inertia_scale_together():
    scaled_text = with_mass(model(TEXT), 2.0)
    assert scaled_text.links[0].inertial.mass == 2.0
    inertial = scaled_text.models[0].links[0].inertial
    assert (inertial.mass, inertial.inertia.ixx, inertial.inertia.izz) == (4.0, 0.2, 0.6)


def test_friction_applies_to_all_collisions():
    friction = with_friction(model(TEXT), 0.3).models[0].links[0].collisions[0].surface.friction
    assert (friction.mu, friction.mu2) == (0.3, 0.3)


def test_noise_scales_and_correlation_time_stays():
    noise = with_noise(model(TEXT), 4.0).models[0].links[0].sensors[0].imu.linear_acceleration.x
    assert (noise.mean, noise.stddev, noise.dynamic_bias_correlation_time) == (4.0, 2.0, 300.0)


def test_model_without_friction_and_noise_is_unchanged():
    crate = model('<model name="crate"><link name="link"/></model>')
    assert with_friction(crate, 0.5) is crate
    assert with_noise(crate, 0.5) == crate
