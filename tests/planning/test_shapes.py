"""The collision shapes of links for planning."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.planning.robot_model import PlacedShape
from linkwright.planning.shapes import scale_shape

pytestmark = pytest.mark.extra("arm")

_POSE = np.array((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0))


def test_parts_of_a_mesh_grow_from_the_same_center() -> None:
    center = np.array((1.0, 0.0, 0.0))
    part = np.array(((2.0, 0.0, 0.0), (3.0, 0.0, 0.0), (2.0, 1.0, 0.0), (2.0, 0.0, 1.0)))
    scaled = scale_shape(PlacedShape(part, _POSE, center), 2.0)
    np.testing.assert_allclose(scaled.shape, center + 2.0 * (part - center))
