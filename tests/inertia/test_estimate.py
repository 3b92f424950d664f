"""The estimate of a link's inertia from its shapes, mass and density."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.descriptions import load
from linkwright.inertia import MeshLibrary, estimate
from linkwright.packages import PackageFinder

BOX = '<geometry><box size="0.2 0.2 0.2"/></geometry>'
BALL = '<geometry><sphere radius="0.1"/></geometry>'
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n"
"""A tetrahedron without its slanted side."""
INERTIAL = '<inertial><mass value="{}"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'


@pytest.fixture
def estimate_link(tmp_path):
    """Estimate the inertia of the only link of a robot."""

    def estimate_content(content, **options):
        robot = load(f'<robot name="r" version="1.1"><link name="a">{content}</link></robot>')
        return estimate(robot.links["a"], MeshLibrary(PackageFinder(start=tmp_path), tmp_path), **options)

    return estimate_content


def test_default_density_is_that_of_water(estimate_link):
    estimated = estimate_link(f"<visual>{BOX}</visual>")
    assert (estimated.kind, estimated.shapes, estimated.basis) == ("visual", 1, "density")
    assert estimated.properties.mass == pytest.approx(8.0)
    assert estimated.density == pytest.approx(1000.0)


def test_mass_of_file_is_kept(estimate_link):
    estimated = estimate_link(f"{INERTIAL.format(2)}<visual>{BOX}</visual>")
    assert estimated.basis == "present"
    assert estimated.properties.mass == pytest.approx(2.0)
    assert estimated.density == pytest.approx(250.0)
    assert estimated.properties.inertia[0, 0] == pytest.approx(2.0 * 0.04 * 2 / 12)


def test_negative_mass_of_file_is_replaced(estimate_link):
    assert estimate_link(f"{INERTIAL.format(-2)}<visual>{BOX}</visual>").basis == "density"


def test_given_mass_overrides_density_and_density_overrides_file(estimate_link):
    content = f"{INERTIAL.format(2)}<visual>{BOX}</visual>"
    assert estimate_link(content, density=500.0).properties.mass == pytest.approx(4.0)
    assert estimate_link(content, density=500.0, mass=7.0).properties.mass == pytest.approx(7.0)


def test_collision_shapes_are_preferred_unless_visuals_are_requested(estimate_link):
    content = f"<visual>{BOX}</visual><collision>{BALL}</collision>"
    assert estimate_link(content).kind == "collision"
    assert estimate_link(content, preferred_kind="visual").kind == "visual"
    assert estimate_link(f"<collision>{BALL}</collision>", preferred_kind="visual").kind == "collision"


def test_several_shapes_combine_to_one_body(estimate_link):
    estimated = estimate_link(
        f'<visual><origin xyz="0 0 0.1"/>{BOX}</visual><visual><origin xyz="0 0 -0.1"/>{BOX}</visual>', density=100.0
    )
    assert estimated.shapes == 2
    assert np.allclose(estimated.properties.center, 0)
    assert estimated.properties.mass == pytest.approx(1.6)
    assert estimated.properties.inertia[0, 0] == pytest.approx(1.6 * (0.04 + 0.16) / 12)


def test_link_without_shapes_has_no_properties(estimate_link):
    estimated = estimate_link("")
    assert estimated.properties is None
    assert estimated.kind is None


def test_capsule_has_mass_of_cylinder_and_sphere(estimate_link):
    estimated = estimate_link(
        '<collision><geometry><capsule radius="0.1" length="0.2"/></geometry></collision>', density=1.0
    )
    assert estimated.properties.mass == pytest.approx(np.pi * 0.01 * 0.2 + 4 / 3 * np.pi * 0.001)


def test_open_mesh_is_replaced_by_convex_hull_with_note(estimate_link, tmp_path):
    (tmp_path / "open.obj").write_text(TETRAHEDRON)
    estimated = estimate_link(
        '<collision><geometry><mesh filename="open.obj" scale="1 -2 3"/></geometry></collision>', density=1.0
    )
    assert estimated.properties.mass == pytest.approx(1.0)
    assert np.allclose(estimated.properties.center, (0.25, -0.5, 0.75))
    assert estimated.notes == ("the collision mesh 'open.obj' is not watertight: its convex hull is used",)


def test_missing_collision_mesh_falls_back_to_visuals(estimate_link):
    estimated = estimate_link(
        f'<visual>{BOX}</visual><collision><geometry><mesh filename="none.stl"/></geometry></collision>'
    )
    assert estimated.kind == "visual"
    assert estimated.notes[0].startswith("a collision mesh is left out: there is no mesh file")
    assert estimated.notes[1] == "the visual shapes are used instead"


def test_shapes_without_volume_are_left_out(estimate_link, tmp_path):
    (tmp_path / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    estimated = estimate_link(
        '<visual><geometry><box size="1 0 1"/></geometry></visual>'
        '<visual><geometry><mesh filename="flat.obj"/></geometry></visual>'
    )
    assert estimated.properties is None
    assert estimated.notes == (
        "a visual box is left out: it has a size that is not positive",
        "the visual mesh 'flat.obj' is left out: it is flat",
    )
