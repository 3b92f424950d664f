"""Changes of SDF worlds and models in a review: renamed elements, topics, prefixes."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

PATH = "w/worlds/yard.sdf"
WORLD = """<sdf version="1.9">
  <world name="yard">
    <physics name="p" type="ode"><max_step_size>0.001</max_step_size></physics>
    <model name="robot">
      <frame name="tool"><pose relative_to="base">0 0 1 0 0 0</pose></frame>
      <link name="base">
        <inertial><mass>1.0</mass></inertial>
        <sensor name="lidar" type="gpu_lidar"><topic>scan</topic><gz_frame_id>laser</gz_frame_id><lidar><range><max>9</max></range></lidar></sensor>
        <collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision>
      </link>
      <joint name="wheel_joint" type="revolute"><parent>base</parent><child>wheel</child><axis><xyz gz:expressed_in="base">0 1 0</xyz></axis></joint>
      <link name="wheel"/>
      <plugin name="drive" filename="libgazebo_ros_diff_drive.so"><ros><remapping>cmd_vel:=drive/cmd</remapping></ros></plugin>
    </model>
  </world>
</sdf>
"""  # noqa: E501
SENSOR = WORLD[WORLD.index("        <sensor") : WORLD.index("        <collision")]
PLUGIN = WORLD[WORLD.index("      <plugin") : WORLD.index("    </model")]
ROBOT = "world yard model robot"


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ('<link name="base">', '<link name="body">', f"{ROBOT} link base renamed to 'body'", True),
        ('<model name="robot">', '<model name="rover">', f"{ROBOT} renamed to 'rover'", True),
        ('<joint name="wheel_joint"', '<joint name="axle"', f"{ROBOT} joint wheel_joint renamed to 'axle'", True),
        ('<sensor name="lidar"', '<sensor name="laser"', f"{ROBOT} link base sensor lidar renamed to 'laser'", True),
        ('<frame name="tool">', '<frame name="hand">', f"{ROBOT} frame tool renamed to 'hand'", True),
        ('      <link name="wheel"/>\n', "", f"{ROBOT} link wheel removed", True),
        (SENSOR, "",
         (f"{ROBOT} link base sensor lidar type=gpu_lidar removed: topic scan, gz_frame_id laser, "
          "lidar range max 9"), True),
        ("<topic>scan<", "<topic>front/scan<", f"{ROBOT} link base sensor lidar topic: scan -> front/scan", True),
        ("<topic>scan<", "<topic>/scan<", f"{ROBOT} link base sensor lidar topic: scan -> /scan", False),
        ("<topic>scan</topic>", "", f"{ROBOT} link base sensor lidar topic scan removed", True),
        (">laser<", ">lidar<", f"{ROBOT} link base sensor lidar gz_frame_id: laser -> lidar", True),
        (PLUGIN, "",
         (f"{ROBOT} plugin drive filename=libgazebo_ros_diff_drive.so removed: ros remapping cmd_vel:=drive/cmd, "
          "topics 'odom'"), True),
        ("drive/cmd<", "cmd<",
         f"{ROBOT} plugin drive ros remapping: cmd_vel:=drive/cmd -> cmd_vel:=cmd", True),
        ('"base">0 1 0', '"base">0 -1 0', f"{ROBOT} joint wheel_joint axis xyz: 0 1 0 -> 0 -1 0", False),
        ('<collision name="c">', '<collision name="d">', f"{ROBOT} link base collision c renamed to 'd'", False),
    ],
)  # fmt: skip
def test_changes_of_names_in_worlds_are_breaking(repository, compare, old, new, expected, is_breaking):
    assert old in WORLD
    repository.commit({PATH: WORLD})
    repository.write({PATH: WORLD.replace(old, new)})
    result = compare(repository)
    assert expected in sentences(subject(result, PATH))
    assert bool(breaking(result)) is is_breaking


def test_ray_and_lidar_are_one_element(repository, compare):
    lidar = "<lidar><range><max>9</max></range></lidar>"
    assert lidar in WORLD
    repository.commit({PATH: WORLD.replace(lidar, lidar.replace("lidar", "ray"))})
    repository.write({PATH: WORLD})
    assert compare(repository).subjects == []
    repository.write({PATH: WORLD.replace("<max>9<", "<max>8<")})
    assert sentences(subject(compare(repository), PATH)) == [f"{ROBOT} link base sensor lidar lidar range max: 9 -> 8"]


def test_renamed_world_is_compared_with_the_old_one(repository, compare):
    repository.commit({PATH: WORLD})
    repository.write({PATH: WORLD.replace('"yard"', '"park"').replace("0.001", "0.002")})
    assert sentences(subject(compare(repository), PATH)) == [
        "world yard renamed to 'park'",
        "world park physics p max_step_size: 0.001 -> 0.002",
    ]


def test_worlds_of_stage_are_not_compared(repository, compare):
    repository.commit({"w/worlds/yard.world": 'include "robot.inc"\nwindow ( size [ 600 700 ] )\n'})
    repository.write({"w/worlds/yard.world": 'include "robot.inc"\nwindow ( size [ 800 700 ] )\n'})
    result = compare(repository)
    assert (result.subjects, result.other_files) == ([], ["w/worlds/yard.world"])


def test_equal_numbers_are_no_change(repository, compare):
    repository.commit({PATH: WORLD})
    repository.write({PATH: WORLD.replace(">1.0<", ">1<").replace(">1 1 1<", ">1.0 1 1e0<")})
    assert compare(repository).subjects == []


def test_reason_of_a_remapping_is_the_name_that_others_use(repository, compare):
    repository.commit({PATH: WORLD})
    repository.write({PATH: WORLD.replace("drive/cmd<", "cmd<")})
    ((_, change),) = compare(repository).breaking_changes
    assert str(change.reason) == "programs that use the name 'drive/cmd' do not find it"


def test_equal_changes_of_several_elements_are_one(repository, compare):
    joints = "".join(
        f'<joint name="servo_{n}" type="revolute"><axis><limit><upper>0.5</upper></limit></axis></joint>'
        for n in range(4)
    )
    text = f'<sdf version="1.9"><model name="plane">{joints}</model></sdf>'
    repository.commit({PATH: text})
    repository.write({PATH: text.replace("0.5", "0.7")})
    assert sentences(subject(compare(repository), PATH)) == [
        "model plane joint servo_0, servo_1, servo_2, ... (4) axis limit upper: 0.5 -> 0.7"
    ]


def test_removed_elements_with_different_values_are_apart(repository, compare):
    def model(shapes: dict[str, str]) -> str:
        links = "".join(
            f'<link name="{name}"><collision name="c"><geometry>{shape}</geometry></collision></link>'
            for name, shape in shapes.items()
        )
        return f'<sdf version="1.9"><model name="arm">{links}</model></sdf>'

    def mesh(name: str) -> str:
        return f"<mesh><uri>model://arm/{name}.dae</uri></mesh>"

    box = "<box><size>1 1 1</size></box>"
    repository.commit({PATH: model({"frame_0": mesh("frame"), "frame_1": mesh("frame"), "plate": mesh("plate")})})
    repository.write({PATH: model(dict.fromkeys(("frame_0", "frame_1", "plate"), box))})
    found = sentences(subject(compare(repository), PATH))
    assert [sentence for sentence in found if "removed" in sentence] == [
        "model arm link frame_0, frame_1 collision c geometry mesh removed: uri model://arm/frame.dae",
        "model arm link plate collision c geometry mesh removed: uri model://arm/plate.dae",
    ]


def test_added_element_is_shown_with_its_attributes(repository, compare):
    repository.commit({PATH: WORLD})
    plugin = '<plugin name="Entity context menu" filename="Menu"/>'
    repository.write({PATH: WORLD.replace("    <physics", f"    {plugin}\n    <physics")})
    assert sentences(subject(compare(repository), PATH)) == [
        "world yard plugin Entity context menu filename=Menu added"
    ]


HOUSE = """<sdf version="1.9"><world name="house">
{links}
<include><name>box</name><pose>1 0 0 0 0 0</pose><uri>model://crate</uri></include>
<include><pose>2 0 0 0 0 0</pose><uri>model://lamp</uri></include>
</world></sdf>
""".format(
    links="\n".join(
        f'<model name="m{n}"><link name="wall_{n}"><visual name="v{n}"><transparency>0.5</transparency></visual></link>'
        "</model>"
        for n in range(4)
    )
)


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("<name>box<", "<name>crate_1<", ["world house include crate_1 name: box -> crate_1"], True),
        ("<include><pose>2", "<include><name>lamp_1</name><pose>2",
         ["world house include lamp_1 name lamp_1 added"], False),
        ("<include><name>box</name><pose>1 0 0 0 0 0</pose><uri>model://crate</uri></include>", "",
         ["world house include box removed: pose 1 0 0 0 0 0, uri model://crate"], True),
        ("<include><pose>2 0 0 0 0 0</pose><uri>model://lamp</uri></include>", "",
         ["world house include model://lamp removed: pose 2 0 0 0 0 0"], False),
        ("model://crate", "model://barrel", ["world house include box uri: model://crate -> model://barrel"], False),
        ("<include><pose>2", ("<include><name>lamp_1</name><uri>model://lamp</uri><pose>3 0  0 0 0 0</pose>"
         "<plugin name='p' filename='libp.so'><level>1</level></plugin></include><include><pose>2"),
         [("world house include lamp_1 added: uri model://lamp, pose 3 0 0 0 0 0, "
          "plugin 'p' (filename=libp.so, level 1)")], False),
    ],
)  # fmt: skip
def test_included_models_are_compared_by_address(repository, compare, old, new, expected, is_breaking):
    assert old in HOUSE
    repository.commit({PATH: HOUSE})
    repository.write({PATH: HOUSE.replace(old, new)})
    result = compare(repository)
    assert sentences(subject(result, PATH)) == expected
    assert bool(breaking(result)) is is_breaking


def test_equal_changes_at_different_places_are_one(repository, compare):
    repository.commit({PATH: HOUSE})
    repository.write({PATH: HOUSE.replace("0.5", "0.2")})
    (change,) = subject(compare(repository), PATH).changes
    assert str(change.sentence) == "world house model m0 link wall_0 visual v0 transparency: 0.5 -> 0.2"
    assert change.other_names[0] == "m1 link wall_1 visual v1"
    assert len(change.other_names) == 3


LIGHT = """<sdf version="1.6">
  <world name="yard">
    <light name="sun" type="point"><cast_shadows>1</cast_shadows><pose frame="">0 0 9 0 0 0</pose></light>
    <plugin name="p" filename="p.so"><mode>1</mode></plugin>
  </world>
</sdf>
"""


@pytest.mark.parametrize(
    ("old", "new"), [(">1</cast", ">true</cast"), (' frame=""', ""), (' frame=""', ' relative_to=""')]
)
def test_equal_values_in_other_words_are_no_change(repository, compare, old, new):
    repository.commit({PATH: LIGHT})
    repository.write({PATH: LIGHT.replace(old, new)})
    assert compare(repository).subjects == []


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (">1</cast", ">false</cast", "world yard light sun cast_shadows: 1 -> false"),
        (' frame=""', ' frame="a"', "world yard light sun pose @frame: (empty) -> a"),
        (">1</mode", ">true</mode", "world yard plugin p mode: 1 -> true"),
    ],
)
def test_other_truth_value_or_frame_is_a_change(repository, compare, old, new, expected):
    repository.commit({PATH: LIGHT})
    repository.write({PATH: LIGHT.replace(old, new)})
    assert sentences(subject(compare(repository), PATH)) == [expected]


SPACED = '<sdf version="1.9"><world name="yard"><model name="big robot"><link name="base"/></model></world></sdf>\n'


@pytest.mark.parametrize(
    ("new", "sentence"),
    [
        (SPACED.replace("big robot", "robot"), "world yard model big robot renamed to 'robot'"),
        ('<sdf version="1.9"><world name="yard"/></sdf>\n', "world yard model big robot removed"),
    ],
)
def test_model_whose_name_has_spaces_is_breaking_as_others(package, compare, new, sentence):
    package.commit({PATH: SPACED})
    package.write({PATH: new})
    assert any(item.startswith(sentence) for item in breaking(compare(package)))


@pytest.mark.parametrize(("plugin", "is_breaking"), [("", True), ('<plugin name="p" filename="libray.so"/>', False)])
def test_topic_that_replaces_the_default_topic_of_a_sensor_is_breaking(package, compare, plugin, is_breaking):
    world = WORLD.replace("<topic>scan</topic>", plugin)
    package.commit({PATH: world})
    package.write({PATH: world.replace('type="gpu_lidar">', 'type="gpu_lidar"><topic>scan</topic>')})
    assert bool(breaking(compare(package))) is is_breaking


def test_topic_of_a_sensor_in_a_macro_is_breaking(package, compare):
    path = "arm_description/urdf/imu.xacro"
    macro = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="imu" params="">
  <gazebo reference="imu_link"><sensor name="imu" type="imu"><update_rate>10</update_rate></sensor></gazebo>
</xacro:macro></robot>
"""
    package.commit({path: macro})
    package.write({path: macro.replace("<update", "<topic>imu/data</topic><update")})
    assert breaking(compare(package)) == ["macro 'imu': gazebo imu_link sensor imu topic imu/data added"]


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("<range>", "<range>+", "sensor lidar lidar range text between its elements: (empty) -> +"),
        ("<topic>scan<", "<topic>laser<", "sensor lidar topic: scan -> laser"),
        ("</sensor>", "+<visualize>1</visualize></sensor>", "sensor lidar text between its elements: (empty) -> +"),
    ],
)
def test_text_between_elements_is_called_so(repository, compare, old, new, line):
    """It is a character that a patch left over, for example, and has no meaning."""
    repository.commit({PATH: WORLD})
    repository.write({PATH: WORLD.replace(old, new)})
    assert f"{ROBOT} link base {line}" in sentences(subject(compare(repository), PATH))


def test_added_element_is_shown_without_text_between_its_elements(repository, compare):
    repository.commit({PATH: WORLD.replace(SENSOR, "")})
    repository.write({PATH: WORLD.replace("<range>", "+<range>+")})
    (line,) = sentences(subject(compare(repository), PATH))
    assert "+" not in line


@pytest.mark.parametrize(
    ("name", "model", "is_renamed"), [("wide_yard", "robot", True), ("field", "robot", False), ("yard2", "car", False)]
)
def test_world_that_takes_the_place_of_another_one_is_compared_with_it(repository, compare, name, model, is_renamed):
    light = '<light name="lamp" type="point"/>'
    world = f"""<sdf version="1.9"><world name="{name}"><gravity>0 0 -3.7</gravity>{light}
  <physics type="ode"><real_time_update_rate>100</real_time_update_rate><max_step_size>0.01</max_step_size>
    <ode><solver><type>quick</type></solver></ode></physics><scene><ambient>1 1 1 1</ambient></scene>
  <model name="{model}"/></world></sdf>"""
    repository.commit({PATH: WORLD})
    repository.write({PATH: None, f"w/worlds/{name}.sdf": world})
    found = sentences(subject(compare(repository), f"w/worlds/{name}.sdf"))
    if is_renamed:
        assert "renamed from w/worlds/yard.sdf" in found
    else:
        lines = f"models {model}, lights lamp, physics real_time_update_rate 100, max_step_size 0.01, gravity 0 0 -3.7"
        assert found == [f"world added: {lines}"]
        assert sentences(subject(compare(repository), PATH)) == [
            (
                "world removed: models robot, physics max_step_size 0.001, "
                "sensor 'lidar' (type=gpu_lidar, topic scan, gz_frame_id laser, lidar range max 9), "
                "plugin 'drive' (filename=libgazebo_ros_diff_drive.so, ros remapping cmd_vel:=drive/cmd, topics 'odom')"
            )
        ]


AXES = """    <model name="axes">
      <static>1</static>
      <link name="link"><visual name="r"><geometry><box><size>9 0.1 0.1</size></box></geometry></visual></link>
    </model>
"""


@pytest.mark.parametrize(
    ("part", "old", "is_breaking"),
    [
        ("", "", False),
        ("<static>1</static>", "", True),
        ('<visual name="r">', '<collision name="c"/><visual name="r">', True),
        ('<pose relative_to="base">', '<pose relative_to="axes::link">', True),
    ],
)
def test_removed_static_model_of_visuals_breaks_nothing(repository, compare, part, old, is_breaking):
    text = WORLD.replace('    <model name="robot">\n', f'{AXES}    <model name="robot">\n')
    text = text.replace(part, old)
    repository.commit({PATH: text})
    model = text[text.index('    <model name="axes">') : text.index('    <model name="robot">')]
    repository.write({PATH: text.replace(model, "")})
    result = compare(repository)
    assert any(sentence.startswith("world yard model axes removed") for sentence in sentences(subject(result, PATH)))
    assert any("axes" in sentence for sentence in breaking(result)) is is_breaking
