"""Adding to a world: the reader finds the added contents in the new text."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.geometry.mass import combine
from linkwright.geometry.shapes import Box
from linkwright.geometry.single import Pose
from linkwright.geometry.solids import shape_properties
from linkwright.sdf.editing import Change, EditError, add_include, add_light, add_shape, change, delete
from linkwright.sdf.editing.shapes import compute_solid_properties
from tests.sdf.editing.texts import PLAIN_WORLD, is_rejected_by_simulators, world_text, world_with

POSE = (1.0, 2.0, 3.0, 0.0, 0.0, 0.5)
SIZES = {"box": (1, 2, 3), "cylinder": (0.1, 2), "sphere": (0.3,), "wall": (4, 0.2, 1), "ramp": (2, 1, 0.5)}


@pytest.mark.parametrize("kind", SIZES)
def test_added_shape_is_read_back(kind):
    world = world_text(PLAIN_WORLD)
    text, name = add_shape(world, kind, POSE, SIZES[kind])
    entity = text.entities[name]
    assert (entity.shape.kind, entity.shape.size) == (kind, SIZES[kind])
    assert entity.pose.pose == Pose(POSE[:3], POSE[3:])
    assert entity.is_static == (kind in ("wall", "ramp"))
    assert not is_rejected_by_simulators(text)
    assert delete(text, [name]).text == PLAIN_WORLD
    usual, name = add_shape(world, kind, POSE)
    larger = change(usual, [Change(name, size=SIZES[kind], static=False)])
    assert larger.entities[name].shape.size == SIZES[kind]
    assert change(text, [Change(name, static=False)]).entities[name].shape.size == SIZES[kind]


def test_added_shape_weighs_one_kilogram_with_solid_inertia():
    text, name = add_shape(world_with(), "cylinder", POSE, (0.5, 2.0))
    inertial = text.entities[name].model.links[0].inertial
    assert inertial.mass == 1.0
    assert inertial.inertia.izz == pytest.approx(0.125)
    assert inertial.inertia.ixx == pytest.approx((3 * 0.25 + 4) / 12, rel=1e-5)


def test_added_ramp_has_mass_properties_of_wedge():
    size, count = (2.0, 1.0, 0.5), 400
    step = size[0] / count
    heights = (np.arange(count) + 0.5) / count * size[2]
    slices = [
        shape_properties(Box((step, size[1], h))).moved(Pose((-1 + (index + 0.5) * step, 0.0, h / 2 - size[2] / 2)))
        for index, h in enumerate(heights.tolist())
    ]
    combined, expected = combine(slices), compute_solid_properties("ramp", size)
    assert combined.mass == pytest.approx(expected.mass)
    assert combined.center == pytest.approx(expected.center, abs=1e-5)
    assert combined.inertia == pytest.approx(expected.inertia, rel=1e-3, abs=1e-6)


def test_added_elements_follow_last_with_same_indentation():
    text, _ = add_light(world_text(PLAIN_WORLD), "point", POSE)
    assert text.text.startswith(PLAIN_WORLD[: PLAIN_WORLD.index("  </world>")])
    assert '    <light name="point_light" type="point">\n      <pose>1 2 3 0 0 0.5</pose>\n' in text.text
    text, _ = add_shape(world_text("<sdf version='1.6'><world name='w'/></sdf>"), "box", POSE)
    assert "<world name='w'>\n  <model name=\"box\">\n    <pose>" in text.text
    tabs = "<sdf version='1.6'>\n\t<world name='w'>\n\t\t<gravity>0 0 -9.8</gravity>\n\t</world>\n</sdf>"
    text, _ = add_shape(world_text(tabs), "box", POSE)
    assert '</gravity>\n\t\t<model name="box">\n\t\t\t<pose>' in text.text


@pytest.mark.parametrize("kind", ["point", "directional", "spot"])
def test_added_light_has_its_type(kind):
    text, name = add_light(world_with(), kind, POSE)
    light = text.entities[name].light
    assert (name, light.type) == (f"{kind}_light", kind)
    assert (light.spot is not None) == (kind == "spot")
    assert not is_rejected_by_simulators(text)


def test_added_include_gets_unique_name(tmp_path):
    folder = tmp_path / "crate"
    folder.mkdir()
    (folder / "model.sdf").write_text("<sdf version='1.6'><model name='box'><link name='l'/></model></sdf>")
    text, name = add_include(world_text(PLAIN_WORLD, str(tmp_path)), " model://crate ", POSE)
    assert name == "box_2"
    lines = ("<uri>model://crate</uri>", "<name>box_2</name>", "<pose>1 2 3 0 0 0.5</pose>")
    assert "    <include>\n      " + "\n      ".join(lines) + "\n    </include>\n" in text.text
    assert text.entities[name].world_pose[:3] == (1, 2, 3)
    text, name = add_include(text, "model://sun", POSE)
    assert (name, text.entities[name].kind) == ("sun", "light")
    with pytest.raises(EditError, match="there is no model 'nothing' on the search path"):
        add_include(text, "model://nothing", POSE)
    with pytest.raises(EditError, match="'' does not name a model"):
        add_include(text, " ", POSE)


@pytest.mark.parametrize("pose", [(1, 2, 3), (1, 2, 3, 4, 5, float("inf")), ()])
def test_invalid_pose_is_rejected(pose):
    with pytest.raises(EditError, match="a pose must have six finite numbers"):
        add_shape(world_with(), "box", pose)


def test_world_with_attribute_values_is_rejected(tmp_path):
    text = '<gazebo version="1.0"><world name="w"><model name="m"><origin pose="1 2 3 0 0 0"/></model></world></gazebo>'
    with pytest.raises(EditError, match="with 'linkwright convert' first"):
        world_text(text)
