"""Plugins that are not simulated: the log says what does their work, or where their source is."""

from __future__ import annotations

import pytest

from linkwright.graph import Graph, LogRecord
from linkwright.loading.extensions import extensions
from linkwright.simulation.plugins.alternatives import ALTERNATIVES
from linkwright.simulation.plugins.registry import PLUGIN_GROUP, SENSOR_GROUP
from linkwright.simulation.plugins.sources import find_plugin_sources
from linkwright.simulation.server.server import SimulationServer
from linkwright.simulation.simulation import Simulation
from tests.simulation.test_plugins import robot, running_server
from tests.simulation.worlds import finder, world

PLUGIN = '<plugin name="p" filename="libMy.so"/>'
CMAKE = """project(tools)
set(PLUGINS my_arm my_wheel)
foreach(PLUGIN ${PLUGINS})
  add_library(${PLUGIN} SHARED src/${PLUGIN}.cc)
endforeach()
add_subdirectory(extra)
"""


@pytest.fixture
def package(tmp_path):
    folder = tmp_path / "tools"
    (folder / "extra").mkdir(parents=True)
    (folder / "src").mkdir()
    (folder / "package.xml").write_text("<package><name>tools</name></package>")
    (folder / "CMakeLists.txt").write_text(CMAKE)
    (folder / "extra" / "CMakeLists.txt").write_text("add_library(${PROJECT_NAME}_lamp lamp.cpp)")
    for file in ("src/my_arm.cc", "src/my_wheel.cc", "extra/lamp.cpp"):
        (folder / file).write_text("")
    return folder


def test_sources_are_found_in_loops_and_subdirectories(package):
    sources = find_plugin_sources({"my_wheel", "tools_lamp", "absent"}, {"tools": package})
    assert {name: (source.package, source.file) for name, source in sources.items()} == {
        "my_wheel": ("tools", package / "src" / "my_wheel.cc"),
        "tools_lamp": ("tools", package / "extra" / "lamp.cpp"),
    }


async def test_log_names_the_source_of_a_plugin_in_the_workspace(package):
    log: list[LogRecord] = []
    graph = Graph(on_log=log.append)
    plugins = '<plugin name="a" filename="libmy_arm.so"/>', '<plugin name="b" filename="libother.so"/>'
    simulation = Simulation(world(robot(*plugins)), finder(package))
    server = SimulationServer(simulation, graph.create_node("gazebo"))
    server.start()
    first, own, other = [record.text for record in log]
    assert first == "plugins and sensors that are not simulated: libmy_arm.so, libother.so"
    assert own.startswith("libmy_arm.so is C++ of the package 'tools', which is not loaded")
    assert own.endswith("my_arm.cc")
    assert other.startswith("no package here contains the source of libother.so")
    server.close()
    await graph.close()


async def test_plugin_of_a_visual_is_told_of():
    visual = '<visual name="v"><geometry><box><size>1 1 1</size></box></geometry>{}</visual>'
    model = f'<model name="m"><link name="l">{visual.format(PLUGIN)}</link></model>'
    async with running_server(model) as (_, __, log):
        assert log[0].text == "plugins and sensors that are not simulated: libMy.so"


@pytest.mark.parametrize("kind", ["sonar", "wireless_transmitter", "wide_angle_camera", "ray"])
async def test_sensor_without_a_substitute_is_told_of_with_what_to_use_instead(kind):
    sensor = f'<sensor name="s" type="{kind}"/>'
    model = f'<model name="m"><link name="l">{sensor}</link></model>'
    async with running_server(model) as (_, __, log):
        assert log[0].text == f"plugins and sensors that are not simulated: {kind}"
        assert log[1].text.startswith(f"instead of {kind}, use ")


def test_alternatives_are_for_what_is_not_simulated():
    simulated = {*extensions(PLUGIN_GROUP), *extensions(SENSOR_GROUP)}
    assert [name for name in ALTERNATIVES if name in simulated] == []


@pytest.mark.parametrize(
    ("library", "text"),
    [
        ("libgazebo_sonar_plugin.so", "sensor_msgs/Range"),
        ("libgazebo_ros_create_docking_status.so", "libgazebo_ros_p3d.so"),
        ("libgazebo_ros_video.so", "the display Image of the page"),
        ("gz-sim-dvl-system", "libuuv_gazebo_ros_dvl_plugin.so"),
        ("gz-waves1-hydrodynamics-system", "libPolyhedraBuoyancyDrag.so"),
        ("libhector_servo_plugin.so", "gz-sim-joint-position-controller-system"),
        ("libROSConveyorBeltPlugin.so", "gz-sim-track-controller-system"),
    ],
)
async def test_library_is_told_of_with_a_simulated_alternative(library, text):
    async with running_server(robot(f'<plugin name="a" filename="{library}"/>')) as (_, __, log):
        assert f"instead of {library}, use " in log[1].text
        assert text in log[1].text
