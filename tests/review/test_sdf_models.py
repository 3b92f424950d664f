"""Changes of SDF models in a review.

The tests cover mass properties, totals, values of added elements, and images.
"""

from __future__ import annotations

import pytest

from linkwright.review import open_versions, review
from tests.review.conftest import breaking, sentences, subject

PATH = "w/models/cart/model.sdf"
INERTIA = (
    "<inertia><ixx>0.02</ixx><iyy>0.03</iyy><izz>0.04</izz>"
    "<ixy>0.001</ixy><ixz>0</ixz><iyz>-0.0123456789</iyz></inertia>"
)
MODEL = f"""<sdf version="1.9"><model name="cart">
<link name="base">
<inertial><pose>0.1 0 0 0 0 0</pose><mass>2</mass>{INERTIA}</inertial>
<visual name="v"><geometry><box><size>1 0.5 0.25</size></box></geometry></visual>
<collision name="c"><geometry><box><size>1 0.5 0.25</size></box></geometry></collision>
</link>
<link name="arm"><pose>0 0 1 0 0 0</pose>
<inertial><mass>2</mass>{INERTIA}</inertial></link>
<joint name="lift" type="prismatic"><parent>base</parent><child>arm</child><axis><xyz>0 0 1</xyz></axis></joint>
<joint name="tilt" type="fixed"><parent>base</parent><child>arm</child></joint>
</model></sdf>
"""
BASE = "model cart link base"


def replace_in_model(text, *replacements):
    for old, new in replacements:
        assert old in text
        text = text.replace(old, new, 1)
    return text


def review_model(repository, compare, *replacements, text=MODEL):
    repository.commit({PATH: text})
    repository.write({PATH: replace_in_model(text, *replacements)})
    return compare(repository)


def change_lines(repository, compare, *replacements, text=MODEL):
    return sentences(subject(review_model(repository, compare, *replacements, text=text), PATH))


def figure_texts(repository, compare, *replacements):
    changes = subject(review_model(repository, compare, *replacements), PATH)
    return [f"{figure.name} {figure.old} -> {figure.new} {figure.unit}".strip() for figure in changes.figures]


SCALED = (
    ("<ixx>0.02<", "<ixx>0.01<"),
    ("<iyy>0.03<", "<iyy>0.015<"),
    ("<izz>0.04<", "<izz>0.02<"),
    ("<ixy>0.001<", "<ixy>0.0005<"),
    ("<iyz>-0.0123456789<", "<iyz>-0.00617283945<"),
)


def test_size_of_a_model_includes_a_large_floor(repository, compare):
    box = "<link name='{}'><visual name='v'><geometry><box><size>{}</size></box></geometry></visual></link>"
    links = box.format("base", "1 1 1") + box.format("floor", "50 50 0.1")
    text = f"<sdf version='1.9'><model name='cart'>{links}</model></sdf>"
    result = review_model(repository, compare, ("50 50", "60 50"), text=text)
    (figure,) = subject(result, PATH).figures
    assert (str(figure.name), figure.old, figure.new) == ("size", "50 x 50 x 1", "60 x 50 x 1")


@pytest.mark.parametrize("replacement", [("<mass>2<", "<mass>3<"), ("<pose>0.1 0 0 0 0 0</pose>", "")])
def test_other_inertial_of_a_link_with_the_name_of_a_tag_is_not_breaking(repository, compare, replacement):
    text = MODEL.replace("base", "link").replace("arm", "frame")
    result = review_model(repository, compare, replacement, text=text)
    assert len(subject(result, PATH).changes) == 1
    assert breaking(result) == []


@pytest.mark.parametrize(
    ("replacements", "expected"),
    [
        ((("<mass>2<", "<mass>2.81427130010<"),), "mass 2 -> 2.814 kg"),
        ((("<mass>2<", "<mass>2.0001<"),), "mass 2 -> 2.0001 kg"),
        ((("<pose>0.1 0 0 ", "<pose>0.1 0 0.02 "),), "center 0.1 0 0 -> 0.1 0 0.02 m (moved by 0.02 m)"),
        ((("<pose>0.1 0 0 0 0 0", "<pose>0.1 0 0 0 0 1"),), "axes 0 0 0 -> 0 0 1"),
        ((("<mass>2<", "<mass>1<"), *SCALED), "mass 2 -> 1 kg, inertia 0.5 times as large"),
        ((("<ixx>0.02<", "<ixx>0.0212345678901<"),), "ixx 0.02 -> 0.02123 kg m2"),
        (
            (("<ixx>0.02<", "<ixx>0.03<"), ("<iyy>0.03<", "<iyy>0.024<"), ("<izz>0.04<", "<izz>0.05<")),
            "inertia changed by up to 50 %",
        ),
        ((("<mass>2<", "<mass>3<"), ("<ixx>0.02<", "<ixx>0.03<"), ("<ixz>0<", "<ixz>1e-11<")),
         "mass 2 -> 3 kg, ixx 0.02 -> 0.03 kg m2"),
    ],
)  # fmt: skip
def test_inertial_of_a_link_is_one_line(repository, compare, replacements, expected):
    assert change_lines(repository, compare, *replacements) == [f"{BASE} inertial: {expected}"]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("<mass>2<", "<mass>2.000000000001<"),
        ("<pose>0.1 0 0 0", "<pose>0.1 0 4e-9 0"),
        ("<iyz>-0.0123456789<", "<iyz>-0.01234567891<"),
        ("<pose>0 0 1 0", "<pose>0 0 1.0000000001 0"),
    ],
)
def test_rounding_is_no_change(repository, compare, old, new):
    assert review_model(repository, compare, (old, new)).subjects == []


def test_counters_are_not_rounded(repository, compare):
    text = replace_in_model(MODEL, ("</model>", "<plugin name='p' filename='f'><seed>10000000</seed></plugin></model>"))
    assert change_lines(repository, compare, ("10000000", "10000001"), text=text) == [
        "model cart plugin p seed: 10000000 -> 10000001"
    ]


@pytest.mark.parametrize(
    ("replacements", "expected"),
    [
        ((("<mass>2<", "<mass>4<"),), ["mass 4 -> 6 kg", "center of mass 0.05 0 0.5 -> 0.06667 0 0.3333 m"]),
        ((("<pose>0 0 1 ", "<pose>0 0 2 "),), ["center of mass 0.05 0 0.5 -> 0.05 0 1 m"]),
        ((("<size>1 0.5", "<size>2 0.5"),), ["size 1 x 0.5 x 0.25 -> 2 x 0.5 x 0.25 m"]),
        ((('type="fixed"', 'type="revolute"'),), ["moving joints 1 -> 2"]),
        ((('<model name="cart">', '<model name="cart"><static>true</static>'),),
         ["mass 4 -> 0 kg"]),
        ((("</model>", "<link name='tip'/></model>"),),
         ["links 2 -> 3", "mass 4 -> 5 kg", "center of mass 0.05 0 0.5 -> 0.04 0 0.4 m"]),
    ],
)  # fmt: skip
def test_totals_of_a_model(repository, compare, replacements, expected):
    assert figure_texts(repository, compare, *replacements) == expected


def test_mass_that_the_simulator_computes_is_no_total(repository, compare):
    replacement = "</model>", "<link name='tip'><inertial auto='true'/></link></model>"
    assert figure_texts(repository, compare, replacement) == ["links 2 -> 3"]


SURFACE = "<surface><friction><ode><mu>100</mu><mu2>50</mu2></ode></friction></surface>"
DYNAMICS = "<xyz>0 0 1</xyz><dynamics><damping>{}</damping><friction>3.48</friction></dynamics>"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("</collision>", f"{SURFACE}</collision>",
         [f"{BASE} collision c surface friction ode added: mu 100, mu2 50"]),
        ("</collision>", SURFACE.replace("<mu2>50</mu2>", "") + "</collision>",
         [f"{BASE} collision c surface friction ode mu 100 added"]),
        ("<xyz>0 0 1</xyz>", DYNAMICS.format(21.75),
         ["model cart joint lift axis dynamics added: damping 21.75, friction 3.48"]),
        ("</model>", "<link name='tip'><inertial><mass>3</mass></inertial></link></model>",
         ["model cart link tip added: inertial mass 3"]),
        ("</model>", "<model name='hand'><link name='palm'/><link name='thumb'/></model></model>",
         ["model cart model hand added: links palm, thumb"]),
        ("</model>", "<include><name>box</name><uri>model://box</uri><pose>1 0 0 0 0 0</pose></include></model>",
         ["model cart include box added: uri model://box, pose 1 0 0 0 0 0"]),
        ("</model>", "<plugin name='p' filename='f'>" + "".join(f"<v{n}>{n}</v{n}>" for n in range(14))
         + "</plugin></model>",
         [("model cart plugin p filename=f added: v0 0, v1 1, v2 2, v3 3, v4 4, v5 5, v6 6, v7 7, v8 8, v9 9, v10 10, "
           "v11 11 and 2 more")]),
    ],
)  # fmt: skip
def test_added_elements_are_shown_with_their_values(repository, compare, old, new, expected):
    assert change_lines(repository, compare, (old, new)) == expected


def test_joints_with_other_values_are_other_lines(repository, compare):
    joints = "".join(f"<joint name='j{n}' type='revolute'><axis><xyz>0 0 {n}</xyz></axis></joint>" for n in range(4))
    text = f"<sdf version='1.9'><model name='arm'>{joints}</model></sdf>"
    replacements = [
        (f"<xyz>0 0 {n}</xyz>", DYNAMICS.format(damping).replace("0 0 1", f"0 0 {n}"))
        for n, damping in enumerate((3, 3, 10, 10))
    ]
    assert change_lines(repository, compare, *replacements, text=text) == [
        "model arm joint j0, j1 axis dynamics added: damping 3, friction 3.48",
        "model arm joint j2, j3 axis dynamics added: damping 10, friction 3.48",
    ]


def test_empty_values_are_shown(repository, compare):
    text = replace_in_model(MODEL, ("</model>", "<plugin name='p' filename='f'><prefix>a</prefix></plugin></model>"))
    assert change_lines(repository, compare, (">a<", "><"), text=text) == ["model cart plugin p prefix: a -> (empty)"]


@pytest.mark.parametrize(
    ("old", "new", "count"),
    [
        ("</collision>", f"{SURFACE}</collision>", 0),
        ("<mass>2<", "<mass>4<", 0),
        ("<size>1 0.5", "<size>2 0.5", 4),
        ('<visual name="v">', '<visual name="v"><pose>0 0 1 0 0 0</pose>', 4),
    ],
)
def test_changes_that_images_cannot_show_have_none(repository, monkeypatch, old, new, count):
    if not count:
        monkeypatch.setattr("linkwright.review.files.worlds.comparing.build_world_scenes", None)  # no mesh is read
    repository.commit({PATH: MODEL})
    repository.write({PATH: replace_in_model(MODEL, (old, new))})
    versions = open_versions(repository.root, "HEAD")
    try:
        result = review(versions, with_images=True)
    finally:
        versions.close()
    assert len(subject(result, PATH).images) == count


SENSOR = """<sdf version="1.9"><model name="cart"><pose>0 0 1 0 0 0</pose><link name="base">
<sensor name="eye" type="camera"><update_rate>30</update_rate>
<plugin name="driver" filename="libgazebo_ros_camera.so"><camera_name>front</camera_name></plugin></sensor>
<collision name="c"><surface><contact><ode><max_vel>0.1</max_vel></ode></contact></surface></collision>
</link></model></sdf>"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("<pose>0 0 1 0 0 0", "<pose>0 0 3 0 0 1.5707963267948966",
         "model cart pose: 0 0 1 0 0 0 -> 0 0 3 0 0 1.5707963267948966 (moved by 2 m, rotated by 90°)"),
        ("<pose>0 0 1 0 0 0", "<pose>0 0 1 0 0 1.5707963267948966",
         "model cart pose: 0 0 1 0 0 0 -> 0 0 1 0 0 1.5707963267948966 (rotated by 90°)"),
        ("<update_rate>30</update_rate>", "", "model cart link base sensor eye update_rate: 30 -> 0 (default)"),
        ("<max_vel>0.1</max_vel>", "",
         "model cart link base collision c surface contact ode max_vel: 0.1 -> 0.01 (default)"),
        ('<link name="base">', '<link name="base"><gravity>false</gravity>',
         "model cart link base gravity: true (default) -> false"),
        ('<link name="base">', '<link name="base"><gravity>1</gravity>', None),
    ],
)  # fmt: skip
def test_poses_have_distances_and_left_out_elements_have_defaults(repository, compare, old, new, expected):
    repository.commit({"cart/model.sdf": SENSOR})
    repository.write({"cart/model.sdf": SENSOR.replace(old, new)})
    found = [sentence for part in compare(repository).subjects for sentence in sentences(part)]
    assert found == ([] if expected is None else [expected])


def test_name_of_a_camera_of_gazebo_ros_is_the_namespace_of_its_topics(repository, compare):
    repository.commit({"cart/model.sdf": SENSOR})
    repository.write({"cart/model.sdf": SENSOR.replace(">front<", ">rear<")})
    assert [sentence.rpartition(" plugin ")[2] for sentence in breaking(compare(repository))] == [
        "driver camera_name: front -> rear"
    ]


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("<sdf version='1.6'>model.sdf</sdf>", "", "sdf 1.6 model.sdf removed", True),
        ("", "<sdf version='1.4'>old.sdf</sdf>", "sdf 1.4 old.sdf added", False),
        ("<version>1.0<", "<version>1.1<", "version 1.0 -> 1.1", False),
        ("<name>Ana<", "<name>Bo<", None, False),
    ],
)
def test_files_of_a_model_configuration_are_compared(repository, compare, old, new, expected, is_breaking):
    text = (
        "<?xml version='1.0'?>\n<model><name>Tree</name><version>1.0</version><sdf version='1.6'>model.sdf</sdf>"
        "<author><name>Ana</name></author></model>"
    )
    path = "w/models/tree/model.config"
    repository.commit({path: text})
    repository.write({path: text.replace(old, new) if old else text.replace("<author>", f"{new}<author>")})
    result = compare(repository)
    found = [str(change.sentence) for item in result.subjects for change in item.changes]
    assert found == ([expected] if expected else [])
    assert bool(breaking(result)) is is_breaking
