"""The panels Services, Publisher, Controllers and Joint trajectory."""

from __future__ import annotations

from typing import Any

import pytest

from linkwright.graph import QoSProfile
from linkwright.graph.qos.profile import DurabilityPolicy
from linkwright.messages import get_message, get_service
from tests.panels.monitor.test_live_panels import open_client
from tests.waiting import eventually

ADD = "example_interfaces/srv/AddTwoInts"
FLOAT = "std_msgs/msg/Float64"
MANAGER = "/controller_manager"
ROBOT = """<robot name='r'><link name='base'/><link name='arm'/>
<joint name='elbow' type='revolute'><parent link='base'/><child link='arm'/><axis xyz='0 0 1'/>
<limit lower='-1' upper='2' effort='1' velocity='0.5'/></joint></robot>"""
TRAJECTORY = "trajectory_msgs/msg/JointTrajectory"


# --- services ------------------------------------------------------------------------------------------------------


async def test_service_is_listed_and_called():
    async with open_client() as (world, client):

        def add(request: Any, response: Any) -> Any:
            response.sum = request.a + request.b
            return response

        world.graph.create_node("adder").create_service(get_service(ADD), "/add", add)
        await client.send("watch_services", watched=True)
        services = (await client.until("service_list"))["services"]
        while {"name": "/add", "kind": ADD} not in services:
            services = (await client.until("service_list"))["services"]
        await client.send("choose_service", service="/add")
        request = await client.until("service_request")
        assert (request["kind"], request["text"].split(), request["error"]) == (ADD, ["a:", "0", "b:", "0"], None)
        await client.send("call_service", service="/add", text="a: 2\nb: 3")
        response = await client.until("service_response")
        assert (response["fields"][0]["name"], response["fields"][0]["value"]) == ("sum", "5")


@pytest.mark.parametrize(
    ("text", "message"),
    [("c: 1", "'c'"), ("a: [", "the values are not YAML"), ("a", "write 'field: value'"), ("a: word", "a")],
)
async def test_request_that_does_not_fit_is_explained(text: str, message: str):
    async with open_client() as (world, client):
        world.graph.create_node("adder").create_service(get_service(ADD), "/add", lambda _, response: response)
        await client.send("call_service", service="/add", text=text)
        assert message in (await client.until("service_response"))["error"]


async def test_service_that_does_not_exist_is_explained():
    async with open_client() as (_, client):
        await client.send("call_service", service="/nothing", text="")
        assert (await client.until("service_response"))["error"] == "no node offers the service /nothing"


# --- publishers ----------------------------------------------------------------------------------------------------


def publisher(**changes: Any) -> dict[str, Any]:
    return {"id": 1, "topic": "/speed", "kind": FLOAT, "rate": 100.0, "text": "data: 1.5", "is_on": True, **changes}


async def test_messages_are_published_at_rate_until_page_closes():
    async with open_client() as (world, client):
        values: list[float] = []
        node = world.graph.create_node("listener")
        node.create_subscription(get_message(FLOAT), "/speed", lambda message: values.append(message.data), 10)
        await client.send("set_publishers", publishers=[publisher()])
        await eventually(lambda: len(values) > 5)
        assert set(values) == {1.5}
        states = (await client.until("publisher_states"))["states"]
        while states[0]["count"] == 0:
            states = (await client.until("publisher_states"))["states"]
        assert (states[0]["subscribers"], states[0]["error"]) == (1, None)
        await client.send("set_publishers", publishers=[publisher(is_on=False, text="data: 2.0")])
        await client.send("publish_once", id=1)
        await eventually(lambda: values[-1] == 2.0)
    await eventually(lambda: world.graph.count_publishers("/speed") == 0)


async def test_text_that_does_not_fit_stops_publisher():
    async with open_client() as (_, client):
        await client.send("set_publishers", publishers=[publisher(text="speed: 1.0")])
        states = (await client.until("publisher_states"))["states"]
        assert "speed" in states[0]["error"]


async def test_template_of_a_type_is_sent():
    async with open_client() as (_, client):
        await client.send("request_types")
        assert FLOAT in (await client.until("message_types"))["types"]
        await client.send("request_template", name=FLOAT)
        assert (await client.until("message_template"))["text"].strip() == "data: 0.0"


# --- controllers ---------------------------------------------------------------------------------------------------


class Manager:
    """The services of a controller manager with one controller."""

    def __init__(self, world: Any) -> None:
        self.state = "inactive"
        self.calls: list[Any] = []
        parameters = {"arm.type": "a/Arm", "spare.type": "a/Spare"}
        node = world.graph.create_node(
            "controller_manager", parameters=parameters, automatically_declare_parameters_from_overrides=True
        )
        for service, answer in (
            ("list_controllers", self._list),
            ("list_hardware_components", self._list_hardware),
            ("switch_controller", self._switch),
            ("load_controller", self._refuse),
            ("set_hardware_component_state", self._change_hardware),
        ):
            kind = "".join(word.capitalize() for word in service.split("_"))
            node.create_service(get_service(f"controller_manager_msgs/srv/{kind}"), f"~/{service}", answer)

    def _list(self, _: Any, response: Any) -> Any:
        controller = get_message("controller_manager_msgs/msg/ControllerState")
        claimed = ["j/position"]
        response.controller = [controller(name="arm", type="a/Arm", state=self.state, claimed_interfaces=claimed)]
        return response

    def _list_hardware(self, _: Any, response: Any) -> Any:
        component = get_message("controller_manager_msgs/msg/HardwareComponentState")(name="mock", plugin_name="m/Mock")
        component.state.label = "active"
        response.component = [component]
        return response

    def _switch(self, request: Any, response: Any) -> Any:
        self.calls.append(request)
        self.state = "active" if request.activate_controllers else "inactive"
        response.ok = True
        return response

    def _refuse(self, request: Any, response: Any) -> Any:
        self.calls.append(request)
        return response

    def _change_hardware(self, request: Any, response: Any) -> Any:
        self.calls.append(request)
        response.ok = True
        return response


async def test_controllers_and_hardware_are_listed_and_changed():
    async with open_client() as (world, client):
        manager = Manager(world)
        await client.send("watch_controllers", wants_list=True, manager=None)
        while MANAGER not in (await client.until("controller_managers"))["managers"]:
            pass
        await client.send("watch_controllers", wants_list=True, manager=MANAGER)
        listed = await client.until("controller_list")
        assert listed["controllers"] == [
            {"name": "arm", "kind": "a/Arm", "state": "inactive", "claimed": ["j/position"]},
            {"name": "spare", "kind": "a/Spare", "state": "not loaded", "claimed": []},
        ]
        assert [(row["name"], row["state"]) for row in listed["hardware"]] == [("mock", "active")]
        await client.send("change_controller", manager=MANAGER, name="arm", action="activate")
        assert (await client.until("controller_result"))["text"] == ""
        assert list(manager.calls[0].activate_controllers) == ["arm"]
        assert (await client.until("controller_list"))["controllers"][0]["state"] == "active"
        await client.send("change_controller", manager=MANAGER, name="spare", action="load")
        assert "could not change 'spare'" in (await client.until("controller_result"))["text"]
        await client.send("change_hardware", manager=MANAGER, name="mock", state="inactive")
        assert (await client.until("controller_result"))["text"] == ""
        assert manager.calls[-1].target_state.label == "inactive"


# --- trajectories --------------------------------------------------------------------------------------------------


async def test_joints_have_limits_and_positions_and_are_moved():
    async with open_client() as (world, client):
        trajectories: list[Any] = []
        node = world.graph.create_node(
            "arm", parameters={"joints": ["elbow"]}, automatically_declare_parameters_from_overrides=True
        )
        node.create_subscription(get_message(TRAJECTORY), "~/joint_trajectory", trajectories.append, 10)
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_publisher("std_msgs/msg/String", "/robot_description", qos).publish(
            get_message("std_msgs/msg/String")(data=ROBOT)
        )
        states = node.create_publisher("sensor_msgs/msg/JointState", "/joint_states", 10)
        await client.send("watch_trajectory", wants_list=True, controller=None)
        while "/arm" not in (await client.until("trajectory_controllers"))["controllers"]:
            pass
        await client.send("watch_trajectory", wants_list=True, controller="/arm")
        joints: list[Any] = []
        while not joints or joints[0]["position"] is None or joints[0]["lower"] is None:
            states.publish(get_message("sensor_msgs/msg/JointState")(name=["elbow"], position=[0.25]))
            joints = (await client.until("trajectory_controller"))["joints"]
        assert joints == [{"name": "elbow", "position": 0.25, "lower": -1.0, "upper": 2.0, "velocity": 0.5}]
        await client.send("move_joints", controller="/arm", positions=[0.5], seconds=1.5)
        await eventually(lambda: len(trajectories) == 1)
        (point,) = trajectories[0].points
        assert (list(trajectories[0].joint_names), list(point.positions)) == (["elbow"], [0.5])
        assert (point.time_from_start.sec, point.time_from_start.nanosec) == (1, 500_000_000)
