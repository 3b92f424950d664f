"""Mass and inertia of a link as the page draws them."""

from __future__ import annotations

import numpy as np

from linkwright.geometry.arrays import quaternion_from_matrix
from linkwright.urdf import Inertial
from linkwright.viewer.protocol.description import LinkInertia


def link_inertia(inertial: Inertial | None) -> LinkInertia | None:
    """Mass, centre of mass and equivalent box of a link; None without numbers that can be drawn."""
    if inertial is None:
        return None
    from linkwright.inertia.inertial import (
        from_inertial,  # the room of inertias is for those who ask for one
        is_computable,
    )

    if not is_computable(inertial):
        return None
    properties = from_inertial(inertial)
    box = properties.equivalent_box()
    edges = [] if box is None or not np.isfinite(box).all() else [float(edge) for edge in box]
    axes = properties.principal().axes if edges else np.eye(3)
    return LinkInertia(
        mass=float(properties.mass),
        center=[float(part) for part in properties.center],
        box=edges,
        quaternion=[float(part) for part in quaternion_from_matrix(axes)],
    )
