"""The writer of worlds and models: the reader returns the same objects."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings

from linkwright.descriptions import examine_world
from linkwright.geometry.single import Pose
from linkwright.packages import PackageFinder
from linkwright.sdf.actors import Actor
from linkwright.sdf.joints import Joint
from linkwright.sdf.lights import Light
from linkwright.sdf.links import Link
from linkwright.sdf.models import Frame, Include, Model
from linkwright.sdf.poses import RawPose
from linkwright.sdf.reader import read
from linkwright.sdf.sensors import Sensor
from linkwright.sdf.states import State
from linkwright.sdf.text import parse_as_gazebo
from linkwright.sdf.worlds import Road, World
from linkwright.sdf.writer import save, save_model_of_world, save_world
from tests.sdf.objects import objects
from tests.sdf.worlds import make_model_text, make_world_text, read_sdf

WORLDS = Path(__file__).parents[3] / "shared" / "worlds"
MANIFEST = WORLDS / "manifest.json"


def read_back(text):
    """Return the content of a text, valid or not."""
    document, warnings = parse_as_gazebo(text, "w.sdf")
    assert warnings == ()
    sdf = read(document).sdf
    assert sdf is not None
    return sdf


def write_and_read(entity):
    """Return a world or model after writing and reading."""
    sdf = read_back(save(entity))
    return sdf.worlds[0] if isinstance(entity, World) else sdf.models[0]


def check_round_trip(kind, make):
    """Check that any object of a class is equal after writing and reading.

    The object is inside a model or world.
    """

    @settings(deadline=None, max_examples=15, suppress_health_check=list(HealthCheck))
    @given(element=objects(kind))
    def check(element):
        container = make(element)
        assert write_and_read(container) == container

    check()


@pytest.mark.parametrize(
    ("kind", "make"),
    [
        (Frame, lambda part: Model("m", frames=(part,))),
        (Include, lambda part: Model("m", includes=(part,))),
        (Joint, lambda part: Model("m", joints=(part,))),
        (Link, lambda part: Model("m", links=(part,))),
        (Model, lambda part: Model("m", models=(part,))),
        (Sensor, lambda part: Model("m", links=(Link("l", sensors=(part,)),))),
        (Actor, lambda part: World("w", actors=(part,))),
        (Light, lambda part: World("w", lights=(part,))),
        (Road, lambda part: World("w", roads=(part,))),
        (State, lambda part: World("w", states=(part,))),
        (World, lambda part: part),
    ],
)
def test_written_objects_are_read_back(kind, make):
    check_round_trip(kind, make)


def test_default_values_are_omitted():
    assert save(Model("m", links=(Link("l"),))) == (
        '<?xml version="1.0" ?>\n<sdf version="1.11">\n  <model name="m">\n    <link name="l"/>\n  </model>\n</sdf>\n'
    )


def test_sizes_masses_and_poses_are_always_written():
    inertial = "<inertial><inertia><ixy>0.1</ixy></inertia></inertial>"
    collision = '<collision name="c"><geometry><box/></geometry></collision>'
    text = save(make_model_text(f'<link name="l">{inertial}{collision}</link>'))
    assert "<mass>1</mass>" in text
    assert "<ixx>1</ixx>" in text
    assert "<size>1 1 1</size>" in text
    model_with_frame = Model("m", frames=(Frame("f", pose=RawPose(relative_to="l")),))
    assert '<pose relative_to="l">0 0 0 0 0 0</pose>' in save(model_with_frame)


def test_plugin_contents_and_unused_elements_are_preserved():
    content = (
        '<physics name="p" type="ode"><ode><solver><iters>50</iters></solver></ode></physics>'
        '<scene><sky><clouds/></sky></scene><gui><camera name="user"/></gui>'
        '<plugin name="p" filename="f.so" more="x"><a b="c">d</a><!-- e --></plugin>'
    )
    text = save(make_world_text(content))
    assert "<iters>50</iters>" in text
    assert "<clouds/>" in text
    assert '<camera name="user"/>' in text
    assert '<a b="c">d</a>' in text
    assert 'more="x"' in text
    assert save(read_sdf(text)) == text


def test_namespace_prefixes_are_declared():
    document, warnings = parse_as_gazebo(
        '<sdf version="1.9"><model name="m"><link name="l"/><gz:policy a="1"/></model></sdf>', "m.sdf"
    )
    assert len(warnings) == 1
    sdf = read(document).sdf
    assert sdf is not None
    text = save(sdf)
    assert '<gz:policy a="1"/>' in text
    assert read_back(text) == replace(sdf, version="1.11")


@pytest.mark.parametrize("inside", ["", '<plugin name="p" filename="f.so"><a>\n b\n</a></plugin><light name="l"/>'])
@pytest.mark.parametrize("model", ["", '<model name="m"><link name="l"/><gz:policy a="1"/></model><model name="n"/>'])
def test_world_from_written_models_equals_whole_world(inside, model):
    document, _ = parse_as_gazebo(f'<sdf version="1.9"><world name="w">{model}{inside}</world></sdf>', "m.world")
    sdf = read(document).sdf
    assert sdf is not None
    [expected_world] = sdf.worlds
    text = save_world(
        replace(expected_world, models=()), [save_model_of_world(model) for model in expected_world.models]
    )
    assert text == save(expected_world)


def test_old_axis_is_written_in_model_frame():
    axis = "<axis><xyz>1 0 0</xyz><use_parent_model_frame>true</use_parent_model_frame></axis>"
    joint = f'<joint name="j" type="revolute"><parent>a</parent><child>b</child>{axis}</joint>'
    text = save(make_model_text(f'<link name="a"/><link name="b"/>{joint}'))
    assert '<xyz expressed_in="__model__">1 0 0</xyz>' in text


def test_quaternion_is_preserved():
    half = 0.5**0.5
    pose = f'<pose rotation_format="quat_xyzw">1 2 3 0 0 {half} {half}</pose>'
    parsed_model = make_model_text(f'<link name="a">{pose}</link>')
    assert parsed_model.links[0].pose.pose.quaternion == (0.0, 0.0, half, half)
    assert write_and_read(parsed_model) == parsed_model
    assert write_and_read(Model("m", RawPose(Pose((1.0, 2.0, 3.0), (0.1, 0.2, 0.3))))).pose.pose.rpy == (
        0.1,
        0.2,
        0.3,
    )


def _find_files():
    if not MANIFEST.is_file():
        return []
    items = json.loads(MANIFEST.read_text(encoding="utf-8"))["items"]
    return sorted({item["entry"] for item in items if item["entry"].endswith((".world", ".sdf"))})


def normalized_text(sdf):
    """Return a file as a text; nan, as in one world's inertia, equals nan, and -0 is 0."""
    return repr(sdf).replace("-0.0,", "0.0,").replace("-0.0)", "0.0)")


@pytest.mark.parametrize("entry", _find_files())
def test_corpus_worlds_and_models_are_read_back(entry):
    path = WORLDS / entry
    finder = PackageFinder(start=path.parent, environment={})
    reading = examine_world(path, packages=finder, environment={"HOME": "/nowhere"})
    assert reading.sdf is not None
    assert normalized_text(read_back(save(reading.sdf))) == normalized_text(replace(reading.sdf, version="1.11"))
