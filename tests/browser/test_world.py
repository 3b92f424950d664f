"""A simulated world in the page: its models, the simulation bar, and the mouse on models."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.graph import DESCRIPTION_QOS, SENSOR_DATA_QOS, TF_QOS, DurabilityPolicy, QoSProfile
from linkwright.messages import String, TFMessage, Time, get_message, get_service
from linkwright.page.protocol.simulation import ModelChoices
from linkwright.simulation.page.modeling import entities
from linkwright.simulation.plugins.boats.waves import WaveField, WaveParameters
from linkwright.simulation.plugins.water import WaterSurface, create_water_message
from tests.browser.conftest import TIMEOUT_S, state, until, wait_until_equal
from tests.browser.live import configuration
from tests.waiting import wait_until

pytestmark = pytest.mark.browser

STATE = get_message("simulation_interfaces/msg/SimulationState")
DISPLAYS = "- {Class: linkwright/World, Enabled: true, Name: World}"
WORLD = """\
<sdf version="1.9"><world name="yard">
  <model name="crate"><link name="link">
    <visual name="v"><geometry><box><size>4 4 1</size></box></geometry><material><diffuse>1 0 0 1</diffuse></material>
  </visual></link></model>
  <model name="hill"><static>true</static><pose>0 0 3 0 0 0</pose><link name="link">
    <visual name="a"><geometry><cone><radius>1</radius><length>2</length></cone></geometry></visual>
    <visual name="b"><pose>0 0 3 0 0 0</pose>
      <geometry><polyline><point>0 0</point><point>2 0</point><point>0 2</point><height>0.5</height></polyline>
      </geometry></visual></link></model>
</world></sdf>
"""
SERVICES = {
    "/pause_physics": "std_srvs/srv/Empty",
    "/get_model_list": "gazebo_msgs/srv/GetModelList",
    "/spawn_entity": "gazebo_msgs/srv/SpawnEntity",
    "/delete_entity": "gazebo_msgs/srv/DeleteEntity",
    "/get_entity_state": "gazebo_msgs/srv/GetEntityState",
    "/set_entity_state": "gazebo_msgs/srv/SetEntityState",
    "/apply_link_wrench": "gazebo_msgs/srv/ApplyLinkWrench",
}


def publish_world(start_viewer, extra=""):
    viewer = start_viewer(
        configuration(DISPLAYS + extra, distance=12.0).replace("Fixed Frame: base", "Fixed Frame: world")
    )
    viewer.publish("/world_description", String(data=WORLD), DESCRIPTION_QOS)
    return viewer


def move_model(viewer, x: float, seconds: float = 0.0) -> None:
    transform = get_message("geometry_msgs/msg/TransformStamped")()
    transform.header.frame_id, transform.child_frame_id = "world", "crate::link"
    transform.header.stamp = Time.from_nanoseconds(round(seconds * 1e9))
    transform.transform.translation.x, transform.transform.rotation.w = x, 1.0
    viewer.publish("/world_poses", TFMessage(transforms=[transform]), TF_QOS)


def drawn_bounds(page, link: str, shape: int = 0) -> list[list[float]]:
    drawing = page.evaluate("() => window.linkwright.displays[0].drawn")
    box = drawing["links"][link]["visuals"][shape]["bounds"]
    return [[round(coordinate, 2) for coordinate in box[end]] for end in ("min", "max")]


def test_models_are_drawn_and_moved(start_viewer, open_page):
    viewer = publish_world(start_viewer)
    page = open_page(viewer)
    viewer.settle(page)
    assert drawn_bounds(page, "crate::link") == [[-2, -2, -0.5], [2, 2, 0.5]]
    assert drawn_bounds(page, "hill::link") == [[-1, -1, 2], [1, 1, 4]]
    assert drawn_bounds(page, "hill::link", 1) == [[0, 0, 6], [2, 2, 6.5]]
    move_model(viewer, 3.0)
    viewer.settle(page)
    assert drawn_bounds(page, "crate::link") == [[1, -2, -0.5], [5, 2, 0.5]]


def test_simulation_bar_and_mouse_control_models(start_viewer, open_page, monkeypatch, tmp_path):
    list_requested = threading.Event()
    monkeypatch.setattr(
        entities, "list_model_choices", lambda packages: (list_requested.wait(TIMEOUT_S), ModelChoices([]))[1]
    )
    viewer = publish_world(start_viewer)
    requests_made: list[tuple[str, object]] = []

    def answer(name: str, request, response):
        requests_made.append((name, request))
        if hasattr(response, "success"):
            response.success = True
        return response

    def begin() -> None:
        for name, service_type in SERVICES.items():
            viewer.node.create_service(
                get_service(service_type), name, lambda request, response, name=name: answer(name, request, response)
            )

    def requests(name: str) -> list:
        return [request for name_called, request in requests_made if name_called == name]

    page = open_page(viewer)
    assert page.locator(".simulation-bar").is_hidden()
    viewer.run(begin)
    viewer.publish("/simulation_state", STATE(state=1), QoSProfile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
    page.get_by_role("button", name="Pause the simulation").click()
    wait_until(lambda: requests("/pause_physics"))
    viewer.publish("/simulation_state", STATE(state=2))
    page.get_by_role("button", name="Resume the simulation").wait_for()
    assert page.get_by_role("button", name="Advance one step").is_enabled()
    viewer.settle(page)
    record = page.get_by_role("button", name="Record", exact=True).bounding_box()
    assert record["x"] + record["width"] <= page.viewport_size["width"]
    page.get_by_role("button", name="Add a model", exact=True).click()
    fields = page.get_by_role("dialog").locator(".spawn-places input")
    # The position is beside the crate, which extends from -2 to 2.
    assert [field.input_value() for field in fields.all()] == ["3", "0", "0"]
    dialog = page.get_by_role("dialog")
    dialog.get_by_label("Model or file").fill("/nowhere/robot.urdf")
    dialog.get_by_role("button", name="Add a model").click()
    failure = dialog.get_by_role("alert").get_by_text("no such file: '/nowhere/robot.urdf'")
    failure.wait_for()
    list_requested.set()
    dialog.get_by_text("No model is on the search path").wait_for()
    assert failure.is_visible(), "a list that arrives late does not hide the error"
    (tmp_path / "seen.urdf").write_text(VISIBLE_ROBOT, encoding="utf-8")
    dialog.get_by_label("Model or file").fill(str(tmp_path / "seen.urdf"))
    dialog.get_by_role("button", name="Add a model").click()
    dialog.wait_for(state="detached")
    (request,) = requests("/spawn_entity")
    assert '<robot name="seen">' in request.xml
    assert (request.initial_pose.position.x, request.initial_pose.position.y) == (3.0, 0.0)

    box = page.locator(".canvas-box canvas").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.keyboard.down("Control")
    page.mouse.down()
    page.mouse.move(x + 60, y, steps=4)
    page.mouse.up()
    page.keyboard.up("Control")
    wait_until(
        lambda: [request for request in requests("/set_entity_state") if abs(request.state.pose.position.y) > 0.1]
    )
    assert {request.state.name for request in requests("/set_entity_state")} == {"crate"}
    assert all(request.state.pose.position.z == 0 for request in requests("/set_entity_state"))

    page.mouse.move(x, y)
    for key in ("Control", "Shift"):
        page.keyboard.down(key)
    page.mouse.down()
    page.mouse.move(x + 60, y, steps=4)
    wait_until(lambda: len(requests("/apply_link_wrench")) > 5)  # the mouse keeps pulling while it stands still
    page.mouse.up()
    for key in ("Control", "Shift"):
        page.keyboard.up(key)
    pulls = requests("/apply_link_wrench")
    assert {pull.link_name for pull in pulls} == {"crate::link"}
    assert pulls[-1].wrench.force.y > 1

    page.mouse.click(x, y, button="right")
    page.get_by_role("menuitem", name="Remove crate").click()
    wait_until(lambda: requests("/delete_entity"))
    assert requests("/delete_entity")[0].name == "crate"
    page.mouse.click(x, y, button="right")
    page.get_by_role("menuitem", name="Add a model here").click()
    assert page.get_by_role("dialog").is_visible()


VISIBLE_ROBOT = """\
<robot name="seen"><link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <joint name="turns" type="continuous"><parent link="base"/><child link="wheel"/></joint>
  <joint name="rolls" type="continuous"><parent link="base"/><child link="roll"/></joint>
  <link name="wheel"><visual><geometry><sphere radius="0.2"/></geometry></visual></link>
  <link name="roll"><visual><geometry><sphere radius="0.2"/></geometry></visual></link></robot>
"""


def test_camera_shows_world_origin_when_robot_falls_out_of_view(start, open_page, tmp_path):
    (tmp_path / "seen.urdf").write_text(VISIBLE_ROBOT)
    page = open_page(start("sim", "empty", "seen.urdf", "-x", "7", "-z", "-900"))
    page.locator(".banner").get_by_text("no link of 'seen' has a <collision>").wait_for()
    has_fallen = (
        "lw.displays.find(({ name }) => name === 'World').drawn.links['seen::base'].visuals[0].bounds.max[2] < -800"
    )
    until(page, has_fallen)
    # In an empty world without a ground, the view is centered where the robot was added.
    assert abs(state(page, "view.values['Focal Point/Z']")) < 1


def test_model_without_collision_is_reported_until_dismissed(start_viewer, open_page):
    viewer = publish_world(start_viewer)
    page = open_page(viewer)
    falls = phrase("no link of '{name}' has a <collision>, so the model has no contacts and falls", name="seen")
    light_links_text = phrase("links without a mass")
    findings = [
        Diagnostic(code, text, severity=Severity.WARNING)
        for code, text in (("SDF172", light_links_text), ("SIM143", falls))
    ]
    viewer.run(lambda: viewer.viewer.show_diagnostics(findings))
    banner = page.locator(".banner")
    banner.get_by_text("no link of 'seen'").wait_for()
    banner.get_by_role("button", name="Close this message").click()
    banner.wait_for(state="hidden")
    robot_finding = Diagnostic("URDF101", phrase("links without a mass"))
    viewer.run(lambda: viewer.viewer.show_diagnostics([*findings, robot_finding]))
    banner.get_by_text("links without a mass").wait_for()
    assert banner.get_by_role("button", name="Close this message").count() == 0
    viewer.run(lambda: viewer.viewer.show_diagnostics(findings))
    banner.wait_for(state="hidden")


def test_slow_world_is_reported_with_button_to_switch_off_images(start_viewer, open_page):
    image = "\n- {Class: rviz_default_plugins/Image, Name: Front, Enabled: true, Topic: {Value: /front}}"
    viewer = publish_world(start_viewer, image)
    page = open_page(viewer)
    until(page, "lw.displays.some(({ name, enabled }) => name === 'Front' && enabled)")
    slow = Diagnostic("SIM146", phrase("links without a mass"), severity=Severity.WARNING)
    viewer.run(lambda: viewer.viewer.show_diagnostics([slow]))
    banner = page.locator(".banner")
    banner.get_by_text("links without a mass").wait_for()
    button = banner.get_by_role("button", name="Switch off images")
    button.click()
    until(page, "lw.displays.some(({ name, enabled }) => name === 'Front' && !enabled)")
    button.wait_for(state="detached")


LAMPS = """
  <scene><ambient>0.3 0.3 0.3</ambient><background>0.2 0.4 0.8</background></scene>
  <light name="sun" type="directional"><cast_shadows>true</cast_shadows><direction>-0.5 0.3 -1</direction></light>
  <light name="lamp" type="point"><pose>2 2 4 0 0 0</pose><diffuse>1 0.8 0.5</diffuse></light>
  <model name="floor"><static>true</static><pose>0 0 -0.5 0 0 0</pose><link name="link">
    <visual name="v"><geometry><box><size>14 14 0.1</size></box></geometry></visual>
    <light name="spot" type="spot"><pose>-3 0 5 0 0 0</pose><spot><outer_angle>0.8</outer_angle></spot></light>
  </link></model>
</world>"""


def test_world_lighting_follows_chosen_light(start_viewer, open_page):
    def read_light(page) -> dict:
        return page.evaluate("() => window.linkwright.displays[0].drawn.light")

    for choice, expected in (
        ("Automatic", {"lighting": "Soft", "lights": 0, "shadows": 0}),  # the CPU renders the tests
        ("Studio", {"lighting": "Studio", "lights": 1, "shadows": 1}),
        ("World", {"lighting": "World", "lights": 3, "shadows": 1}),
    ):
        displays = DISPLAYS.replace("Name: World", f"Name: World, Light: {choice}")
        viewer = start_viewer(configuration(displays, distance=16.0).replace("Fixed Frame: base", "Fixed Frame: world"))
        viewer.publish("/world_description", String(data=WORLD.replace("</world>", LAMPS)), DESCRIPTION_QOS)
        page = open_page(viewer)
        viewer.settle(page)
        assert read_light(page) == expected


SENSING = """
  <model name="tower"><static>true</static><link name="top"><pose>0 0 2 0 0 0</pose>
    <sensor name="laser" type="ray"><visualize>true</visualize><ray><scan><horizontal><samples>8</samples>
      <min_angle>-3</min_angle><max_angle>3</max_angle></horizontal></scan><range><min>0.1</min><max>5</max></range></ray>
    </sensor>
    <sensor name="camera" type="camera"><camera><clip><near>0.5</near><far>4</far></clip></camera></sensor>
  </link></model>
</world>"""


def test_sensor_rays_and_frustums_follow_display_properties(start_viewer, open_page):
    def drawn(page) -> dict:
        return page.evaluate("() => window.linkwright.displays[0].drawn.sensors")

    viewer = publish_world(start_viewer)
    viewer.publish("/world_description", String(data=WORLD.replace("</world>", SENSING)), DESCRIPTION_QOS)
    page = open_page(viewer)
    viewer.settle(page)
    assert drawn(page) == {"rays": {}, "frustums": []}
    scan = get_message("sensor_msgs/msg/LaserScan")(ranges=[4.0, 3.0, 2.0, float("inf"), float("-inf"), 1.0, 1.0, 1.0])
    scan.header.frame_id = "tower::top::laser"
    viewer.publish("/world_rays", scan, SENSOR_DATA_QOS)
    wait_until_equal(lambda: drawn(page)["rays"], {"tower::top::laser": 8})

    def choose(name: str, choice: str) -> None:
        viewer.run(lambda: viewer.viewer.displays[0].set_property((name,), choice))

    choose("Camera Frustums", "All")
    wait_until_equal(lambda: drawn(page)["frustums"], ["tower::top::camera"])
    choose("Lidar Rays", "None")
    wait_until_equal(lambda: drawn(page)["rays"], {})


def test_water_moves_with_time_of_poses(start_viewer, open_page):
    field = WaveField(WaveParameters(period=4.0, steepness=0.7, tau=2.0))
    viewer = publish_world(start_viewer)
    page = open_page(viewer)
    viewer.settle(page)

    def drawn() -> dict | None:
        return page.evaluate("() => window.linkwright.displays[0].drawn.water")

    assert drawn() is None
    viewer.publish("/world_water", create_water_message(WaterSurface(0.5, 2.0, field.wave_rows())), DESCRIPTION_QOS)
    for seconds in (3.0, 7.5):
        move_model(viewer, seconds, seconds=seconds)
        wait_until_equal(lambda: (drawn() or {}).get("seconds"), seconds)
        points = np.array(drawn()["samples"])
        heights = 0.5 + field.heights(points[:, :2], seconds)
        assert points[:, 2] == pytest.approx(heights, abs=1e-4)
        assert np.ptp(heights) > 0.01
    viewer.publish("/world_water", get_message("std_msgs/msg/Float64MultiArray")(), DESCRIPTION_QOS)
    wait_until_equal(drawn, None)
