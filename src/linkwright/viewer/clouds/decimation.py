"""Fewer points of a cloud for a slow line."""

from __future__ import annotations

from dataclasses import replace

from linkwright.viewer.protocol import CloudPoints


def decimated(cloud: CloudPoints, size: int) -> CloudPoints:
    """Every k-th point, so that the arrays have at most so many bytes; at least one point is left."""
    whole = cloud.positions.nbytes + cloud.colours.nbytes
    step = -(-whole // max(1, size))
    if step <= 1:
        return cloud
    return replace(cloud, positions=cloud.positions[::step], colours=cloud.colours[::step], step=step)
