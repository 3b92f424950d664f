"""Octrees as OctoMap writes them."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.rviz.displays.moveit.octree import BadOctreeError, read_octree
from linkwright.rviz.displays.moveit.voxels import make_octomap_markers

IDENTITY = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
FREE, OCCUPIED, INNER = 1, 2, 3


def tree_node(**children: int) -> bytes:
    """Return an inner node of the binary form with children c0 to c7."""
    bits = sum(state << 2 * int(name[1:]) for name, state in children.items())
    return struct.pack("<H", bits)


def read(data: bytes, *, binary: bool = True, kind: str = "OcTree", resolution: float = 0.5):
    return read_octree(data=data, binary=binary, kind=kind, resolution=resolution)


def test_smallest_cells_have_resolution_and_are_next_to_origin():
    # Child 7 of the root, then child 0 at each level: the corner of the first octant that is nearest to the origin.
    data = tree_node(c7=INNER) + tree_node(c0=INNER) * 14 + tree_node(c0=OCCUPIED, c1=FREE)
    cells = read(data)
    assert cells.sizes.tolist() == [0.5, 0.5]
    by_place = dict(zip(map(tuple, cells.centers.tolist()), cells.probabilities.tolist(), strict=True))
    assert by_place == pytest.approx({(0.25, 0.25, 0.25): 0.971, (0.75, 0.25, 0.25): 0.1192})


def test_leaf_near_root_is_a_large_cell():
    cells = read(tree_node(c0=OCCUPIED))
    assert cells.sizes.tolist() == [0.5 * 2**15]
    assert cells.centers.tolist() == [[-0.5 * 2**14] * 3]


def test_full_octree_has_probability_of_each_leaf():
    inner_node, leaf_node = struct.pack("<fB", 0.0, 0b0000_0011), struct.pack("<fB", 0.0, 0)
    certain_leaf = struct.pack("<fB", 2.0, 0)
    cells = read(inner_node + leaf_node + certain_leaf, binary=False)
    assert cells.probabilities.tolist() == pytest.approx([0.5, 0.8808], abs=1e-4)
    assert cells.centers[:, 0].tolist() == [-0.5 * 2**14, 0.5 * 2**14]


def test_color_octree_is_read():
    cells = read(struct.pack("<fBBBB", 1.0, 255, 0, 0, 0), binary=False, kind="ColorOcTree")
    assert cells.sizes.tolist() == [0.5 * 2**16]


def test_empty_data_is_an_empty_tree():
    assert len(read(b"").sizes) == 0


@pytest.mark.parametrize(
    ("data", "options", "text"),
    [
        (b"\x03", {}, "ends too early"),
        (tree_node(c0=INNER), {}, "ends too early"),
        (tree_node(c0=OCCUPIED) + b"rest", {}, "ends after 2 of 6 bytes"),
        (tree_node(c0=INNER) * 17, {}, "has more than 16 levels"),
        (b"\x00" * 5, {"binary": False, "kind": "MyTree"}, "Octomaps of type 'MyTree' are not supported"),
        (b"\x00", {"resolution": 0.0}, "Invalid resolution"),
        (b"\x00", {"resolution": float("nan")}, "Invalid resolution"),
    ],
)
def test_malformed_octree_is_rejected_with_reason(data, options, text):
    with pytest.raises(BadOctreeError, match=text):
        read(data, **options)


@given(st.binary(max_size=200), st.booleans())
def test_arbitrary_bytes_are_read_or_rejected(data, binary):
    try:
        cells = read(data, binary=binary)
    except BadOctreeError:
        return
    assert np.isfinite(cells.centers).all()
    assert (cells.sizes > 0).all()


def test_hidden_cells_are_not_drawn():
    solid = tree_node(**{f"c{child}": OCCUPIED for child in range(8)})
    full_tree = tree_node(**{f"c{child}": INNER for child in range(8)})
    data = tree_node(c7=INNER) + tree_node(c0=INNER) * 12 + full_tree + (full_tree + solid * 8) * 8
    cells = read(data)
    assert len(cells.sizes) == 512
    (marker,) = make_octomap_markers(cells, "map", frame="base", base=IDENTITY, alpha=0.5, by_probability=False)
    assert len(marker.points) == 512 - 6**3
    assert marker.scale == [0.5, 0.5, 0.5]
    low = marker.colors[marker.points[:, 2].argmin()]
    high = marker.colors[marker.points[:, 2].argmax()]
    assert low[3] == high[3] == 0.5
    assert low.tolist() != high.tolist()


def test_colors_can_show_cell_probability():
    cells = read(tree_node(c0=OCCUPIED))
    (marker,) = make_octomap_markers(cells, "map", frame="base", base=IDENTITY, alpha=1.0, by_probability=True)
    assert marker.colors[0].tolist() == pytest.approx([0.029, 0.971, 0, 1])
