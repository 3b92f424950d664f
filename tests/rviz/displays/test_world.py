"""linkwright/World: the models of a simulated world, where the simulation has them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from PIL import Image

from linkwright.graph import DESCRIPTION_QOS, SENSOR_DATA_QOS, TF_QOS
from linkwright.messages import Header, String, TFMessage, TransformBatch, get_message
from linkwright.rviz import RvizConfig
from linkwright.rviz.water import convert_water
from tests.viewer.contents import unpack_contents
from tests.viewer.scene import IDENTITY, open_page, open_world
from tests.waiting import eventually

SCAN = get_message("sensor_msgs/msg/LaserScan")
CONFIG = """\
Visualization Manager:
  Global Options: {Fixed Frame: FIXED}
  Displays:
    - {Class: linkwright/World, Enabled: true}
"""

WORLD = """\
<sdf version="1.9"><world name="yard">
  <model name="ground"><static>true</static><link name="link">
    <visual name="v"><geometry><plane><normal>0 0 1</normal><size>10 20</size></plane></geometry></visual>
  </link></model>
  <model name="robot"><pose>1 2 0 0 0 0</pose>
    <link name="base"><pose>0 0 0.5 0 0 0</pose>
      <visual name="body"><pose>0 0 1 0 0 0</pose><transparency>0.5</transparency>
        <geometry><box><size>1 2 3</size></box></geometry>
        <material><diffuse>1 0 0 1</diffuse></material></visual>
      <visual name="ear"><pose relative_to="__model__">0 0 2 0 0 0</pose>
        <geometry><cone><radius>0.1</radius><length>0.3</length></cone></geometry></visual>
      <collision name="hull"><geometry><ellipsoid><radii>1 2 3</radii></ellipsoid></geometry></collision>
    </link>
    <model name="arm"><pose>0 1 0 0 0 0</pose><link name="tip"/></model>
  </model>
</world></sdf>
"""


def make_config(fixed: str) -> RvizConfig:
    return RvizConfig.parse(CONFIG.replace("FIXED", fixed))


class Simulation:
    """A node that publishes a world and the poses of its links."""

    def __init__(self, world) -> None:
        self.world = world
        node = world.graph.create_node("simulation")
        self.description = node.create_publisher(String, "/world_description", DESCRIPTION_QOS)
        self.poses = node.create_publisher(TFMessage, "/world_poses", TF_QOS)

    async def describe(self, text: str, links: int = 3) -> None:
        self.description.publish(String(data=text))
        await eventually(lambda: sent_links(self.world) == links)

    async def move(self, **poses: tuple[float, ...]) -> None:
        names = tuple(name.replace("__", "::") for name in poses)
        array = np.array(list(poses.values()), dtype=np.float64).reshape(-1, 7)
        stamp = self.world.graph.timebase.now_ns()
        batch = TransformBatch(("world",) * len(names), names, stamp, array)
        self.poses.publish(TFMessage(batch=batch))
        await self.world.settle()


def sent_message(world, kind: str):
    return next(
        (content for content in unpack_contents(world.display("World")) if content.fields["kind"] == kind), None
    )


def sent_links(world) -> int:
    scene = sent_message(world, "world_scene")
    return len(scene.fields["links"]) if scene else 0


def sent_positions(world) -> list[list[float]]:
    return sent_message(world, "world_poses").fields["poses"].reshape(-1, 7)[:, :3].round(6).tolist()


async def test_world_links_are_sent_with_shapes_and_poses():
    async with open_world(make_config("world")) as world:
        await Simulation(world).describe(WORLD)
        ground, base, tip = sent_message(world, "world_scene").fields["links"]
        assert [link["name"] for link in (ground, base, tip)] == ["ground::link", "robot::base", "robot::arm::tip"]
        (plane,) = ground["visuals"]
        assert (plane["kind"], plane["size"], plane["color"]) == ("plane", [10.0, 20.0], [0.7, 0.7, 0.7, 1.0])
        body, ear = base["visuals"]
        assert (body["kind"], body["position"], body["color"]) == ("box", [0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.5])
        assert body["repaints"]
        assert (ear["kind"], ear["size"]) == ("cone", [0.1, 0.3])
        assert ear["position"] == pytest.approx([0, 0, 1.5])
        assert [(collision["kind"], collision["size"]) for collision in base["collisions"]] == [
            ("ellipsoid", [1.0, 2.0, 3.0])
        ]
        assert sent_positions(world) == [[0, 0, 0], [1, 2, 0.5], [1, 3, 0]]
        assert world.status("World")["World"] == ("ok", "2 models, 3 links")


async def test_link_poses_follow_names_and_survive_new_description():
    async with open_world(make_config("world")) as world:
        simulation = Simulation(world)
        await simulation.describe(WORLD)
        await simulation.move(robot__base=(5, 5, 5, 0, 0, 0, 1), nobody__link=(9, 9, 9, 0, 0, 0, 1))
        assert sent_positions(world) == [[0, 0, 0], [5, 5, 5], [1, 3, 0]]
        world_with_ball = WORLD.replace("</world>", '<model name="ball"><link name="link"/></model></world>')
        await simulation.describe(world_with_ball, links=4)
        await eventually(lambda: len(sent_positions(world)) == 4)
        assert sent_positions(world) == [[0, 0, 0], [5, 5, 5], [1, 3, 0], [0, 0, 0]]
        assert (
            sent_message(world, "world_poses").fields["revision"]
            == sent_message(world, "world_scene").fields["revision"]
            == 2
        )


async def test_static_models_follow_new_description():
    async with open_world(make_config("world")) as world:
        simulation = Simulation(world)
        await simulation.describe(WORLD)
        await simulation.move(robot__base=(5, 5, 5, 0, 0, 0, 1))
        lower = WORLD.replace("<static>true</static>", "<static>true</static><pose>0 0 -1 0 0 0</pose>")
        await simulation.describe(lower)
        await eventually(lambda: sent_positions(world) == [[0, 0, -1], [5, 5, 5], [1, 3, 0]])
        await simulation.describe(lower.replace("<pose>1 2 0 0 0 0</pose>", "<static>true</static>"))
        await eventually(lambda: sent_positions(world) == [[0, 0, -1], [0, 0, 0.5], [0, 1, 0]])


async def test_world_is_placed_by_robot_frame_without_world_frame():
    async with open_world(make_config("odom")) as world:
        simulation = Simulation(world)
        await simulation.describe(WORLD)
        assert world.status("World")["Frame"][0] == "warn"
        world.move({("odom", "base"): (0, 0, 0.5, *IDENTITY[3:])})
        await eventually(lambda: sent_message(world, "world_poses").pose is not None)
        assert sent_message(world, "world_poses").pose == pytest.approx([-1, -2, 0, 0, 0, 0, 1])
        half = math.sqrt(0.5)
        world.move({("odom", "base"): (3, 0, 0.5, 0, 0, half, half)})
        await world.settle()
        await simulation.move(robot__base=(1, 2, 0.5, 0, 0, 0, 1))  # the pose in the world at the time of the transform
        assert world.status("World")["Frame"] == (
            "ok",
            "tf has no frame 'world': the world is placed so that 'base' has the same pose in both",
        )


async def test_world_without_transforms_has_own_frame_and_no_warning():
    async with open_world(make_config("world")) as world, open_page(world.viewer) as opened:
        await Simulation(world).describe(WORLD)
        await opened.until("display_status", display="global", level="ok")
        assert world.status("World")["Frame"] == ("ok", "The world is placed at the frame 'world'")
        world.move({("odom", "base"): (3, 0, 0.5, *IDENTITY[3:])})
        world_frame = world.viewer.context.transforms.placed_frame
        await eventually(lambda: (frame := world_frame("world")) is not None and frame.parent == "odom")


async def test_tf_frames_are_placed_in_world_as_fixed_frame():
    async with open_world(make_config("world")) as world, open_page(world.viewer):
        simulation = Simulation(world)
        await simulation.describe(WORLD)
        world.move({("odom", "base"): (3, 0, 0.5, *IDENTITY[3:])})
        await world.settle()
        await simulation.move(robot__base=(1, 2, 0.5, 0, 0, 0, 1))
        await simulation.move(robot__base=(1, 2, 0.5, 0, 0, 0, 1))
        assert sent_message(world, "world_poses").frame == "world"
        text = "tf has no frame 'world': the frames of tf are placed so that 'base' has the same pose in both"
        await eventually(lambda: world.status("World")["Frame"] == ("ok", text))
        transforms = world.viewer.context.transforms
        await eventually(lambda: transforms.placed_frame("world").parent == "odom")
        assert transforms.pose("world", "base", 0) == pytest.approx([1, 2, 0.5, 0, 0, 0, 1])
        assert transforms.pose("world", "odom", 0) == pytest.approx([-2, 2, 0, 0, 0, 0, 1])
        frame, is_known = transforms.to_known_frame("world", IDENTITY)
        assert (frame, is_known) == ("odom", pytest.approx([2, -2, 0, 0, 0, 0, 1]))
        await eventually(lambda: "base" in world.viewer.manager.frames.placed)

        world.move({("map", "world"): IDENTITY}, static=True)
        await eventually(lambda: world.status("World")["Frame"] == ("ok", "The world is placed at the frame 'world'"))
        assert transforms.placed_frame("world") is None


async def test_world_frame_of_tf_places_world():
    async with open_world(make_config("map")) as world:
        world.move({("map", "world"): (1, 0, 0, *IDENTITY[3:])}, static=True)
        await Simulation(world).describe(WORLD)
        await eventually(lambda: sent_message(world, "world_poses").frame == "world")
        assert sent_message(world, "world_poses").pose is None


async def test_static_poses_are_sent_once():
    async with open_world(make_config("world")) as world:
        simulation = Simulation(world)
        await simulation.describe(WORLD)
        await simulation.move(robot__base=(1, 1, 1, 0, 0, 0, 1))
        display = world.display("World")
        before = display.data()[-1]
        await simulation.move(robot__base=(1, 1, 1, 0, 0, 0, 1))
        assert display.data()[-1] is before


LOST_LINK = "<link name='l'><pose relative_to='x'/></link>"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<sdf", "<world>:1:1: this tag has no closing '>'"),
        ("<robot name='r'/>", "the root element is <robot>, not <sdf>"),
        ("<sdf version='1.6'/>", "<sdf> contains neither a world nor a model"),
        (f"<sdf version='1.6'><model name='m'>{LOST_LINK}</model></sdf>", "'x' cannot be determined"),
    ],
)
async def test_invalid_description_is_reported_and_last_world_remains(text, message):
    async with open_world(make_config("world")) as world:
        simulation = Simulation(world)
        await simulation.describe(WORLD)
        simulation.description.publish(String(data=text))
        await eventually(lambda: world.status("World")["World"][0] == "error")
        assert message in world.status("World")["World"][1]
        assert sent_links(world) == 3


async def test_model_files_are_served_and_missing_ones_reported(tmp_path):
    model = tmp_path / "crate"
    for name in ("model.config", "meshes/crate.stl", "materials/textures/wood.png", "secret.txt"):
        (model / name).parent.mkdir(parents=True, exist_ok=True)
        (model / name).write_bytes(b"x")
    visual = "<visual name='{}'><geometry><mesh><uri>{}</uri></mesh></geometry></visual>"
    shapes = visual.format("a", (model / "meshes/crate.stl").as_uri()) + visual.format("b", "file:///nowhere.stl")
    text = f"<sdf version='1.9'><model name='crate'><link name='link'>{shapes}</link></model></sdf>"
    async with open_world(make_config("world")) as world:
        await Simulation(world).describe(text, links=1)
        (link,) = sent_message(world, "world_scene").fields["links"]
        (shape,) = link["visuals"]
        key, relative = shape["url"].partition("?")[0].removeprefix("/mesh/").split("/", 1)
        meshes = world.viewer.context.meshes
        assert relative == "meshes/crate.stl"
        assert meshes.file(key, "materials/textures/wood.png") == model / "materials/textures/wood.png"
        assert meshes.file(key, "meshes/wood.png") == model / "materials/textures/wood.png"  # as in Gazebo
        with pytest.raises(Exception, match="only meshes and images"):
            meshes.file(key, "secret.txt")
        level, status = world.status("World")["Files"]
        assert level == "error"
        assert "crate::link: Could not load 'file:///nowhere.stl'" in status


async def test_heightmap_heights_are_sent_and_limited(tmp_path):
    steps = np.tile(np.linspace(0, 65535, 600).astype(np.uint16), (2, 1))
    Image.fromarray(steps).save(tmp_path / "hill.png")
    ground = "<heightmap><uri>{}</uri><size>10 10 2</size></heightmap>"
    visual = f"<visual name='v'><geometry>{ground.format((tmp_path / 'hill.png').as_uri())}</geometry></visual>"
    visual += f"<visual name='w'><geometry>{ground.format('file:///nowhere.png')}</geometry></visual>"
    text = f"<sdf version='1.9'><model name='hill'><link name='l'>{visual}</link></model></sdf>"
    async with open_world(make_config("world")) as world:
        await Simulation(world).describe(text, links=1)
        (link,) = sent_message(world, "world_scene").fields["links"]
        (hill,) = link["visuals"]
        assert (hill["kind"], hill["columns"], hill["url"]) == ("heightmap", 257, None)
        heights = hill["heights"].reshape(2, 257)
        assert heights[1, [0, 128, 256]].tolist() == pytest.approx([0.0, 0.5, 1.0], abs=2e-3)
        assert "file:///nowhere.png" in world.status("World")["Files"][1]


async def test_pbr_surface_is_sent_with_material(tmp_path):
    Image.new("RGB", (2, 2)).save(tmp_path / "bumps.png")
    bumps = (tmp_path / "bumps.png").as_uri()
    ball = "<geometry><sphere><radius>1</radius></sphere></geometry>"
    visual = "<visual name='{}'>" + ball + "<material><pbr><metal>{}</metal></pbr></material></visual>"
    albedo = f"<albedo_map>{bumps}</albedo_map>"
    metal = f"<metalness>1</metalness><roughness>0.2</roughness><normal_map>{bumps}</normal_map>"
    lamp = f"<emissive_map>{bumps}</emissive_map><ambient_occlusion_map>{bumps}</ambient_occlusion_map>"
    facts = {"plain": albedo, "metal": albedo + metal, "lamp": albedo + lamp}
    visuals = "".join(visual.format(name, surface) for name, surface in facts.items())
    text = f"<sdf version='1.9'><model name='ball'><link name='l'>{visuals}</link></model></sdf>"
    async with open_world(make_config("world")) as world:
        await Simulation(world).describe(text, links=1)
        (link,) = sent_message(world, "world_scene").fields["links"]
        plain, shining, lamp = link["visuals"]
        assert lamp["surface"]["emissive_map"] == lamp["surface"]["occlusion_map"] == plain["texture"]
        assert plain["surface"] is None
        surface = shining["surface"]
        assert (surface["roughness"], surface["metalness"], surface["roughness_map"]) == (0.2, 1.0, None)
        assert surface["normal_map"] == shining["texture"] == plain["texture"]


async def test_gazebo_material_scripts_are_recognized():
    script = "<material><script><name>Gazebo/Red</name></script></material>"
    visual = f"<visual name='v'><geometry><sphere><radius>1</radius></sphere></geometry>{script}</visual>"
    text = f"<sdf version='1.9'><model name='ball'><link name='l'>{visual}</link></model></sdf>"
    async with open_world(make_config("world")) as world:
        await Simulation(world).describe(text, links=1)
        (link,) = sent_message(world, "world_scene").fields["links"]
        assert link["visuals"][0]["color"] == [1.0, 0.0, 0.0, 1.0]


LIGHTS = """\
<sdf version="1.9"><world name="yard"><scene><ambient>0.1 0.2 0.3 1</ambient><shadows>false</shadows></scene>
  <light name="sun" type="directional">
    <direction>0 0 -2</direction><diffuse>1 0.5 0 1</diffuse><intensity>2</intensity></light>
  <light name="off" type="point"><light_on>false</light_on></light>
  <light name="lost" type="point"><pose relative_to="nowhere"/></light>
  <model name="lamp"><static>true</static><link name="link"><pose>0 0 5 0 0 0</pose>
    <light name="bulb" type="spot"><pose>0 0 1 0 1.5707963267948966 0</pose>
      <attenuation><range>20</range><constant>0.5</constant><linear>0.1</linear><quadratic>0.01</quadratic></attenuation>
      <spot><inner_angle>0.5</inner_angle><outer_angle>1</outer_angle></spot></light></link></model>
</world></sdf>
"""


async def test_world_lights_are_sent_with_pose_and_properties():
    async with open_world(make_config("world")) as world:
        await Simulation(world).describe(LIGHTS, links=1)
        scene = sent_message(world, "world_scene").fields
        assert (scene["ambient"], scene["background"], scene["shadows"]) == ([0.1, 0.2, 0.3], [0.7, 0.7, 0.7], False)
        sun, bulb = scene["lights"]
        assert (sun["kind"], sun["link"], sun["direction"], sun["color"]) == (
            "directional",
            None,
            [0, 0, -1],
            [2, 1, 0],
        )
        assert (bulb["kind"], bulb["link"], bulb["position"]) == ("spot", "lamp::link", [0, 0, 1])
        assert bulb["direction"] == pytest.approx([-1, 0, 0])
        assert (bulb["range"], bulb["fading"], bulb["cone"]) == (20, [0.5, 0.1, 0.01], [0.5, 1])


SKY = """<world name="yard"><scene><sky><time>{}</time><clouds/></sky>
<fog><type>{}</type><color>0.5 0.6 0.7 1</color><start>2</start><end>30</end><density>0.1</density></fog></scene>"""


@pytest.mark.parametrize(
    ("time", "type_", "daylight", "fog"),
    [
        (12, "none", 1.0, None),
        (6, "linear", 0.5, {"color": [0.5, 0.6, 0.7], "start": 2.0, "end": 30.0, "density": None}),
        (23, "quadratic", 0.0, {"color": [0.5, 0.6, 0.7], "start": 2.0, "end": 30.0, "density": 0.1}),
    ],
)
async def test_sky_and_fog_are_sent(time, type_, daylight, fog):
    async with open_world(make_config("world")) as world:
        await Simulation(world).describe(WORLD)
        scene = sent_message(world, "world_scene").fields
        assert (scene["daylight"], scene["fog"]) == (None, None)
        await Simulation(world).describe(WORLD.replace('<world name="yard">', SKY.format(time, type_)))
        await eventually(lambda: sent_message(world, "world_scene").fields["revision"] == 2)
        scene = sent_message(world, "world_scene").fields
        assert (scene["daylight"], scene["fog"]) == (daylight, fog)


SENSING_MODEL = """
  <model name="scout"><link name="head"><pose>0 0 1 0 0 0</pose>
    <sensor name="laser" type="gpu_lidar"><pose>0.1 0 0 0 0 0</pose><visualize>true</visualize>
      <lidar><scan><horizontal><samples>1000</samples><min_angle>-1</min_angle><max_angle>0.998</max_angle></horizontal>
        <vertical><samples>32</samples><min_angle>-0.31</min_angle><max_angle>0.31</max_angle></vertical></scan>
        <range><min>0.2</min><max>20</max></range></lidar></sensor>
    <sensor name="spare" type="ray"><ray><scan><horizontal><samples>3</samples></horizontal></scan></ray></sensor>
    <sensor name="camera" type="camera"><camera><horizontal_fov>1.5707963267948966</horizontal_fov>
      <image><width>200</width><height>100</height></image><clip><near>0.5</near><far>8</far></clip></camera></sensor>
  </link></model>
</world>"""


def subscribed_topics(world) -> set[str]:
    names = ("/world_rays", "/world_rays/others")
    return {name for name in names if world.graph.create_node("asking").count_subscribers(name)}


async def test_lidar_scans_are_subscribed_while_rays_are_drawn():
    async with open_world(make_config("world")) as world:
        simulation = Simulation(world)
        await simulation.describe(WORLD)
        assert subscribed_topics(world) == set()
        await simulation.describe(WORLD.replace("</world>", SENSING_MODEL), links=4)
        laser, idle_lidar = sent_message(world, "world_scene").fields["lidars"]
        assert (laser["name"], laser["link"], laser["visualized"]) == ("scout::head::laser", "scout::head", True)
        assert (laser["position"], laser["nearest"], laser["farthest"]) == ([0.1, 0.0, 0.0], 0.2, 20.0)
        assert (laser["vertical"]["count"], laser["vertical"]["step"]) == (16, pytest.approx(0.04))
        assert (laser["horizontal"]["count"], laser["horizontal"]["step"]) == (44, pytest.approx(0.046))
        assert (idle_lidar["visualized"], idle_lidar["farthest"]) == (False, 30.0)
        assert subscribed_topics(world) == {"/world_rays"}
        rays = world.graph.create_node("rays").create_publisher(SCAN, "/world_rays", SENSOR_DATA_QOS)
        ranges = np.arange(32_000, dtype=np.float32)
        rays.publish(SCAN(header=Header(frame_id="scout::head::laser"), ranges=ranges))
        rays.publish(SCAN(header=Header(frame_id="scout::head::laser"), ranges=ranges[:7]))
        rays.publish(SCAN(header=Header(frame_id="nobody"), ranges=ranges))
        await world.settle()
        shown = sent_message(world, "world_rays").fields
        assert shown["lidar"] == "scout::head::laser"
        assert shown["ranges"].reshape(16, 44)[1, :3].tolist() == [2000.0, 2023.0, 2046.0]

        revision = sent_message(world, "world_scene").fields["revision"]  # recordings publish the world repeatedly
        simulation.description.publish(String(data=WORLD.replace("</world>", SENSING_MODEL)))
        await eventually(lambda: sent_message(world, "world_scene").fields["revision"] > revision)
        assert sent_message(world, "world_rays") is not None
        world.display("World").on_time_reset()
        assert sent_message(world, "world_rays") is None

        world.display("World").set_property(("Lidar Rays",), "All")
        assert subscribed_topics(world) == {"/world_rays", "/world_rays/others"}
        world.display("World").set_property(("Lidar Rays",), "None")
        assert subscribed_topics(world) == set()
        assert sent_message(world, "world_rays") is None


WATER = get_message("std_msgs/msg/Float64MultiArray")


async def test_water_is_sent_until_it_disappears():
    async with open_world(make_config("world")) as world:
        await Simulation(world).describe(WORLD)
        water = world.graph.create_node("water").create_publisher(WATER, "/world_water", DESCRIPTION_QOS)
        water.publish(WATER(data=[0.5, 2.0, 0.3, 1.0, 0.1, 0.0, 1.0, 0.0]))
        await eventually(lambda: sent_message(world, "world_water") is not None)
        fields = sent_message(world, "world_water").fields
        assert (fields["level"], fields["growth_time"]) == (0.5, 2.0)
        assert fields["waves"] == [0.3, 1.0, 0.1, 0.0, 1.0, 0.0]
        water.publish(WATER())
        await eventually(lambda: sent_message(world, "world_water") is None)


def sent_stamp(world) -> float:
    """Return the time of the poses, from the header of their content."""
    (data,) = (data for data in world.display("World").data() if b'"world_poses"' in data)
    return float(data.split(b'"stamp":')[1].split(b",")[0])


async def test_time_of_waves_follows_poses_that_do_not_change():
    async with open_world(make_config("world")) as world:
        simulation = Simulation(world)
        await simulation.describe(WORLD)
        water = world.graph.create_node("water").create_publisher(WATER, "/world_water", DESCRIPTION_QOS)
        water.publish(WATER(data=[0.5, 2.0, 0.3, 1.0, 0.1, 0.0, 1.0, 0.0]))
        await eventually(lambda: sent_message(world, "world_water") is not None)
        await simulation.move(robot__base=(1, 1, 1, 0, 0, 0, 1))
        before = sent_stamp(world)
        await simulation.move(robot__base=(1, 1, 1, 0, 0, 0, 1))
        assert sent_stamp(world) > before


@pytest.mark.parametrize("data", [[0.5], [0.5, 2.0, 0.3], [float("nan"), 0.0]])
def test_invalid_water_is_not_shown(data):
    assert convert_water(WATER(data=data)) is None


async def test_visual_of_waves_is_not_drawn_itself():
    plugin = '<plugin name="vrx::WaveVisual" filename="libWaveVisual.so"/></visual>'
    async with open_world(make_config("world")) as world:
        await Simulation(world).describe(WORLD.replace("</visual>", plugin, 1))
        ground, base, _ = sent_message(world, "world_scene").fields["links"]
        assert ground["visuals"] == []
        assert len(base["visuals"]) == 2


async def test_cameras_are_sent_with_field_of_view():
    async with open_world(make_config("world")) as world:
        await Simulation(world).describe(WORLD.replace("</world>", SENSING_MODEL), links=4)
        (camera,) = sent_message(world, "world_scene").fields["cameras"]
        assert (camera["name"], camera["visualized"]) == ("scout::head::camera", False)
        assert [camera[side] for side in ("left", "right", "up", "down")] == pytest.approx([1, 1, 0.5, 0.5])
        assert (camera["near"], camera["far"]) == (0.5, 8.0)
