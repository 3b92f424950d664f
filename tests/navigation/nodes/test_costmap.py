"""Costmaps of nav2's servers on the graph.

The tests cover maps, scans, rolling windows, services, parameters.
"""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.graph import DESCRIPTION_QOS, SENSOR_DATA_QOS, Parameter
from linkwright.graph.lifecycle.states import TransitionCallbackReturn
from linkwright.messages import get_message, get_service
from linkwright.navigation.costmaps.costmap import FREE, INSCRIBED, LETHAL
from linkwright.navigation.grids.occupancy import occupancy_message
from linkwright.navigation.nodes.costmap import make_costmap
from linkwright.navigation.nodes.costmap_filter_info_server import CostmapFilterInfoServer
from linkwright.nodes import NodeOptions
from tests.navigation.nodes.fake_robot import FakeRobot, make_room_cells

GLOBAL = {
    "global_frame": "map",
    "robot_base_frame": "base_link",
    "resolution": 0.05,
    "robot_radius": 0.2,
    "update_frequency": 5.0,
    "publish_frequency": 5.0,
    "plugins": ["static_layer", "obstacle_layer", "inflation_layer"],
    "obstacle_layer.plugin": "nav2_costmap_2d::ObstacleLayer",
    "obstacle_layer.observation_sources": "scan",
    "obstacle_layer.scan.topic": "/scan",
    "obstacle_layer.scan.clearing": True,
    "obstacle_layer.scan.max_obstacle_height": 2.0,
}
LOCAL = {
    **GLOBAL,
    "global_frame": "odom",
    "rolling_window": True,
    "width": 2,
    "height": 2,
    "plugins": ["voxel_layer", "inflation_layer"],
    "voxel_layer.plugin": "nav2_costmap_2d::VoxelLayer",
    "voxel_layer.observation_sources": "scan",
    "voxel_layer.scan.topic": "/scan",
    "voxel_layer.scan.clearing": True,
    "voxel_layer.scan.max_obstacle_height": 2.0,
}


@pytest.fixture
def robot(graph, clock) -> FakeRobot:
    return FakeRobot(graph, clock)


@pytest.fixture
def start(graph, robot):
    nodes = []

    def start(name="global_costmap", parameters=GLOBAL, **server_parameters):
        options = NodeOptions()
        for key, value in {**parameters, **server_parameters}.items():
            options.parameters_of_others.set(f"/{name}/{name}", key, value)
        node = make_costmap(robot.node, graph, options, name)
        nodes.append(node)
        if node.trigger_configure() == TransitionCallbackReturn.SUCCESS:
            node.trigger_activate()
        return node

    yield start
    for node in nodes:
        node.shut_down()
        node.destroy_node()


async def call_service(robot, service, service_type, **fields):
    service_type = get_service(f"nav2_msgs/srv/{service_type}")
    client = robot.node.create_client(service_type, service)
    future = client.call_async(service_type.Request(**fields))
    await robot.graph.settle()
    assert future.done()
    return future.result()


async def test_global_costmap_has_size_of_map(robot, start):
    node = start()
    assert node.get_fully_qualified_name() == "/global_costmap/global_costmap"
    robot.publish_map(make_room_cells())
    robot.publish_pose()
    await robot.run(0.5)
    costs = node.costmap.grid.cells
    assert costs.shape == (60, 80)
    assert costs[30, 0] == LETHAL
    assert costs[30, 3] == INSCRIBED
    assert costs[30, 40] == FREE
    assert node.is_current


async def test_costmap_inherits_tf_remappings_of_server(graph, robot):
    """The costmap inherits the remappings of transforms from its server.

    nav2's launch files use relative names for these topics, for robots in namespaces.
    """
    options = NodeOptions(remappings=[("/tf", "tf"), ("/tf_static", "tf_static")])
    node = make_costmap(robot.node, graph, options, "global_costmap")
    topics = {subscription.topic_name for subscription in node.subscriptions}
    assert {"/tf", "/tf_static"} <= topics
    node.shut_down()
    node.destroy_node()


async def test_costmap_waits_for_transform_and_map(robot, start):
    node = start()
    await robot.run(0.5)
    assert not node.is_current
    robot.publish_pose()
    await robot.run(0.5)
    assert not node.is_current
    robot.publish_map(make_room_cells())
    await robot.run(0.5)
    assert node.is_current


async def test_laser_obstacles_are_marked_and_cleared(robot, start):
    node = start()
    robot.publish_map(make_room_cells())
    robot.publish_pose()
    robot.publish_scan((0, 1.0))
    await robot.run(0.3)
    assert node.costmap.cost_at(np.array([2.0, 1.0])) == LETHAL
    robot.publish_pose()
    robot.publish_scan()
    await robot.run(0.3)
    assert node.costmap.cost_at(np.array([2.0, 1.0])) == FREE


async def test_scan_waits_for_its_transform(robot, start):
    node = start()
    robot.publish_map(make_room_cells())
    robot.publish_pose(x=0.5)
    await robot.run(0.3)
    robot.publish_scan((0, 1.0))
    await robot.run(0.3)
    assert node.costmap.cost_at(np.array([1.5, 1.0])) == FREE
    robot.publish_pose(x=1.0)  # the time of the scan is between this transform and the previous one
    await robot.run(0.3)
    obstacle_cells = np.argwhere(node.costmap.grid.cells[15:25, 20:50] == LETHAL)
    assert len(obstacle_cells) == 1
    assert 1.5 < (obstacle_cells[0, 1] + 20) * 0.05 < 2.0


async def test_local_costmap_moves_with_robot(robot, start):
    node = start("local_costmap", LOCAL)
    robot.publish_pose()
    robot.publish_scan((0, 0.8))
    await robot.run(0.3)
    assert node.costmap.grid.cells.shape == (40, 40)
    assert node.costmap.cost_at(np.array([1.8, 1.0])) == LETHAL
    robot.publish_pose(x=1.5)
    robot.publish_scan((0, 0.3))
    await robot.run(0.3)
    assert node.costmap.grid.x == pytest.approx(0.5)
    assert node.costmap.cost_at(np.array([1.8, 1.0])) == LETHAL


async def test_sonar_readings_mark_obstacle(robot, start):
    node = start(
        plugins=["sonar"],
        **{"sonar.plugin": "nav2_costmap_2d::RangeSensorLayer", "sonar.topics": ["sonar"]},
    )
    kind = get_message("sensor_msgs/msg/Range")
    publisher = robot.node.create_publisher(kind, "/sonar", SENSOR_DATA_QOS)
    for _ in range(5):
        message = kind(field_of_view=0.5, min_range=0.1, max_range=3.0, range=1.0)
        message.header.frame_id, message.header.stamp = "base_link", robot.stamp()
        publisher.publish(message)
        robot.publish_pose()
        await robot.run(0.2)
    assert node.costmap.cost_at(np.array([2.0, 1.0])) == LETHAL
    assert node.costmap.cost_at(np.array([1.5, 1.0])) == FREE


async def test_costmap_topics_are_published(robot, start):
    maps, updates, raw, outlines = [], [], [], []
    for message_type, topic, received in (
        ("nav_msgs/msg/OccupancyGrid", "costmap", maps),
        ("map_msgs/msg/OccupancyGridUpdate", "costmap_updates", updates),
        ("nav2_msgs/msg/Costmap", "costmap_raw", raw),
    ):
        robot.node.create_subscription(
            get_message(message_type), f"/global_costmap/{topic}", received.append, DESCRIPTION_QOS
        )
    polygon = get_message("geometry_msgs/msg/PolygonStamped")
    robot.node.create_subscription(polygon, "/global_costmap/published_footprint", outlines.append, 10)
    node = start()
    robot.publish_map(make_room_cells(columns=300))
    robot.publish_pose()
    await robot.run(0.5)
    result = np.array(maps[-1].data, np.int8).reshape(60, 300)
    assert (result[30, 0], result[30, 3], result[30, 40]) == (100, 99, 0)
    assert np.array_equal(np.array(raw[-1].data, np.uint8).reshape(60, 300), node.costmap.grid.cells)
    assert len(outlines[-1].polygon.points) == 16
    count = len(maps)
    robot.publish_pose()
    robot.publish_scan((0, 1.0))
    await robot.run(0.5)
    assert len(maps) == count  # only a part changed
    update = updates[-1]
    assert update.width < 300
    cells = np.array(update.data, np.int8).reshape(update.height, update.width)
    assert cells[20 - update.y, 40 - update.x] == 100 or cells[19 - update.y, 39 - update.x] == 100


async def test_clear_services_clear_costmap(robot, start):
    node = start()
    robot.publish_map(make_room_cells())
    robot.publish_pose()
    robot.publish_scan((0, 1.0), (180, 0.5))
    await robot.run(0.3)
    layer = node.layered.layers[1]
    layer.buffers[0].add(np.zeros(3), np.zeros((0, 3)), 0)  # the obstacle is no longer observed
    near_point, far_point = np.array([0.5, 1.0]), np.array([2.0, 1.0])
    await call_service(
        robot, "/global_costmap/clear_around_global_costmap", "ClearCostmapAroundRobot", reset_distance=1.2
    )
    assert node.costmap.cost_at(near_point) < INSCRIBED
    assert node.costmap.cost_at(far_point) == LETHAL
    await call_service(
        robot, "/global_costmap/clear_except_global_costmap", "ClearCostmapExceptRegion", reset_distance=1.2
    )
    assert node.costmap.cost_at(far_point) == FREE
    layer.layer_grid.cells[20, 40] = LETHAL
    await call_service(robot, "/global_costmap/clear_entirely_global_costmap", "ClearEntireCostmap")
    assert node.costmap.cost_at(far_point) == FREE
    assert node.costmap.grid.cells[30, 0] == LETHAL
    response = await call_service(robot, "/global_costmap/get_costmap", "GetCostmap")
    assert response.map.metadata.size_x == 80


async def test_footprint_parameter_replaces_radius(robot, start):
    node = start(footprint="[[0.3, 0.1], [0.3, -0.1], [-0.3, -0.1], [-0.3, 0.1]]", footprint_padding=0.0)
    assert node.footprint.tolist() == [[0.3, 0.1], [0.3, -0.1], [-0.3, -0.1], [-0.3, 0.1]]
    assert node.layered.inscribed_radius == pytest.approx(0.1)


async def test_changed_parameters_take_effect(robot, start):
    node = start()
    robot.publish_map(make_room_cells())
    robot.publish_pose()
    await robot.run(0.3)
    point = np.array([0.5, 1.5])
    assert node.costmap.cost_at(point) > FREE
    node.set_parameters([Parameter("inflation_layer.inflation_radius", value=0.3)])
    await robot.run(0.3)
    assert node.costmap.cost_at(point) == FREE
    node.set_parameters([Parameter("inflation_layer.enabled", value=False), Parameter("robot_radius", value=0.4)])
    await robot.run(0.3)
    assert node.costmap.cost_at(np.array([0.1, 1.5])) == FREE
    assert node.layered.circumscribed_radius == pytest.approx(0.41, abs=0.01)


async def test_unsupported_layers_and_filters_are_reported_and_ignored(robot, start, log):
    start(
        plugins=["static_layer", "sonar"],
        filters=["binary_filter"],
        **{
            "sonar.plugin": "my_package::Sonar",
            "sonar.topics": ["/sonar"],
            "binary_filter.plugin": "nav2_costmap_2d::BinaryFilter",
            "binary_filter.enabled": True,
        },
    )
    texts = [record.text for record in log]
    assert "layers of type my_package::Sonar are not supported: the costmap ignores 'sonar'" in texts
    kind = "nav2_costmap_2d::BinaryFilter"
    assert f"filters of type {kind} are not supported: the costmap ignores 'binary_filter'" in texts
    assert "layers that 'plugins' does not name are ignored: obstacle_layer" in texts
    assert not [text for text in texts if "is not a parameter" in text or "are not read" in text]


def filter_parameters(name: str, kind: str) -> dict[str, object]:
    return {
        "filters": [name],
        f"{name}.plugin": f"nav2_costmap_2d::{kind}",
        f"{name}.filter_info_topic": "/filter_info",
        f"{name}.speed_limit_topic": "/speed_limit",
    }


def publish_mask(robot, value: int) -> None:
    """Publish a mask of the room whose left half has a value."""
    mask = make_room_cells()
    mask.cells[:] = 0
    mask.cells[:, :40] = value
    publisher = robot.node.create_publisher("nav_msgs/msg/OccupancyGrid", "/mask", DESCRIPTION_QOS)
    publisher.publish(occupancy_message(mask, "map", robot.stamp()))


def start_info_server(robot, **parameters):
    values = {"filter_info_topic": "/filter_info", "mask_topic": "/mask", "autostart_node": True, **parameters}
    return CostmapFilterInfoServer(robot.graph, NodeOptions(parameters=values))


async def test_keepout_zone_of_mask_is_lethal_until_filter_is_switched_off(robot, start):
    server = start_info_server(robot)
    publish_mask(robot, 100)
    node = start(**filter_parameters("keepout_filter", "KeepoutFilter"))
    robot.publish_map(make_room_cells())
    robot.publish_pose()
    await robot.run(0.5)
    zone, outside = np.array([1.0, 1.5]), np.array([3.0, 1.5])
    assert (node.costmap.cost_at(zone), node.costmap.cost_at(outside)) == (LETHAL, FREE)
    client = robot.node.create_client(
        get_service("std_srvs/srv/SetBool"), "/global_costmap/keepout_filter/toggle_filter"
    )
    future = client.call_async(client.srv_type.Request(data=False))
    await robot.run(0.3)
    assert future.result().message == "Disabled"
    assert node.costmap.cost_at(zone) == FREE
    node.set_parameters([Parameter("keepout_filter.enabled", value=True)])
    await robot.run(0.3)
    assert node.costmap.cost_at(zone) == LETHAL
    server.close()


async def test_speed_limit_of_mask_is_published(robot, start):
    server = start_info_server(robot, type=1, base=100.0, multiplier=-1.0)
    publish_mask(robot, 70)
    limits: list = []
    robot.node.create_subscription("nav2_msgs/msg/SpeedLimit", "/speed_limit", limits.append, 10)
    start(**filter_parameters("speed_filter", "SpeedFilter"))
    robot.publish_map(make_room_cells())
    robot.publish_pose(1.0, 1.5)
    await robot.run(0.5)
    robot.publish_pose(3.0, 1.5)
    await robot.run(0.5)
    assert [(limit.percentage, limit.speed_limit) for limit in limits] == [(True, 30.0), (True, 0.0)]
    server.close()


@pytest.mark.parametrize(
    ("parameters", "reason"),
    [
        ({"filters": ["keepout"]}, "parameter 'keepout.plugin' of 'global_costmap' is not set"),
        ({"resolution": 0.0}, "parameter 'resolution' of 'global_costmap' cannot be '0.0'"),
        ({"footprint": "[[1, 2]]"}, "'[[1, 2]]' has 1"),
        ({"plugins": ["mine"]}, "parameter 'mine.plugin' of 'global_costmap' is not set"),
        ({"obstacle_layer.scan.data_type": "Image"}, "choose from LaserScan, PointCloud2"),
    ],
)
async def test_invalid_parameters_are_reported(robot, start, log, parameters, reason):
    node = start(**parameters)
    assert not node.is_active
    assert [record for record in log if reason in record.text]
