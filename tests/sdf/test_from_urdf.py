"""The conversion of a robot from URDF, as in gz."""

from __future__ import annotations

import json
from math import pi
from pathlib import Path

import pytest

from linkwright.descriptions import examine
from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.shapes import Box
from linkwright.geometry.single import Pose
from linkwright.sdf.frames import Frames
from linkwright.sdf.from_urdf import model_from_robot
from linkwright.sdf.materials import MaterialScript
from linkwright.sdf.poses import RawPose
from linkwright.sdf.references import check_references
from linkwright.sdf.shapes import Mesh
from linkwright.sdf.worlds import Sdf

SHARED = Path(__file__).parents[3] / "shared"
INERTIAL = '<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'


def make_robot(elements):
    description = examine(f'<robot name="r">{elements}</robot>')
    assert description.diagnostics == ()
    return description.robot


def convert_robot(elements, *, lump=False):
    """Return the model of a robot without errors."""
    conversion = model_from_robot(make_robot(elements), lump_fixed_joints=lump)
    assert conversion.diagnostics == ()
    return conversion.model


def link_xml(name, elements="", *, inertial=INERTIAL):
    return f'<link name="{name}">{inertial}{elements}</link>'


def joint_xml(name, parent, child, *, kind="fixed", origin="0 0 0", rpy="0 0 0", elements=""):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{origin}" rpy="{rpy}"/>{elements}</joint>'
    )


BOX = '<geometry><box size="1 2 3"/></geometry>'
SHAPES = f"<visual>{BOX}</visual><collision>{BOX}</collision>"
LIMIT_TEXT = '<limit lower="-1" upper="2" effort="3" velocity="4"/>'


def test_links_are_placed_at_joints():
    model = convert_robot(link_xml("a") + link_xml("b") + joint_xml("j", "a", "b", origin="1 2 3", rpy=f"0 0 {pi / 2}"))
    assert [(link.name, link.pose.relative_to) for link in model.links] == [("a", ""), ("b", "j")]
    assert model.joints[0].pose == RawPose(Pose((1.0, 2.0, 3.0), (0.0, 0.0, pi / 2)), "a")
    assert (model.joints[0].type, model.joints[0].parent, model.joints[0].child) == ("fixed", "a", "b")
    assert Frames(model).pose("b")[:3] == (1.0, 2.0, 3.0)


@pytest.mark.parametrize(
    ("kind", "expected", "lower", "upper"),
    [
        ("revolute", "revolute", -1.0, 2.0),
        ("continuous", "revolute", float("-inf"), float("inf")),
        ("prismatic", "prismatic", -1.0, 2.0),
    ],
)
def test_movable_joint_has_axis_limits_and_dynamics(kind, expected, lower, upper):
    elements = f'<axis xyz="0 1 0"/>{LIMIT_TEXT}<dynamics damping="0.5" friction="0.25"/>'
    converted_joint = convert_robot(
        link_xml("a") + link_xml("b") + joint_xml("j", "a", "b", kind=kind, elements=elements)
    ).joints[0]
    assert converted_joint.type == expected
    assert converted_joint.axis is not None
    assert converted_joint.axis.xyz == (0.0, 1.0, 0.0)
    limit = converted_joint.axis.limit
    assert (limit.lower, limit.upper, limit.effort, limit.velocity) == (lower, upper, 3.0, 4.0)
    assert (converted_joint.axis.dynamics.damping, converted_joint.axis.dynamics.friction) == (0.5, 0.25)


def test_mimic_joint_is_converted():
    leader = joint_xml("j", "a", "b", kind="revolute", elements=LIMIT_TEXT)
    elements = LIMIT_TEXT + '<mimic joint="j" multiplier="-2" offset="0.5"/>'
    model = convert_robot(
        link_xml("a")
        + link_xml("b")
        + link_xml("c")
        + leader
        + joint_xml("k", "a", "c", kind="revolute", elements=elements)
    )
    axis = next(joint.axis for joint in model.joints if joint.name == "k")
    assert axis is not None
    assert axis.mimic is not None
    assert (axis.mimic.joint, axis.mimic.multiplier, axis.mimic.offset) == ("j", -2.0, 0.5)


def test_root_named_world_becomes_world():
    model = convert_robot(
        '<link name="world"/>' + link_xml("a") + joint_xml("j", "world", "a", origin="0 0 1"), lump=True
    )
    assert [link.name for link in model.links] == ["a"]
    assert (model.joints[0].parent, model.joints[0].pose.relative_to) == ("world", "__model__")
    assert Frames(model).pose("a")[:3] == (0.0, 0.0, 1.0)
    assert check_references(Sdf("1.11", models=(model,))) == []


def test_floating_and_planar_links_move_freely():
    robot = make_robot(
        link_xml("a") + link_xml("b") + link_xml("c")
        + joint_xml("f", "a", "b", kind="floating", origin="1 0 0") + joint_xml("p", "a", "c", kind="planar")
    )  # fmt: skip
    conversion = model_from_robot(robot, lump_fixed_joints=False)
    assert conversion.model.joints == ()
    assert Frames(conversion.model).pose("b")[:3] == (1.0, 0.0, 0.0)
    assert [(diagnostic.code, str(diagnostic.message)) for diagnostic in conversion.diagnostics] == [
        ("SDF171", "joint 'p' is left out, because SDF does not support planar joints")
    ]


def test_shape_names_match_gz():
    elements = f"<visual>{BOX}</visual><visual>{BOX}</visual>" + f'<visual name="a_top">{BOX}</visual>'
    model = convert_robot(
        link_xml("a", elements + f'<visual name="lid">{BOX}</visual>' + f"<collision>{BOX}</collision>")
    )
    names = [visual.name for visual in model.links[0].visuals]
    assert names == ["a_visual", "a_visual_1", "a_top_visual_2", "a_fixed_joint_lump__lid_visual_3"]
    assert [collision.name for collision in model.links[0].collisions] == ["a_collision"]
    assert model.links[0].visuals[0].geometry == Box((1.0, 2.0, 3.0))


def test_mesh_uris_are_preserved():
    geometry = '<geometry><mesh filename="package://p/m.dae" scale="1 2 3"/></geometry>'
    model = convert_robot(link_xml("a", f"<visual>{geometry}</visual>"))
    assert model.links[0].visuals[0].geometry == Mesh("package://p/m.dae", (1.0, 2.0, 3.0))


def test_colors_match_gz_and_gazebo_material_overrides():
    visual = f'<visual>{BOX}<material name="m"><color rgba="0.4 0.8 1 0.5"/></material></visual>'
    material = convert_robot(link_xml("a", visual)).links[0].visuals[0].material
    assert material is not None
    assert material.diffuse == material.ambient == pytest.approx((0.5, 1.0, 1.0, 0.5))
    text = '<gazebo reference="a"><visual><material><diffuse>1 0 0 1</diffuse></material></visual></gazebo>'
    material = convert_robot(link_xml("a", visual) + text).links[0].visuals[0].material
    assert material is not None
    assert (material.ambient, material.diffuse) == (None, (1.0, 0.0, 0.0, 1.0))


def test_gazebo_material_becomes_script():
    model = convert_robot(link_xml("a", SHAPES) + '<gazebo reference="a"><material>Gazebo/Blue</material></gazebo>')
    material = model.links[0].visuals[0].material
    assert material is not None
    assert material.script == MaterialScript(("file://media/materials/scripts/gazebo.material",), "Gazebo/Blue")
    assert material.diffuse == (0, 0, 1, 1)


def test_gazebo_material_overrides_visual_color():
    visual = f'<visual>{BOX}<material name="m"><color rgba="0.4 0.8 1 0.5"/></material></visual>'
    for name, diffuse in (("Gazebo/Red", (1, 0, 0, 1)), ("Mine/Red", (0.5, 1.0, 1.0, 0.5))):
        model = convert_robot(link_xml("a", visual) + f'<gazebo reference="a"><material>{name}</material></gazebo>')
        material = model.links[0].visuals[0].material
        assert material is not None
        assert material.diffuse == pytest.approx(diffuse)


def test_gazebo_elements_apply_to_links_and_collisions():
    texts_by_tag = {
        "mu1": "0.1", "mu2": "0.2", "fdir1": "1 0 0", "kp": "1000", "kd": "2", "minDepth": "0.003", "maxVel": "4",
        "maxContacts": "5", "laserRetro": "6", "selfCollide": "Yes", "turnGravityOff": "true", "dampingFactor": "0.7",
        "canonicalBody": "a",
    }  # fmt: skip
    elements = "".join(f"<{tag}>{text}</{tag}>" for tag, text in texts_by_tag.items())
    converted_model = convert_robot(link_xml("a", SHAPES + f'<collision name="own">{BOX}</collision>')
                      + f'<gazebo reference="a">{elements}</gazebo>').links[0]  # fmt: skip
    for collision in converted_model.collisions:
        friction, contact = collision.surface.friction, collision.surface.contact
        assert friction is not None
        assert contact is not None
        assert (friction.mu, friction.mu2, friction.direction) == (0.1, 0.2, (1.0, 0.0, 0.0))
        assert (contact.kp, contact.kd, contact.min_depth, contact.max_vel) == (1000.0, 2.0, 0.003, 4.0)
        assert (collision.max_contacts, collision.laser_retro) == (5, 6.0)
    assert (converted_model.self_collide, converted_model.gravity) == (True, False)
    assert (converted_model.velocity_decay.linear, converted_model.velocity_decay.angular) == (0.7, 0.7)


def test_gazebo_value_attribute_is_read_and_last_element_applies():
    text = '<gazebo reference="a"><mu1 value="0.1"/></gazebo><gazebo reference="a"><mu1> 0.3 </mu1></gazebo>'
    friction = convert_robot(link_xml("a", SHAPES) + text).links[0].collisions[0].surface.friction
    assert friction is not None
    assert friction.mu == 0.3


def test_collision_surface_and_gazebo_elements_are_merged():
    surface = "<surface><friction><ode><mu>0.5</mu><mu2>0.6</mu2></ode></friction></surface>"
    text = f'<gazebo reference="a"><collision>{surface}</collision><mu1>0.1</mu1></gazebo>'
    robot = make_robot(link_xml("a", SHAPES) + text)
    for _ in range(2):  # the conversion does not change the robot's elements
        friction = model_from_robot(robot, lump_fixed_joints=False).model.links[0].collisions[0].surface.friction
        assert friction is not None
        assert (friction.mu, friction.mu2) == (0.1, 0.6)
    assert [element.text() for element in robot.extensions[0].walk() if element.tag == "mu"] == ["0.5"]


def test_sensors_and_plugins_keep_locations():
    text = (
        '<robot name="r"><link name="a"/>\n'
        '<gazebo reference="a"><sensor name="s" type="imu"><update_rate>50</update_rate>'
        '<plugin name="p" filename="libp.so"/></sensor></gazebo>\n'
        '<gazebo><static>true</static><plugin name="q" filename="libq.so"><left_joint>l</left_joint></plugin></gazebo>'
        "</robot>"
    )
    model = model_from_robot(examine(text).robot, lump_fixed_joints=False).model
    sensor, plugin = model.links[0].sensors[0], model.plugins[0]
    assert (sensor.name, sensor.update_rate, sensor.plugins[0].filename) == ("s", 50.0, "libp.so")
    assert sensor.element.span().line == 2
    assert (plugin.name, plugin.element.span().line, plugin.element.first("left_joint").text()) == ("q", 3, "l")
    assert model.static


def test_gazebo_elements_and_sensors_apply_to_joints():
    text = (
        '<gazebo reference="j"><provideFeedback>1</provideFeedback><springStiffness>3</springStiffness>'
        "<springReference>0.5</springReference><implicitSpringDamper>true</implicitSpringDamper><stopErp>0.2</stopErp>"
        '<sensor name="ft" type="force_torque"/></gazebo>'
    )
    revolute = joint_xml("j", "a", "b", kind="revolute", elements=LIMIT_TEXT + '<dynamics damping="2"/>')
    converted_joint = convert_robot(link_xml("a") + link_xml("b") + revolute + text).joints[0]
    assert converted_joint.axis is not None
    dynamics = converted_joint.axis.dynamics
    assert (dynamics.spring_stiffness, dynamics.spring_reference, dynamics.damping) == (3.0, 0.5, 2.0)
    assert converted_joint.provide_feedback
    assert [sensor.type for sensor in converted_joint.sensors] == ["force_torque"]


def test_gazebo_joint_can_close_loop():
    loop = '<gazebo><joint name="loop" type="revolute"><parent>a</parent><child>b</child></joint></gazebo>'
    model = convert_robot(
        link_xml("a") + link_xml("b") + joint_xml("j", "a", "b", kind="revolute", elements=LIMIT_TEXT) + loop
    )
    assert [joint.name for joint in model.joints] == ["j", "loop"]


def test_invalid_gazebo_elements_are_reported_with_location():
    text = (
        f'<robot name="r"><link name="a">{INERTIAL}</link>\n<gazebo reference="a">\n'
        "<mu1>much</mu1>\n"
        '<sensor name="s" type="camera"><update_rate>fast</update_rate></sensor>\n'
        "<plugin filename='p.so'/>\n</gazebo></robot>"
    )
    diagnostics = model_from_robot(examine(text).robot, lump_fixed_joints=False).diagnostics
    assert [(diagnostic.code, diagnostic.span.line, str(diagnostic.message)) for diagnostic in diagnostics] == [
        ("SDF121", 3, "<mu1> of collision 'a' is not a number: 'much'"),
        ("SDF121", 4, "<update_rate> of sensor 's' is not a number: 'fast'"),
        ("SDF150", 5, "<plugin> in <link> is not read"),
    ]


def test_deeply_nested_gazebo_element_is_omitted():
    deeply_nested = "<model>" * 300 + "</model>" * 300
    robot = examine(f'<robot name="r">{link_xml("a")}<gazebo>{deeply_nested}</gazebo></robot>').robot
    conversion = model_from_robot(robot, lump_fixed_joints=False)
    assert [diagnostic.code for diagnostic in conversion.diagnostics] == ["SDF133"]
    assert conversion.model.models == ()


def test_lumped_links_become_frames_and_move_shapes_and_sensors():
    model = convert_robot(
        link_xml("base", SHAPES) + link_xml("arm") + link_xml("camera", SHAPES)
        + link_xml("optical", SHAPES, inertial="")
        + joint_xml("to_arm", "base", "arm", origin="1 0 0", rpy=f"0 0 {pi / 2}")
        + joint_xml("to_camera", "arm", "camera", origin="1 0 0")
        + joint_xml("to_optical", "camera", "optical", origin="0 0 1")
        + '<gazebo reference="camera"><sensor name="s" type="camera"><pose>0 0 2 0 0 0</pose></sensor>'
        "<mu1>0.5</mu1></gazebo>",
        lump=True,
    )  # fmt: skip
    assert [link.name for link in model.links] == ["base"]
    assert model.joints == ()
    frames = Frames(model)
    assert frames.pose("optical")[:3] == pytest.approx((1.0, 1.0, 1.0))
    assert [frame.name for frame in model.frames] == ["to_arm", "arm", "to_camera", "camera", "to_optical", "optical"]
    base = model.links[0]
    assert [visual.name for visual in base.visuals] == [
        "base_visual",
        "base_fixed_joint_lump__camera_visual_1",
        "base_fixed_joint_lump__optical_visual_2",
    ]
    assert base.collisions[1].pose.pose.xyz == pytest.approx((1.0, 1.0, 0.0))
    assert base.sensors[0].pose.pose.xyz == pytest.approx((1.0, 1.0, 2.0))
    frictions = [collision.surface.friction for collision in base.collisions]
    assert [friction.mu if friction else None for friction in frictions] == [None, 0.5, None]
    assert check_references(Sdf("1.11", models=(model,))) == []


def test_lumped_masses_are_combined():
    point = '<inertial><mass value="2"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial>'
    model = convert_robot(
        link_xml("a", inertial=point) + link_xml("b", inertial=point) + joint_xml("j", "a", "b", origin="2 0 0"),
        lump=True,
    )
    inertial = model.links[0].inertial
    assert inertial is not None
    assert (inertial.mass, inertial.pose.pose.xyz) == (4.0, (1.0, 0.0, 0.0))
    assert (inertial.inertia.ixx, inertial.inertia.iyy, inertial.inertia.izz) == pytest.approx((0.0, 4.0, 4.0))


def test_lumped_inertia_keeps_axes_of_first_link():
    rotated_link = (
        f'<inertial><origin rpy="0 0 {pi / 2}"/><mass value="1"/>'
        '<inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="2.5"/></inertial>'
    )
    no_inertia = '<inertial><mass value="0"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial>'
    model = convert_robot(
        link_xml("a", inertial=rotated_link) + link_xml("b", inertial=no_inertia) + joint_xml("j", "a", "b"),
        lump=True,
    )
    inertial = model.links[0].inertial
    assert inertial is not None
    assert (inertial.inertia.ixx, inertial.inertia.iyy, inertial.inertia.izz) == pytest.approx((1.0, 2.0, 2.5))


def test_child_of_lumped_link_is_attached_to_merged_link():
    revolute = joint_xml("j", "b", "c", kind="revolute", origin="0 1 0", elements=LIMIT_TEXT)
    model = convert_robot(
        link_xml("a") + link_xml("b") + link_xml("c") + joint_xml("k", "a", "b", origin="1 0 0") + revolute,
        lump=True,
    )
    assert [link.name for link in model.links] == ["a", "c"]
    assert (model.joints[0].parent, model.joints[0].pose.pose.xyz) == ("a", (1.0, 1.0, 0.0))
    assert Frames(model).pose("c")[:3] == (1.0, 1.0, 0.0)


@pytest.mark.parametrize(("tag", "kind"), [("preserveFixedJoint", "fixed"), ("disableFixedJointLumping", "revolute")])
def test_fixed_joint_can_be_preserved(tag, kind):
    text = f'<gazebo reference="j"><{tag}>true</{tag}></gazebo>'
    converted_joint = convert_robot(link_xml("a") + link_xml("b") + joint_xml("j", "a", "b") + text, lump=True).joints[
        0
    ]
    assert converted_joint.type == kind
    if converted_joint.axis is not None:
        assert (converted_joint.axis.limit.lower, converted_joint.axis.limit.upper) == (0.0, 0.0)


def test_massless_links_are_omitted_only_when_lumping():
    robot = make_robot(
        '<link name="footprint"/>' + link_xml("base") + '<link name="ghost"/>' + link_xml("tip")
        + joint_xml("f", "footprint", "base")
        + joint_xml("g", "base", "ghost", kind="continuous") + joint_xml("h", "ghost", "tip", kind="continuous")
    )  # fmt: skip
    unlumped = model_from_robot(robot, lump_fixed_joints=False)
    assert [link.name for link in unlumped.model.links] == ["footprint", "base", "ghost", "tip"]
    assert [diagnostic.code for diagnostic in unlumped.diagnostics] == ["SDF172"]
    lumped = model_from_robot(robot, lump_fixed_joints=True)
    assert [link.name for link in lumped.model.links] == ["footprint"]
    assert [(diagnostic.code, str(diagnostic.message)) for diagnostic in lumped.diagnostics] == [
        ("SDF170", "link 'ghost' has no mass, so it is left out with all links below it")
    ]


def test_sensor_of_lumped_joint_is_reported():
    text = '<gazebo reference="j"><sensor name="ft" type="force_torque"/></gazebo>'
    conversion = model_from_robot(
        make_robot(link_xml("a") + link_xml("b") + joint_xml("j", "a", "b") + text), lump_fixed_joints=True
    )
    assert [(diagnostic.code, str(diagnostic.message)) for diagnostic in conversion.diagnostics] == [
        ("SDF171", "sensor 'ft' is left out, because the links of joint 'j' are merged")
    ]


def test_joint_with_name_of_link_is_converted():
    robot = make_robot(link_xml("a") + link_xml("b") + link_xml("c")
                     + joint_xml("b", "a", "b", origin="1 0 0", kind="continuous")
                     + joint_xml("c", "b", "c", origin="0 1 0"))  # fmt: skip
    for lump in (False, True):
        conversion = model_from_robot(robot, lump_fixed_joints=lump)
        assert Frames(conversion.model).pose("c")[:3] == (1.0, 1.0, 0.0)
        assert {diagnostic.code for diagnostic in conversion.diagnostics} == {"SDF171"}


def test_long_chain_of_links_is_converted():
    count = 3000
    robot = make_robot(
        "".join(link_xml(f"l{i}") for i in range(count))
        + "".join(joint_xml(f"j{i}", f"l{i}", f"l{i + 1}", origin="1 0 0") for i in range(count - 1))
    )
    assert len(model_from_robot(robot, lump_fixed_joints=False).model.links) == count
    lumped = model_from_robot(robot, lump_fixed_joints=True).model
    assert len(lumped.links) == 1
    assert lumped.links[0].inertial.mass == count


def _find_real_robots():
    """Return real robots outside the repository: name, file, arguments, packages, known facts."""
    for folder, subfolder in (("worlds", ""), ("corpus", "robots")):
        manifest = SHARED / folder / "manifest.json"
        if not manifest.is_file():
            continue
        data = json.loads(manifest.read_text(encoding="utf-8"))
        root = SHARED / folder / subfolder
        named = data.get("packages") or {
            name: path for source in data["sources"].values() for name, path in source["packages"].items()
        }
        packages = {name: root / path for name, path in named.items()}
        for item in data.get("models") or data["items"]:
            if item.get("kind", "robot") == "robot" and ".sdf" not in item["entry"]:
                arguments = item.get("arguments") or item.get("args") or {}
                entry = root / item["entry"]
                facts = item.get("facts")
                yield pytest.param(entry, arguments, packages, facts, id=f"{folder}/{item.get('name', entry.name)}")


@pytest.mark.parametrize(("entry", "arguments", "packages", "facts"), list(_find_real_robots()))
def test_corpus_robots_are_converted(entry, arguments, packages, facts):
    try:
        robot = examine(entry, arguments=arguments, packages=packages).robot
    except LinkwrightError:
        return  # some need arguments, or are parts of other descriptions
    if robot is None:
        return
    for lump in (False, True):
        conversion = model_from_robot(robot, lump_fixed_joints=lump)
        model = conversion.model
        assert [diagnostic for diagnostic in conversion.diagnostics if diagnostic.severity.value == "error"] == []
        references = {check_reference.code for check_reference in check_references(Sdf("1.11", models=(model,)))}
        assert references <= {"SDF132"}, "a robot without masses has no links"
        frames = Frames(model)
        for name in robot.links:
            if name != "world" and (name in frames.elements_by_name or not lump):
                frames.pose(name)
        if facts is not None and not lump:
            sensors = [sensor for link in model.links for sensor in link.sensors]
            assert len(model.links) == facts["links"] - ("world" in robot.links)
            assert len(model.joints) == sum(facts["joints"].values())
            assert {sensor.name for sensor in sensors} == {sensor["name"] for sensor in facts["sensors"]}
            plugins = sum(element.tag == "plugin" for gazebo in robot.extensions if "reference" not in gazebo.attributes
                          for element in gazebo.elements())  # fmt: skip
            assert len(model.plugins) == plugins
            assert sum(len(link.visuals) for link in model.links) == sum(facts["visuals"].values())
            assert sum(len(link.collisions) for link in model.links) == sum(facts["collisions"].values())


def test_kept_massless_link_gets_negligible_mass():
    mass = '<inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
    text = (
        f'<robot name="r"><link name="a"/><link name="b">{mass}</link><link name="c"/><link name="d"/>'
        '<joint name="ab" type="fixed"><parent link="a"/><child link="b"/></joint>'
        '<joint name="bc" type="fixed"><parent link="b"/><child link="c"/></joint>'
        '<joint name="bd" type="continuous"><parent link="b"/><child link="d"/></joint></robot>'
    )
    a, b, c, d = model_from_robot(examine(text).robot, lump_fixed_joints=False).model.links
    assert [link.inertial.mass for link in (a, b, c)] == [1e-6, 2.0, 1e-6]
    assert d.inertial is None


def test_movable_massless_links_are_reported_once():
    arms = "".join(
        link_xml(name, inertial="") + joint_xml(f"{name}_joint", "a", name, kind="floating") for name in "bc"
    )
    robot = make_robot(link_xml("a") + link_xml("plate", inertial="") + joint_xml("fixed_joint", "a", "plate") + arms)
    (finding,) = model_from_robot(robot, lump_fixed_joints=False).diagnostics
    assert finding.code == "SDF172"
    assert str(finding.message).endswith("gz leaves them out: 'b', 'c'")
