"""Plugins that add models, move them away, or pass transforms on."""

from __future__ import annotations

import pytest

from linkwright.messages import get_message
from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import box

CRUMB = '<breadcrumb><sdf version="1.6">{}</sdf></breadcrumb>'.format(box("crumb", "-1 0 0 0 0 0", "0.1 0.1 0.1"))
STEP_NS = SECOND_NS // 1000


def carrier(parameters: str, name: str = "carrier") -> str:
    plugin = f'<plugin name="gz::sim::systems::Breadcrumbs" filename="gz-sim-breadcrumbs-system">{parameters}</plugin>'
    return box(name, "3 2 1 0 0 1.5707963267948966").replace("</model>", f"{plugin}</model>")


class Deployer:
    def __init__(self, server, graph, topic: str) -> None:
        self.server, self.graph = server, graph
        node = graph.create_node("operator")
        self.remaining = Recording(graph, node, f"{topic}/remaining")
        self.publisher = node.create_publisher("std_msgs/msg/Empty", topic, 10)

    async def deploy(self) -> None:
        await self.graph.settle()
        self.publisher.publish(get_message("std_msgs/msg/Empty")())
        await self.graph.settle()
        self.server.advance(STEP_NS)
        await self.graph.settle()

    def counts(self) -> list[int]:
        return [message.data for message in self.remaining]


async def test_models_are_deployed_at_the_carrier_until_the_limit():
    parameters = f"<max_deployments>2</max_deployments>{CRUMB}"
    async with running_server(carrier(parameters), gravity="0 0 0") as (server, graph, log):
        deployer = Deployer(server, graph, "/model/carrier/breadcrumbs/crumb/deploy")
        await deployer.deploy()
        assert server.simulation.model_pose("crumb_0")[:3] == pytest.approx((3.0, 1.0, 1.0))  # 1 m behind
        server.simulation.set_model_pose("carrier", (9.0, 9.0, 9.0, 0.0, 0.0, 0.0, 1.0))
        await deployer.deploy()
        await deployer.deploy()
        assert sorted(server.simulation.scene.models) == ["carrier", "crumb_0", "crumb_1"]
        assert deployer.counts() == [1, 0, 0]
        assert not log


@pytest.mark.parametrize(("renaming", "names"), [("false", ["crumb_0"]), ("true", ["crumb_0", "crumb_0_1"])])
async def test_a_name_in_use_is_changed_only_if_this_is_allowed(renaming, names):
    parameters = f"<topic>/drop</topic><allow_renaming>{renaming}</allow_renaming>{CRUMB}"
    other = box("crumb_0", "-9 0 0 0 0 0")
    async with running_server(carrier(parameters), other, gravity="0 0 0") as (server, graph, log):
        deployer = Deployer(server, graph, "/drop")
        await deployer.deploy()
        assert sorted(server.simulation.scene.models) == ["carrier", *names]
        assert any("<allow_renaming>" in record.text for record in log) is (renaming == "false")


async def test_no_model_and_no_deployments():
    async with running_server(carrier(""), carrier("<max_deployments>0</max_deployments>", "idle")) as (_, __, log):
        assert ["needs an <sdf>" in record.text for record in log if "<sdf>" in record.text] == [True]


def bin_with(check: str) -> str:
    return (
        '<model name="bin"><static>true</static><link name="link"><collision name="floor"><geometry><box>'
        "<size>1 1 0.2</size></box></geometry></collision>"
        '<sensor name="touch" type="contact"><contact><collision>floor</collision></contact></sensor></link>'
        '<plugin name="disposal" filename="libObjectDisposalPlugin.so">'
        f"<contact_sensor_name>touch</contact_sensor_name>{check}<disposal_pose>20 0 5 0 0 0</disposal_pose>"
        "</plugin></model>"
    )


@pytest.mark.parametrize(
    ("check", "moved"),
    [("", ["inside", "outside"]), ("<center_of_gravity_check>true</center_of_gravity_check>", ["inside"])],
)
async def test_models_that_touch_the_bin_are_moved(check, moved):
    inside = box("inside", "0 0 0.149 0 0 0", "0.1 0.1 0.1")
    outside = box("outside", "0.7 0 0.149 0 0 0", "0.5 0.1 0.1")
    away = box("away", "0 3 0.5 0 0 0", "0.1 0.1 0.1")
    async with running_server(bin_with(check), inside, outside, away) as (server, _, log):
        server.advance(10 * STEP_NS)
        simulation = server.simulation
        names = [name for name in ("inside", "outside", "away") if simulation.model_pose(name)[0] > 10]
        assert names == moved
        assert not log


async def test_transforms_of_sensors_are_collected():
    plugin = '<plugin name="tf" filename="libMRSGazeboStaticTransformRepublisher.so"/>'
    async with running_server(plugin) as (server, graph, _):
        node = graph.create_node("sensors")
        publisher = node.create_publisher("tf2_msgs/msg/TFMessage", "/tf_gazebo_static", 10)
        recording = Recording(graph, node, "/tf_static")
        for frames in (("camera", "lens"), ("lidar",), ("camera", "other"), ()):
            transforms = [get_message("geometry_msgs/msg/TransformStamped")(child_frame_id=frame) for frame in frames]
            await graph.settle()
            publisher.publish(get_message("tf2_msgs/msg/TFMessage")(transforms=transforms))
            await graph.settle()
            server.advance(STEP_NS)
            await graph.settle()
        messages = [[transform.child_frame_id for transform in message.transforms] for message in recording]
        assert messages == [["camera", "lens"], ["camera", "lens", "lidar"]]
