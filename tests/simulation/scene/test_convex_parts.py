"""The split of meshes into convex hulls, and the collisions of moving links with such meshes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from linkwright.geometry.arrays import Array
from linkwright.geometry.hull import convex_hull
from linkwright.geometry.polyhedron import Faces, polyhedron_properties
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.scene.convex_parts import split_into_hulls
from tests.simulation.worlds import box, make_simulation

GROUND = """<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry>
</collision></link></model>"""


def box_mesh(low: tuple[float, float, float], high: tuple[float, float, float]) -> tuple[Array, Faces]:
    """Return the corners and triangles of a box."""
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    faces = convex_hull(corners)
    assert faces is not None
    return corners, faces


def elbow_mesh(scale: float = 1.0) -> tuple[Array, Faces]:
    """Return an L of two boxes: 0.4 m along x and 0.4 m along z, each 0.1 m thick."""
    (first, first_faces), (second, second_faces) = (
        box_mesh((0.0, 0.0, 0.0), (0.4, 0.1, 0.1)),
        box_mesh((0.0, 0.0, 0.0), (0.1, 0.1, 0.4)),
    )
    return scale * np.concatenate((first, second)), np.concatenate((first_faces, second_faces + len(first)))


def volume(corners: Array) -> float:
    faces = convex_hull(corners)
    assert faces is not None
    return abs(polyhedron_properties(corners, faces).mass)


def contains(parts: list[Array], point: Array, tolerance: float = 1e-6) -> bool:
    """Return whether a point is in one of the hulls."""
    return any(volume(np.concatenate((part, [point]))) <= volume(part) * (1.0 + tolerance) for part in parts)


class TestSplit:
    def test_elbow_leaves_its_corner_free(self) -> None:
        vertices, faces = elbow_mesh()
        parts = split_into_hulls(vertices, faces)
        assert not contains(parts, np.array((0.2, 0.05, 0.2)))
        assert sum(map(volume, parts)) < 1.1 * 0.007
        assert contains([vertices], np.array((0.2, 0.05, 0.2)))

    def test_hulls_contain_the_mesh(self) -> None:
        vertices, faces = elbow_mesh()
        random = np.random.default_rng(1)
        vertices = vertices + random.uniform(-0.02, 0.02, vertices.shape)
        parts = split_into_hulls(vertices, faces)
        assert len(parts) > 1
        weights = random.dirichlet((1.0, 1.0, 1.0), len(faces))
        for point in (*vertices, *np.einsum("nk,nkd->nd", weights, vertices[faces])):
            assert contains(parts, point)

    def test_convex_mesh_stays_whole(self) -> None:
        corners, faces = box_mesh((0.0, 0.0, 0.0), (0.4, 0.2, 0.1))
        (part,) = split_into_hulls(corners, faces)
        assert {tuple(point) for point in part.round(9)} == {tuple(point) for point in corners}

    @pytest.mark.parametrize("scale", [1e-5, 1e3])
    def test_size_does_not_matter(self, scale: float) -> None:
        assert len(split_into_hulls(*elbow_mesh(scale))) == len(split_into_hulls(*elbow_mesh()))

    def test_flat_fin_is_not_lost(self) -> None:
        vertices, faces = box_mesh((0.0, 0.0, 0.0), (0.1, 0.1, 0.1))
        fin = np.array(((0.1, 0.05, 0.0), (0.9, 0.05, 0.0), (0.1, 0.05, 0.1)))
        parts = split_into_hulls(np.concatenate((vertices, fin)), np.concatenate((faces, [[8, 9, 10]])))
        assert contains(parts, fin[1])

    def test_flat_mesh_has_no_hull(self) -> None:
        triangle = np.array(((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
        assert split_into_hulls(triangle, np.array([[0, 1, 2]])) == []
        assert split_into_hulls(triangle, np.zeros((0, 3), dtype=np.int64)) == []


def write_elbow(folder: Path) -> str:
    """Write an elbow as an STL file, and return the geometry of a model."""
    vertices, faces = elbow_mesh()
    corners = ("".join(f"vertex {x} {y} {z}\n" for x, y, z in vertices[face]) for face in faces)
    facets = "".join(f"facet normal 0 0 0\nouter loop\n{text}endloop\nendfacet\n" for text in corners)
    (folder / "elbow.stl").write_text(f"solid m\n{facets}endsolid m\n")
    return f"<geometry><mesh><uri>{(folder / 'elbow.stl').as_uri()}</uri></mesh></geometry>"


@pytest.mark.parametrize("limits", ["<limit><lower>-1</lower><upper>1</upper></limit>", ""])
def test_link_collides_where_its_mesh_is_unless_it_may_be_a_wheel(tmp_path: Path, limits: str) -> None:
    """A ball is between the ends of an elbow, where the hull of the whole elbow is."""
    elbow = f"""<model name="arm"><link name="base"/>
    <joint name="f" type="fixed"><parent>world</parent><child>base</child></joint>
    <link name="elbow"><collision name="c">{write_elbow(tmp_path)}</collision></link>
    <joint name="turn" type="revolute"><parent>base</parent><child>elbow</child>
    <axis><xyz>0 1 0</xyz>{limits}</axis></joint></model>"""
    ball = """<model name="ball"><static>true</static><pose>0.2 0.05 0.2 0 0 0</pose><link name="l">
    <collision name="c"><geometry><sphere><radius>0.02</radius></sphere></geometry></collision></link></model>"""
    simulation = make_simulation(elbow, ball)
    simulation.advance(simulation.step)
    assert (simulation.data.ncon == 0) == bool(limits)


def test_box_rests_in_the_corner_of_a_moving_mesh(tmp_path: Path) -> None:
    elbow = f"""<model name="elbow"><link name="l"><inertial><pose>0.15 0.05 0.1 0 0 0</pose><mass>1</mass></inertial>
    <collision name="c">{write_elbow(tmp_path)}</collision></link></model>"""
    simulation = make_simulation(GROUND, elbow, box("box", "0.2 0.05 0.16 0 0 0", "0.1 0.08 0.1", mass=0.1))
    simulation.advance(NANOSECONDS_PER_SECOND)
    x, y, z, *_ = simulation.model_pose("box")
    assert (x, y, z) == pytest.approx((0.2, 0.05, 0.15), abs=0.01)
