"""The volume of shapes below a plane, for any orientation."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.geometry.arrays import rotation_matrix
from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.simulation.plugins.fluids.displacement import Solid, create_shape_triangles

SHAPES = (Box((1.0, 2.0, 0.5)), Cylinder(0.4, 1.2), Sphere(0.7), Capsule(0.3, 0.9))
UPSIDE_DOWN = np.diag((1.0, -1.0, -1.0))


def solid_of(shape) -> Solid:
    triangles = create_shape_triangles(shape)
    assert triangles is not None
    solid = Solid.from_triangles(triangles + np.array((0.1, -0.2, 0.3)))
    assert solid is not None
    return solid


@pytest.mark.parametrize("shape", SHAPES)
def test_parts_below_and_above_make_up_the_shape(shape):
    """The part above is the part below of the shape turned upside down."""
    solid, random = solid_of(shape), np.random.default_rng(5)
    for _ in range(50):
        quaternion = random.standard_normal(4)
        rotation, position = rotation_matrix(quaternion / np.linalg.norm(quaternion)), random.uniform(-1, 1, 3)
        height = float((rotation @ solid.total.center + position)[2] + random.uniform(-0.4, 0.4))
        below = solid.volume_below(height, rotation, position)
        above = solid.volume_below(-height, UPSIDE_DOWN @ rotation, UPSIDE_DOWN @ position)
        assert below.size + above.size == pytest.approx(solid.total.size)
        moment = below.size * below.center + above.size * (UPSIDE_DOWN @ above.center)
        assert moment / solid.total.size == pytest.approx(rotation @ solid.total.center + position, abs=1e-9)
        assert below.center[2] < height < (UPSIDE_DOWN @ above.center)[2]


def test_tilted_box_is_cut_into_a_prism():
    """A cube on its edge, immersed to a depth d, displaces d2 for each meter of the edge, centered 2 d / 3 deep."""
    solid = Solid.from_triangles(create_shape_triangles(Box((1.0, 1.0, 1.0))))
    assert solid is not None
    half = np.sqrt(0.5)
    rotation = np.array([[1.0, 0.0, 0.0], [0.0, half, -half], [0.0, half, half]])
    for depth in (0.1, 0.5, half):
        volume = solid.volume_below(0.0, rotation, np.array((0.0, 0.0, half - depth)))
        assert volume.size == pytest.approx(depth**2)
        assert volume.center == pytest.approx((0.0, 0.0, -depth / 3), abs=1e-9)
