"""The reader of SDF, for each part of the format."""

from __future__ import annotations

from dataclasses import MISSING, fields, is_dataclass
from math import inf, isclose, pi, radians

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.geometry.single import Pose
from linkwright.schema import ElementRule, reader_of
from linkwright.sdf import shapes
from linkwright.sdf.joints import AxisDynamics, AxisLimit, AxisMimic
from linkwright.sdf.lights import Attenuation, Spot
from linkwright.sdf.links import Inertia
from linkwright.sdf.materials import MaterialScript
from linkwright.sdf.noise import Noise, NoiseXyz
from linkwright.sdf.poses import RawPose
from linkwright.sdf.reader import read
from linkwright.sdf.report import NEWEST_VERSION, SdfReport
from linkwright.sdf.sensors import Reach, Sweep
from linkwright.sdf.surfaces import Contact, Friction, Surface, TorsionalFriction
from linkwright.sdf.text import parse_as_gazebo
from linkwright.sdf.worlds import SDF, World, find_gravity, find_physics
from linkwright.xmltree import Comment, Element
from tests.sdf.worlds import make_model_text, make_world_text


def collect_rules(rule: ElementRule, visited: dict[int, ElementRule]) -> dict[int, ElementRule]:
    """Return a rule and all rules below it by ID, each once."""
    if id(rule) not in visited:
        visited[id(rule)] = rule
        for child in rule.children:
            collect_rules(child, visited)
    return visited


OBJECT_RULES = [rule for rule in collect_rules(SDF, {}).values() if is_dataclass(rule.make)]


@pytest.mark.parametrize("rule", OBJECT_RULES, ids=[f"{rule.tag}{number}" for number, rule in enumerate(OBJECT_RULES)])
def test_empty_element_has_class_defaults(rule: ElementRule):
    """The table and the classes have the same defaults, which are SDF's."""
    element = Element(rule.tag, {attribute.name: "n" for attribute in rule.attributes if attribute.required})
    element_object = reader_of(rule, NEWEST_VERSION).read(element, element, SdfReport())
    own_defaults = {field.name: field.default for field in fields(rule.make) if field.default is not MISSING}
    if isinstance(rule.default, rule.make):
        own_defaults = {name: getattr(rule.default, name) for name in own_defaults}
    own_defaults.pop("element", None)
    written = {attribute.target for attribute in rule.attributes if attribute.required}
    assert {name: getattr(element_object, name) for name in own_defaults if name not in written} == {
        name: value for name, value in own_defaults.items() if name not in written
    }


def test_pose_accepts_radians_degrees_and_quaternion():
    assert make_model_text("<pose>1 2 3 0.1 0.2 0.3</pose>").pose == RawPose(Pose((1, 2, 3), (0.1, 0.2, 0.3)))
    turned = make_model_text('<pose degrees="true">0 0 0 90 0 -45</pose>').pose.pose
    assert turned.rpy == (radians(90), 0, radians(-45))
    half_turn = make_model_text('<pose rotation_format="quat_xyzw">0 0 1  0 0 2 0</pose>').pose.pose
    assert half_turn.quaternion == (0, 0, 1, 0)
    assert isclose(abs(half_turn.rpy[2]), pi)


def test_pose_accepts_old_frame_attribute():
    assert make_model_text('<link name="a"/><link name="b"><pose frame="a"/></link>').links[1].pose.relative_to == "a"
    assert (
        make_model_text('<link name="a"/><link name="b"><pose relative_to="a"/></link>').links[1].pose.relative_to
        == "a"
    )


@pytest.mark.parametrize(
    ("text", "shape"),
    [
        ("<box><size>1 2 3</size></box>", Box((1, 2, 3))),
        ("<box/>", Box((1, 1, 1))),
        ("<sphere><radius>2</radius></sphere>", Sphere(2)),
        ("<cylinder><radius>2</radius><length>3</length></cylinder>", Cylinder(2, 3)),
        ("<capsule><radius>2</radius></capsule>", Capsule(2, 1)),
        ("<cone><length>2</length></cone>", shapes.Cone(0.5, 2)),
        ("<ellipsoid><radii>1 2 3</radii></ellipsoid>", shapes.Ellipsoid((1, 2, 3))),
        ("<plane><normal>0 1 0</normal><size>2 3</size></plane>", shapes.Plane((0, 1, 0), (2, 3))),
        (
            "<mesh><uri>a.dae</uri><scale>2 2 2</scale><submesh><name>s</name><center>1</center></submesh></mesh>",
            shapes.Mesh("a.dae", (2, 2, 2), shapes.Submesh("s", center=True)),
        ),
        ("<image><uri>a.png</uri><threshold>100</threshold></image>", shapes.Image("a.png", threshold=100)),
        (
            "<heightmap><uri>h.png</uri><size>8 8 1</size><texture><size>4</size></texture><blend/></heightmap>",
            shapes.Heightmap("h.png", (8, 8, 1), textures=(shapes.TerrainTexture(size=4),), blends=(shapes.Blend(),)),
        ),
        (
            "<polyline><point>0 0</point><point>1 0</point><point>0 1</point><height>2</height></polyline>",
            (shapes.Polyline(((0, 0), (1, 0), (0, 1)), 2),),
        ),
        ("<empty/>", shapes.Empty()),
        ("", shapes.Empty()),
    ],
)
def test_shapes_are_read(text, shape):
    part = make_model_text(f'<link name="a"><collision name="c"><geometry>{text}</geometry></collision></link>')
    assert part.links[0].collisions[0].geometry == shape


def test_link_is_read():
    link = make_model_text(
        """<link name="a"><pose>0 0 1 0 0 0</pose><gravity>0</gravity><kinematic>true</kinematic>
        <inertial auto="TRUE"><mass>2</mass><pose>0 0 .5 0 0 0</pose><inertia><ixx>3</ixx><ixy>.1</ixy></inertia>
        <density>700</density></inertial>
        <velocity_decay><linear>.1</linear></velocity_decay></link>"""
    ).links[0]
    assert (link.gravity, link.kinematic, link.self_collide) == (False, True, None)
    assert (link.velocity_decay.linear, link.velocity_decay.angular) == (0.1, 0)
    inertial = link.inertial
    assert inertial is not None
    assert (inertial.mass, inertial.auto, inertial.density) == (2, True, 700)
    assert inertial.inertia == Inertia(3, 1, 1, 0.1)
    assert inertial.pose.pose.xyz == (0, 0, 0.5)


def test_material_is_read():
    material = (
        make_model_text(
            """<link name="a"><visual name="v"><transparency>.5</transparency><material>
        <ambient>1 0 0</ambient><diffuse>1 0 0 .5</diffuse><lighting>0</lighting>
        <script><uri>file://a</uri><uri>file://b</uri><name>Gazebo/Grey</name></script>
        <shader type="normal_map_object_space"><normal_map>n.png</normal_map></shader>
        <pbr><metal><albedo_map>a.png</albedo_map><roughness>.2</roughness></metal></pbr></material></visual></link>"""
        )
        .links[0]
        .visuals[0]
        .material
    )
    assert material is not None
    assert (material.ambient, material.diffuse, material.specular) == ((1, 0, 0, 1), (1, 0, 0, 0.5), None)
    assert material.lighting is False
    assert material.script == MaterialScript(("file://a", "file://b"), "Gazebo/Grey")
    assert material.shader is not None
    assert material.shader.type == "normal_map_object_space"
    assert material.pbr is not None
    assert material.pbr.specular is None
    assert material.pbr.metal is not None
    assert (material.pbr.metal.albedo_map, material.pbr.metal.roughness) == ("a.png", 0.2)


def test_surface_is_read():
    surface = (
        make_model_text(
            """<link name="a"><collision name="c"><laser_retro>9</laser_retro><surface>
        <friction><ode><mu>.5</mu><fdir1 ignition:expressed_in="b">1 0 0</fdir1><slip2>.1</slip2></ode>
        <torsional><coefficient>2</coefficient></torsional></friction>
        <contact><collide_bitmask>3</collide_bitmask><ode><kp>1e5</kp></ode></contact>
        <bounce><restitution_coefficient>.9</restitution_coefficient><threshold>.1</threshold></bounce>
        </surface></collision></link>""".replace("<link ", '<link xmlns:ignition="i" ')
        )
        .links[0]
        .collisions[0]
        .surface
    )
    friction = Friction(0.5, 1.0, (1, 0, 0), 0.0, 0.1, "b")
    assert surface == Surface(
        friction=friction,
        torsional=TorsionalFriction(2),
        contact=Contact(kp=1e5),
        restitution=0.9,
        bounce_threshold=0.1,
        collide_bitmask=3,
    )


def test_joint_is_read():
    joint = make_model_text(
        """<link name="a"/><link name="b"/><joint name="j" type="revolute"><parent> a </parent><child>b</child>
        <pose relative_to="a">0 0 1 0 0 0</pose><axis><xyz expressed_in="a">0 1 0</xyz>
        <limit><lower>-1e16</lower><upper>2</upper><effort>-1</effort><velocity>3</velocity></limit>
        <dynamics><damping>.1</damping><spring_stiffness>5</spring_stiffness></dynamics>
        <mimic joint="k"><multiplier>2</multiplier><reference>.1</reference></mimic></axis>
        <physics><ode><provide_feedback>1</provide_feedback></ode></physics></joint>"""
    ).joints[0]
    assert (joint.type, joint.parent, joint.child, joint.pose.relative_to) == ("revolute", "a", "b", "a")
    assert joint.provide_feedback
    assert joint.axis2 is None
    axis = joint.axis
    assert axis is not None
    assert (axis.xyz, axis.expressed_in) == ((0, 1, 0), "a")
    assert axis.limit == AxisLimit(-inf, 2, inf, 3)
    assert axis.dynamics == AxisDynamics(damping=0.1, spring_stiffness=5)
    assert axis.mimic == AxisMimic("k", multiplier=2, reference=0.1)


def test_screw_pitch_is_read_from_old_and_new_element():
    ends = "<parent>a</parent><child>b</child>"
    inside = '<link name="a"/><link name="b"/><joint name="j" type="screw">{}</joint>'
    new = make_model_text(inside.format(f"{ends}<screw_thread_pitch>.01</screw_thread_pitch>")).joints[0]
    old = make_model_text(inside.format(f"{ends}<thread_pitch>{-2 * pi / 0.01}</thread_pitch>")).joints[0]
    assert new.thread_pitch == 0.01
    assert old.thread_pitch is not None
    assert isclose(old.thread_pitch, 0.01)


def test_lidar_is_read_from_ray_and_lidar_element():
    scan = """<scan><horizontal><samples>360</samples><min_angle>-3</min_angle><max_angle>3</max_angle></horizontal>
        </scan><range><min>.1</min><max>8</max></range><noise><stddev>.01</stddev></noise>"""
    for word in ("ray", "lidar"):
        sensor = (
            make_model_text(
                f"""<link name="a"><sensor name="s" type="gpu_lidar"><update_rate>5</update_rate><topic>scan</topic>
            <gz_frame_id>f</gz_frame_id><{word}>{scan}</{word}></sensor></link>"""
            )
            .links[0]
            .sensors[0]
        )
        assert (sensor.type, sensor.update_rate, sensor.topic, sensor.frame_id) == ("gpu_lidar", 5, "scan", "f")
        lidar = sensor.lidar
        assert lidar is not None
        assert lidar.horizontal == Sweep(360, 1, -3, 3)
        assert lidar.vertical == Sweep(1, 1, 0, 0)
        assert lidar.range == Reach(0.1, 8)
        assert lidar.noise == Noise("gaussian", 0, 0.01)


def test_camera_is_read():
    camera = (
        make_model_text(
            """<link name="a"><sensor name="s" type="rgbd_camera"><camera name="c"><horizontal_fov>1</horizontal_fov>
        <image><width>64</width><height>48</height><format>L8</format></image><clip><near>.2</near></clip>
        <distortion><k1>.1</k1></distortion><depth_camera><clip><far>5</far></clip></depth_camera>
        <lens><intrinsics><fx>50</fx></intrinsics></lens><noise><type>gaussian</type><mean>1</mean></noise>
        </camera></sensor></link>"""
        )
        .links[0]
        .sensors[0]
        .cameras[0]
    )
    assert (camera.name, camera.horizontal_fov) == ("c", 1)
    assert (camera.image.width, camera.image.height, camera.image.format) == (64, 48, "L8")
    assert (camera.clip.near, camera.clip.far) == (0.2, 100)
    assert camera.depth_clip is not None
    assert camera.depth_clip.far == 5
    assert camera.distortion is not None
    assert camera.distortion.k1 == 0.1
    assert camera.intrinsics is not None
    assert camera.intrinsics.fx == 50
    assert camera.noise == Noise("gaussian", 1)


def test_imu_and_navsat_are_read():
    noise = '<noise type="gaussian"><stddev>{}</stddev></noise>'
    imu, gps = (
        make_model_text(
            f"""<link name="a"><sensor name="i" type="imu"><imu>
        <angular_velocity><x>{noise.format(1)}</x><z>{noise.format(3)}</z></angular_velocity>
        <orientation_reference_frame><localization>NED</localization></orientation_reference_frame></imu></sensor>
        <sensor name="g" type="gps"><gps><position_sensing><vertical>{noise.format(2)}</vertical></position_sensing>
        </gps></sensor></link>"""
        )
        .links[0]
        .sensors
    )
    assert imu.imu is not None
    assert imu.imu.angular_velocity == NoiseXyz(Noise("gaussian", 0, 1), z=Noise("gaussian", 0, 3))
    assert imu.imu.localization == "NED"
    assert gps.navsat is not None
    assert gps.navsat.vertical_position.stddev == 2


def test_light_is_read():
    light = make_world_text(
        """<light name="l" type="spot"><pose>0 0 5 0 0 0</pose><diffuse>1 .5 0 1</diffuse><cast_shadows>1</cast_shadows>
        <attenuation><range>20</range></attenuation><spot><inner_angle>.1</inner_angle><outer_angle>.5</outer_angle>
        <falloff>1</falloff></spot></light>"""
    ).lights[0]
    assert (light.type, light.cast_shadows, light.diffuse) == ("spot", True, (1, 0.5, 0, 1))
    assert light.attenuation == Attenuation(20)
    assert light.spot == Spot(0.1, 0.5, 1)


def test_actor_is_read():
    actor = make_world_text(
        """<actor name="a"><skin><filename>walk.dae</filename></skin><animation name="walking">
        <filename>walk.dae</filename><interpolate_x>true</interpolate_x></animation><script><loop>0</loop>
        <delay_start>2</delay_start><trajectory id="0" type="walking"><waypoint><time>0</time><pose>0 0 1 0 0 0</pose>
        </waypoint><waypoint><time>4.5</time><pose>1 0 1 0 0 0</pose></waypoint></trajectory></script></actor>"""
    ).actors[0]
    assert actor.skin is not None
    assert actor.skin.filename == "walk.dae"
    assert actor.animations[0].interpolate_x
    assert (actor.script.loop, actor.script.delay_start) == (False, 2)
    path = actor.script.trajectories[0]
    assert [(waypoint.time, waypoint.pose.pose.xyz) for waypoint in path.waypoints] == [
        (0, (0, 0, 1)),
        (4.5, (1, 0, 1)),
    ]


def test_plugins_keep_parameters():
    plugin = make_model_text('<link name="a"/><plugin filename="libx.so" name="x"><rate>5</rate></plugin>').plugins[0]
    assert (plugin.filename, plugin.name) == ("libx.so", "x")
    assert plugin.element is not None
    rate = plugin.element.first("rate")
    assert rate is not None
    assert rate.text() == "5"


def test_equal_plugins_stay_separate():
    plugin_text = '<plugin filename="libx.so" name="x"/>'
    first, second = make_model_text(f'<link name="a"/>{plugin_text}{plugin_text}').plugins
    assert first.element is not second.element


def test_world_is_read():
    parsed_world = make_world_text(
        """<gravity>0 0 -1.6</gravity><wind><linear_velocity>1 0 0</linear_velocity></wind>
        <physics type="ode"/><physics type="dart" default="1"><max_step_size>.004</max_step_size></physics>
        <scene><shadows>0</shadows></scene><spherical_coordinates><latitude_deg>48</latitude_deg>
        </spherical_coordinates><frame name="f"/><model name="o"><model name="i"><link name="l"/></model></model>"""
    )
    assert find_gravity(parsed_world) == (0, 0, -1.6)
    assert parsed_world.wind == (1, 0, 0)
    assert find_physics(parsed_world).max_step_size == 0.004
    assert parsed_world.scene.shadows is False
    assert parsed_world.spherical_coordinates is not None
    assert parsed_world.spherical_coordinates.latitude_deg == 48
    assert parsed_world.models[0].models[0].links[0].name == "l"


def test_gravity_falls_back_to_physics():
    assert find_gravity(World()) == (0.0, 0.0, -9.8)
    assert find_gravity(make_world_text("<physics><gravity>0 0 -9</gravity></physics>")) == (0, 0, -9)
    assert find_gravity(make_world_text("<gravity>0 0 -2</gravity><physics><gravity>0 0 -9</gravity></physics>")) == (
        0,
        0,
        -2,
    )


def test_comments_with_double_hyphens_are_read():
    text = '<sdf version="1.6"><!-- a --b- c --><world name="w"/><!----x----></sdf>'
    document, warnings = parse_as_gazebo(text, "w.sdf")
    comments = [child.data for child in document.root.children if isinstance(child, Comment)]
    assert comments == [" a --b- c ", "--x--"]
    assert [warning.code for warning in warnings] == ["XML206"]
    assert document.source is not None
    assert document.source.text == text


def test_text_after_root_is_ignored_with_warning():
    text = '<sdf version="1.6"><world name="w"/></sdf>\n<!-- <plugin>\n<!-- wheels --> <left/>\n</plugin> -->\n'
    document, warnings = parse_as_gazebo(text, "w.sdf")
    assert [element.tag for element in document.root.elements()] == ["world"]
    assert [(warning.code, warning.span.line) for warning in warnings] == [("XML206", 3), ("XML207", 3)]


def test_empty_file_hints_at_sdf_root():
    with pytest.raises(LinkwrightError) as error:
        parse_as_gazebo(" ", "w.sdf")
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "XML105"
    assert "<sdf" in str(diagnostic.hint)


def test_sdf_elements_without_effect_are_accepted():
    make_world_text("<gui fullscreen='0'><camera name='c'/><anything/></gui><physics><ode><solver/></ode></physics>")
    make_model_text(
        '<link name="a"><must_be_base_link>1</must_be_base_link></link><plugin filename="p"><any/></plugin>'
    )


@given(st.text(alphabet="<>/=\"' sdfworlmk123.-", max_size=60), st.integers(0, 10**6))
def test_random_worlds_are_read_without_exception(text, position):
    """A random text is inserted into a world.

    If the result is XML, it is read without an exception.
    """
    document_text = (
        '<sdf version="1.6"><world name="w"><model name="m"><pose>0 0 0 0 0 0</pose><link name="l"><visual name="v">'
        "<geometry><box><size>1 1 1</size></box></geometry></visual></link></model></world></sdf>"
    )
    position %= len(document_text)
    try:
        document, _ = parse_as_gazebo(document_text[:position] + text + document_text[position:], "w.sdf")
    except LinkwrightError:
        return
    read(document)


def test_deeply_nested_models_are_rejected():
    text = '<sdf version="1.9">' + '<model name="m">' * 5000 + "</model>" * 5000 + "</sdf>"
    document, _ = parse_as_gazebo(text, "w.sdf")
    reading = read(document)
    assert reading.sdf is None
    assert [diagnostic.code for diagnostic in reading.diagnostics] == ["SDF133"]


def test_any_element_can_be_nested_in_any_other_without_exception():
    """Each element of the table is nested in each other element."""
    tags = sorted({rule.tag for rule in collect_rules(SDF, {}).values()})
    for rule in collect_rules(SDF, {}).values():
        element = Element(rule.tag, {"name": "n"})
        element.children += [Element(tag, {"name": "n", "type": "x", "value": "y"}) for tag in tags]
        reader_of(rule, NEWEST_VERSION).read(element, element, SdfReport())


def test_bare_ampersand_and_latin1_bytes_are_read():
    plugin = '<plugin name="ü" filename="x"><y>1 &amp; 2 & 3</y></plugin>'
    text = f'<sdf version="1.6"><world name="a & b">{plugin}</world></sdf>'
    document, warnings = parse_as_gazebo(text.encode("latin-1"), "test.world")
    assert [warning.code for warning in warnings] == ["XML104", "XML206"]
    sdf = read(document).sdf
    assert sdf is not None
    parsed_world = sdf.worlds[0]
    assert parsed_world.name == "a & b"
    assert parsed_world.plugins[0].name == "ü"
    assert parsed_world.plugins[0].element.first("y").text() == "1 & 2 & 3"


def test_malformed_polyline_points_are_omitted():
    text = "<polyline><point/><point>1 x</point><point>1 2</point></polyline>"
    shape = f'<link name="l"><visual name="v"><geometry>{text}</geometry></visual></link>'
    document, _ = parse_as_gazebo(f'<sdf version="1.6"><model name="m">{shape}</model></sdf>', "test.sdf")
    sdf = read(document).sdf
    assert sdf is not None
    assert sdf.models[0].links[0].visuals[0].geometry == (shapes.Polyline(((1.0, 2.0),)),)


def test_gazebo_root_and_scoped_link_names_are_read():
    links = '<link name="base"/><link name="laser::link"/>'
    joint = '<joint name="laser::j" type="fixed"><parent>base</parent><child>laser::link</child></joint>'
    text = f'<gazebo version="1.3"><model name="m">{links}{joint}</model></gazebo>'
    document, _ = parse_as_gazebo(text, "test.sdf")
    reading = read(document)
    assert reading.sdf is not None
    assert reading.diagnostics == ()
    assert [link.name for link in reading.sdf.models[0].links] == ["base", "laser::link"]


OLD_WORLD = """<gazebo version="1.0">
  <world name="w">
    <scene><ambient rgba="1 0 0 1"/><shadows enabled="false"/></scene>
    <physics type="ode" update_rate="500"><gravity xyz="0 0 -1.6"/></physics>
    <model name="m" static="false">
      <origin pose="1 2 3 0 0 0"/>
      <link name="a" gravity="false">
        <damping linear="0.1" angular="0.2"/>
        <inertial mass="2.0"><inertia ixx="3" ixy="0" ixz="0" iyy="3" iyz="0" izz="3"/></inertial>
        <collision name="c">
          <origin pose="0 0 1 0 0 0"/>
          <geometry><box size="1 2 3"/></geometry>
          <surface><friction><ode mu="0.3" mu2="0.4"/></friction></surface>
        </collision>
        <visual name="v" cast_shadows="false">
          <geometry><mesh filename="a.dae" scale="2 2 2"/></geometry>
          <material script="Gazebo/Grey"/>
        </visual>
        <sensor name="s" type="camera" update_rate="10">
          <camera><horizontal_fov angle="1.1"/><image width="32" height="24" format="R8G8B8"/></camera>
        </sensor>
      </link>
      <link name="b"/>
      <joint name="j" type="revolute">
        <parent link="a"/>
        <child link="b"/>
        <axis xyz="0 1 0"><limit lower="-1" upper="1" effort="5" velocity="2"/></axis>
      </joint>
      <plugin name="p" filename="lib.so" origin="here"><origin pose="x"/></plugin>
    </model>
    <light name="l" type="directional"><origin pose="0 0 10 0 0 0"/><diffuse rgba=".5 .5 .5 1"/></light>
  </world>
</gazebo>"""


def test_sdf_1_0_attributes_are_read():
    document, _ = parse_as_gazebo(OLD_WORLD, "old.world")
    reading = read(document)
    assert reading.diagnostics == ()
    assert reading.sdf is not None
    (parsed_world,) = reading.sdf.worlds
    assert parsed_world.scene.ambient == (1.0, 0.0, 0.0, 1.0)
    assert not parsed_world.scene.shadows
    assert parsed_world.physics[0].gravity == (0.0, 0.0, -1.6)
    assert parsed_world.physics[0].real_time_update_rate == 500
    (model,) = parsed_world.models
    assert model.pose.pose.xyz == (1.0, 2.0, 3.0)
    link = model.links[0]
    assert link.gravity is False
    assert link.velocity_decay.angular == 0.2
    assert link.inertial is not None
    assert link.inertial.mass == 2.0
    assert link.inertial.inertia.ixx == 3.0
    assert link.collisions[0].pose.pose.xyz == (0.0, 0.0, 1.0)
    assert link.collisions[0].geometry == Box((1.0, 2.0, 3.0))
    assert link.collisions[0].surface.friction.mu == 0.3
    assert link.visuals[0].geometry == shapes.Mesh("a.dae", (2.0, 2.0, 2.0))
    assert link.visuals[0].material is not None
    assert link.visuals[0].material.script is not None
    assert link.visuals[0].material.script.name == "Gazebo/Grey"
    assert link.sensors[0].update_rate == 10
    camera = link.sensors[0].cameras[0]
    assert camera.horizontal_fov == 1.1
    assert camera.image.width == 32
    joint = model.joints[0]
    assert (joint.parent, joint.child) == ("a", "b")
    assert joint.axis is not None
    assert joint.axis.xyz == (0.0, 1.0, 0.0)
    assert joint.axis.limit.upper == 1.0
    assert parsed_world.lights[0].pose.pose.xyz == (0.0, 0.0, 10.0)
    assert model.plugins[0].element is not None
    assert model.plugins[0].element.first("origin") is not None


def test_invalid_sdf_1_0_attribute_is_reported():
    text = OLD_WORLD.replace('<box size="1 2 3"/>', '<box size="1 2"/>')
    document, _ = parse_as_gazebo(text, "old.world")
    (diagnostic,) = read(document).diagnostics
    assert diagnostic.code == "SDF121"
    assert diagnostic.span is not None
    assert text.splitlines()[diagnostic.span.line - 1][diagnostic.span.column - 1 :].startswith("<box")


def test_frame_in_any_element_with_pose_is_accepted():
    frame = '<frame name="f"><pose>0 0 0 0 0 0</pose></frame>'
    box = "<geometry><box><size>1 1 1</size></box></geometry>"
    make_model_text(f'<link name="a">{frame}<visual name="v">{frame}{box}</visual></link>')


@pytest.mark.parametrize(("text", "expected"), [("0x0002", 2), ("0XFF", 255), ("2.5", 2), ("7 8", 7)])
def test_integers_are_parsed_like_libsdformat(text, expected):
    collision = f'<collision name="c"><max_contacts>{text}</max_contacts></collision>'
    document, _ = parse_as_gazebo(
        f'<sdf version="1.9"><model name="m"><link name="a">{collision}</link></model></sdf>', "m"
    )
    assert read(document).sdf.models[0].links[0].collisions[0].max_contacts == expected
