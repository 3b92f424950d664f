"""Robots as glTF, read again."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.panels.export.feature import export_snapshot
from tests.browser.golden import GOLDEN, golden_links, link_element, mesh_visual, robot_of
from tests.browser.mesh_writers import make_png, write_dae
from tests.panels.export.robots import GRIPPER, GlbContents, make_snapshot


def test_glb_links_are_nodes_at_joint_poses():
    glb = GlbContents(export_snapshot(make_snapshot(GRIPPER), "glb"))
    assert glb.nodes[glb.root]["name"] == "gripper"
    np.testing.assert_allclose(glb.links["base"], np.eye(4), atol=1e-7)
    # turn is at 0, open in the middle of its range, 0.25, and open_too at -2 * 0.25 + 0.05
    np.testing.assert_allclose(glb.links["left"][:3, 3], (-0.45, 0, 1.25), atol=1e-6)
    np.testing.assert_allclose(glb.links["right"][:3, 3], (0.65, 0, 1.25), atol=1e-6)
    extras = {node["extras"]["joint"] for node in glb.nodes if "extras" in node}
    assert extras == {"turn", "open", "open_too"}


def test_glb_shapes_have_size_and_color():
    drawn = {
        primitive.link: primitive for primitive in GlbContents(export_snapshot(make_snapshot(GRIPPER), "glb")).drawn
    }
    assert (drawn["base"].color, drawn["base"].opacity) == ("#0080ff", 0.75)
    np.testing.assert_allclose(drawn["base"].bounds, ((-0.5, -1, -0.25), (0.5, 1, 0.25)), atol=1e-6)
    assert (drawn["arm"].color, drawn["arm"].opacity) == ("#ff0000", 1.0)  # RViz's red
    np.testing.assert_allclose(drawn["arm"].bounds, ((-0.1, -0.1, 0.25), (0.1, 0.1, 1.25)), atol=1e-6)
    np.testing.assert_allclose(drawn["right"].bounds, ((0.55, -0.1, 1.05), (0.75, 0.1, 1.45)), atol=1e-6)


def test_glb_uses_current_joint_positions():
    shown = make_snapshot(GRIPPER)
    glb = GlbContents(export_snapshot(replace(shown, positions={**shown.positions, "turn": np.pi / 2}), "glb"))
    # The rotation is about the link's y axis, which is the base's -x axis.
    np.testing.assert_allclose(glb.links["left"][:3, 3], (-0.45, 1, 0.25), atol=1e-6)


def test_glb_triangles_face_outward():
    glb = GlbContents(export_snapshot(make_snapshot(GRIPPER), "glb"))
    for solid in glb.document["meshes"]:
        (primitive,) = solid["primitives"]
        points = glb.array(primitive["attributes"]["POSITION"]).astype(float)
        a, b, c = (points[glb.array(primitive["indices"])[start::3]] for start in range(3))
        outwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), a + b + c)
        assert (outwards > 0).all(), solid["name"]
        normals = glb.array(primitive["attributes"]["NORMAL"])
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-5)


def test_glb_meshes_match_size_and_color_of_page(tmp_path):
    drawn = {
        primitive.link: primitive
        for primitive in GlbContents(export_snapshot(make_snapshot(robot_of(golden_links(tmp_path))), "glb")).drawn
    }
    mismatches = {}
    for name, (_, _, _, _, (lower_corner, upper_corner), color, opacity) in GOLDEN.items():
        result = drawn[name]
        if not (
            result.bounds[0] == pytest.approx(lower_corner, abs=1e-5)
            and result.bounds[1] == pytest.approx(upper_corner, abs=1e-5)
            and (result.color, result.opacity) == (color, pytest.approx(opacity))
        ):
            mismatches[name] = result
    assert mismatches == {}


def make_textured_dae() -> str:
    text = write_dae(diffuse="<texture texture='c' texcoord='UV'/>").decode()
    sampler = (
        "<newparam sid='f'><surface type='2D'><init_from>i</init_from></surface></newparam>"
        "<newparam sid='c'><sampler2D><source>f</source></sampler2D></newparam><technique sid='t'>"
    )
    text = text.replace("<technique sid='t'>", sampler)
    image = "<library_images><image id='i'><init_from>skin.png</init_from></image></library_images><library_effects>"
    return text.replace("<library_effects>", image)


def test_glb_contains_texture(tmp_path):
    skin = make_png(255, 255, 0)
    (tmp_path / "skin.png").write_bytes(skin)
    texture = f'<material name="skin"><texture filename="{(tmp_path / "skin.png").as_uri()}"/></material>'
    text = robot_of(link_element("box", f'<visual><geometry><box size="1 1 1"/></geometry>{texture}</visual>'))
    glb = GlbContents(export_snapshot(make_snapshot(text), "glb"))
    (drawn,) = glb.drawn
    assert (drawn.textured, drawn.color) == (True, "#ffffff")
    assert glb.image() == skin


def test_unreadable_mesh_is_named(tmp_path):
    path = tmp_path / "broken.dae"
    path.write_text("no mesh")
    with pytest.raises(LinkwrightError) as caught:
        export_snapshot(make_snapshot(robot_of(link_element("arm", mesh_visual(path, "")))), "glb")
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "VIEW204"
    assert "'arm'" in diagnostic.message
    assert "broken.dae" in diagnostic.message


def test_missing_mesh_is_reported_and_omitted():
    shown = make_snapshot(
        robot_of(link_element("arm", '<visual><geometry><mesh filename="file:///no/where.stl"/></geometry></visual>'))
    )
    (problem,) = shown.problems
    assert problem.code == "VIEW203"
    assert "where.stl" in problem.message
    assert GlbContents(export_snapshot(shown, "glb")).drawn == []
