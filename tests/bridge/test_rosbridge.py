"""rosbridge_websocket with clients that speak its protocol."""

from __future__ import annotations

import asyncio
import json

import pytest

from linkwright.bridge.rosbridge import actions
from linkwright.graph import (
    LATCHED_QOS,
    SENSOR_DATA_QOS,
    ActionClient,
    ActionServer,
    CancelResponse,
    GoalResponse,
    GoalStatus,
)
from linkwright.messages import String, get_message
from linkwright.nodes.options import EXECUTABLES
from tests.bridge.rosbridge_client import add_set_bool, rosbridge_setup
from tests.waiting import eventually

TWIST = "geometry_msgs/msg/Twist"
TRIGGER = "std_srvs/srv/Trigger"
FIBONACCI = "example_interfaces/action/Fibonacci"


def test_executables_are_registered_for_launch_files():
    for executable in ("rosbridge_websocket", "rosbridge_websocket.py"):
        assert ("rosbridge_server", executable) in EXECUTABLES
    assert ("rosapi", "rosapi_node") in EXECUTABLES


# --- topics ----------------------------------------------------------------------------------------------------------


async def test_messages_reach_a_client_until_it_unsubscribes():
    async with rosbridge_setup() as setup, setup.client() as client:
        publisher = setup.node.create_publisher(String, "/chatter", 10)
        await client.send("subscribe", topic="/chatter", id="one")
        await eventually(lambda: publisher.get_subscription_count() == 1)
        publisher.publish(String(data="hello"))
        assert await client.next() == {"op": "publish", "topic": "/chatter", "msg": {"data": "hello"}}
        await client.send("unsubscribe", topic="/chatter", id="one")
        await eventually(lambda: publisher.get_subscription_count() == 0)


async def test_topic_is_subscribed_to_until_the_last_request_is_withdrawn():
    async with rosbridge_setup() as setup, setup.client() as client:
        publisher = setup.node.create_publisher(String, "/chatter", 10)
        for identity in ("one", "two", "three"):
            await client.send("subscribe", topic="/chatter", id=identity, type="std_msgs/String")
        await client.send("unsubscribe", topic="/chatter", id="one")
        await eventually(lambda: publisher.get_subscription_count() == 1)
        publisher.publish(String(data="a"))
        assert (await client.next())["msg"] == {"data": "a"}  # once, for both
        await client.send("unsubscribe", topic="/chatter")
        await eventually(lambda: publisher.get_subscription_count() == 0)


async def test_topic_may_be_subscribed_to_before_it_is_published():
    async with rosbridge_setup() as setup, setup.client() as client:
        await client.send("subscribe", topic="/late", type="std_msgs/String")
        await eventually(lambda: setup.graph.count_subscribers("/late") == 1)
        best_effort = setup.node.create_publisher(String, "/late", SENSOR_DATA_QOS)
        await eventually(lambda: best_effort.get_subscription_count() == 1)  # by another QoS
        best_effort.publish(String(data="a"))
        assert (await client.next())["msg"] == {"data": "a"}


async def test_each_client_receives_the_latched_message():
    async with rosbridge_setup() as setup:
        setup.node.create_publisher(String, "/description", LATCHED_QOS).publish(String(data="robot"))
        async with setup.client() as first, setup.client() as second:
            for client in (first, second):
                await client.send("subscribe", topic="/description")
                assert (await client.next())["msg"] == {"data": "robot"}


async def test_throttled_messages_are_dropped():
    async with rosbridge_setup() as setup, setup.client() as client:
        publisher = setup.node.create_publisher(String, "/chatter", 100)
        await client.send("subscribe", topic="/chatter", throttle_rate=60_000)
        await eventually(lambda: publisher.get_subscription_count() == 1)
        for number in range(5):
            publisher.publish(String(data=str(number)))
        assert (await client.next())["msg"] == {"data": "0"}
        await client.send("subscribe", topic="/chatter", id="fast")  # the lowest rate applies
        await client.send("unknown")
        await client.until("status")
        publisher.publish(String(data="5"))
        assert (await client.next())["msg"] == {"data": "5"}


async def test_throttled_messages_wait_in_the_queue_and_the_oldest_are_dropped():
    async with rosbridge_setup() as setup, setup.client() as client:
        publisher = setup.node.create_publisher(String, "/chatter", 100)
        await client.send("subscribe", topic="/chatter", throttle_rate=50, queue_length=2)
        await eventually(lambda: publisher.get_subscription_count() == 1)
        loop = asyncio.get_running_loop()
        start_s = loop.time()
        for number in range(5):
            publisher.publish(String(data=str(number)))
        received = [(await client.next())["msg"]["data"] for _ in range(3)]
        assert received == ["0", "3", "4"]
        assert loop.time() - start_s >= 0.1


async def test_binary_forms_are_sent_if_a_client_asks_for_them():
    async with rosbridge_setup() as setup, setup.client() as client:
        publisher = setup.node.create_publisher(String, "/chatter", 10)
        for compression, part in (("cbor", b"\x64data\x61a"), ("cbor-raw", b"\x65bytes"), ("png", None)):
            await client.send("subscribe", topic="/chatter", id=compression, compression=compression)
            await client.send("unknown")
            await client.until("status")
            await eventually(lambda: publisher.get_subscription_count() == 1)
            publisher.publish(String(data="a"))
            message = await client.next()
            assert message["op"] == "png" if part is None else part in message
            await client.send("unsubscribe", topic="/chatter")
            await eventually(lambda: publisher.get_subscription_count() == 0)


async def test_long_messages_are_sent_in_fragments():
    async with rosbridge_setup() as setup, setup.client() as client:
        publisher = setup.node.create_publisher(String, "/chatter", 10)
        await client.send("subscribe", topic="/chatter", fragment_size=20)
        await eventually(lambda: publisher.get_subscription_count() == 1)
        publisher.publish(String(data="hello"))
        first = await client.next()
        fragments = [first] + [await client.next() for _ in range(first["total"] - 1)]
        assert [fragment["num"] for fragment in fragments] == list(range(first["total"]))
        text = "".join(fragment["data"] for fragment in fragments)
        assert json.loads(text)["msg"] == {"data": "hello"}


async def test_client_publishes():
    async with rosbridge_setup() as setup, setup.client() as client:
        received = []
        await client.send("advertise", topic="/cmd_vel", type="geometry_msgs/Twist", id="a")
        await eventually(lambda: setup.graph.count_publishers("/cmd_vel") == 1)
        setup.node.create_subscription(TWIST, "/cmd_vel", received.append, 10)
        await client.send("publish", topic="/cmd_vel", msg={"linear": {"x": 0.5}})
        await eventually(lambda: received)
        assert received[0].linear.x == 0.5


async def test_message_in_fragments_is_published():
    async with rosbridge_setup() as setup, setup.client() as client:
        received = []
        setup.node.create_subscription(String, "/chatter", received.append, 10)
        text = json.dumps({"op": "publish", "topic": "/chatter", "msg": {"data": "hello"}})
        for number, data in enumerate((text[:10], text[10:])):
            await client.send("fragment", id="f", num=number, total=2, data=data)
        await eventually(lambda: received)
        assert received[0].data == "hello"


async def test_topic_that_others_use_needs_no_advertisement():
    async with rosbridge_setup() as setup, setup.client() as client:
        received = []
        setup.node.create_subscription(String, "/chatter", received.append, 10)
        await client.send("publish", topic="/chatter", msg={"data": "a"})
        await eventually(lambda: received)


async def test_clients_share_a_publisher_that_outlives_them_for_a_time():
    async with rosbridge_setup(unregister_timeout=0.2) as setup:
        async with setup.client() as first, setup.client() as second:
            for client in (first, second):
                await client.send("advertise", topic="/a", type="std_msgs/String")
            await second.send("unknown")
            await second.until("status")
            assert setup.graph.count_publishers("/a") == 1
            await first.send("unadvertise", topic="/a")
        assert setup.graph.count_publishers("/a") == 1
        await eventually(lambda: setup.graph.count_publishers("/a") == 0)


async def test_latched_message_of_a_client_reaches_late_subscriptions():
    async with rosbridge_setup() as setup, setup.client() as client:
        await client.send("advertise", topic="/map_name", type="std_msgs/String", latch=True)
        await client.send("publish", topic="/map_name", msg={"data": "house"}, latch=True)
        await client.send("unknown")
        await client.until("status")
        received = []
        setup.node.create_subscription(String, "/map_name", received.append, LATCHED_QOS)
        await eventually(lambda: received)


async def test_client_that_disconnects_leaves_nothing_behind():
    async with rosbridge_setup(unregister_timeout=0.05) as setup:
        publisher = setup.node.create_publisher(String, "/chatter", 10)
        async with setup.client() as client:
            await client.send("subscribe", topic="/chatter")
            await client.send("advertise", topic="/a", type="std_msgs/String")
            await client.send("advertise_service", service="/s", type="std_srvs/Trigger")
            await client.send("advertise_action", action="/f", type="example_interfaces/Fibonacci")
            await eventually(lambda: publisher.get_subscription_count() == 1)
            await eventually(lambda: setup.graph.count_services("/s") == 1)
            await eventually(lambda: setup.graph.count_publishers("/f/_action/status") == 1)
            assert setup.graph.count_publishers("/a") == 1
        await eventually(lambda: publisher.get_subscription_count() == 0)
        await eventually(lambda: setup.graph.count_services("/s") == 0)
        await eventually(lambda: setup.graph.count_publishers("/f/_action/status") == 0)
        await eventually(lambda: setup.graph.count_publishers("/a") == 0)


@pytest.mark.parametrize("topic_type", ["geometry_msgs/Twist", "geometry_msgs/TwistStamped"])
async def test_robot_stops_when_the_client_that_drives_it_disconnects(topic_type):
    async with rosbridge_setup() as setup:
        received = []
        full_type = topic_type.replace("/", "/msg/")
        setup.node.create_subscription(full_type, "/cmd_vel", received.append, 10)
        twist = {"linear": {"x": 0.5}}
        async with setup.client() as client:
            await client.send(
                "publish", topic="/cmd_vel", msg={"twist": twist} if topic_type.endswith("Stamped") else twist
            )
            await eventually(lambda: received)
        await eventually(lambda: len(received) == 2)
        velocity = getattr(received[1], "twist", received[1])
        assert velocity == get_message(TWIST)()
        assert any("a stop command is sent to '/cmd_vel'" in text for text in setup.texts)


@pytest.mark.parametrize("ending", ["unadvertised", "stopped"])
async def test_no_stop_is_sent_for_a_client_that_has_ended_its_drive(ending):
    async with rosbridge_setup() as setup:
        received = []
        setup.node.create_subscription(TWIST, "/cmd_vel", received.append, 10)
        async with setup.client() as client:
            await client.send("publish", topic="/cmd_vel", msg={"linear": {"x": 0.5}})
            if ending == "unadvertised":
                await client.send("unadvertise", topic="/cmd_vel")
            else:
                await client.send("publish", topic="/cmd_vel", msg={})
            await client.send("unknown")
            await client.until("status")
        await eventually(lambda: any("Client disconnected" in text for text in setup.texts))
        assert not any("stop command" in text for text in setup.texts)


# --- services --------------------------------------------------------------------------------------------------------


async def test_client_calls_a_service():
    async with rosbridge_setup() as setup, setup.client() as client:
        add_set_bool(setup)
        for args in ({"data": True}, [True]):
            assert await client.call("/switch", args, id="c") == {
                "op": "service_response",
                "service": "/switch",
                "values": {"success": True, "message": "done"},
                "result": True,
                "id": "c",
            }
        assert (await client.call("/switch#7"))["id"] == "7"


async def test_failed_call_has_a_reason():
    async with rosbridge_setup() as setup, setup.client() as client:
        add_set_bool(setup)
        missing = await client.call("/nothing", id="c")
        assert (missing["result"], missing["values"]) == (False, "Service /nothing does not exist")
        wrong = await client.call("/switch", {"datum": True})
        assert wrong["result"] is False
        assert "does not have a field datum" in wrong["values"]


async def test_call_without_response_ends_after_its_timeout():
    async with rosbridge_setup(default_call_service_timeout=0.1) as setup, setup.client() as client:
        setup.node.create_service(TRIGGER, "/silent", lambda request, reply: None, replying=True)
        for fields in ({}, {"timeout": 0.05}):
            response = await client.call("/silent", **fields)
            assert response["result"] is False
            assert "Timeout exceeded" in response["values"]


async def test_calls_do_not_wait_for_each_other():
    async with rosbridge_setup() as setup, setup.client() as client:
        add_set_bool(setup)
        replies = []
        setup.node.create_service(
            "std_srvs/srv/Trigger", "/slow", lambda _, reply: replies.append(reply), replying=True
        )
        await client.send("call_service", service="/slow", id="slow")
        assert (await client.call("/switch", {"data": False}, id="fast"))["id"] == "fast"
        replies[0](get_message("std_srvs/srv/Trigger_Response")(success=True))
        assert (await client.until("service_response"))["id"] == "slow"


async def test_client_offers_a_service():
    async with rosbridge_setup() as setup, setup.client() as client:
        await client.send("advertise_service", service="/ask", type="std_srvs/SetBool")
        await eventually(lambda: setup.graph.count_services("/ask") == 1)
        caller = setup.node.create_client("std_srvs/srv/SetBool", "/ask")
        future = caller.call_async(caller.srv_type.Request(data=True))
        request = await client.next()
        assert (request["op"], request["service"], request["args"]) == ("call_service", "/ask", {"data": True})
        await client.send("service_response", id=request["id"], service="/ask", values={"message": "hi"}, result=True)
        await eventually(future.done)
        assert future.result().message == "hi"
        await client.send("unadvertise_service", service="/ask")
        await eventually(lambda: setup.graph.count_services("/ask") == 0)


async def test_second_offer_of_a_service_replaces_the_first():
    async with rosbridge_setup() as setup, setup.client() as first, setup.client() as second:
        for client in (first, second):
            await client.send("advertise_service", service="/ask", type="std_srvs/Trigger")
            await client.send("unknown")
            await client.until("status")
        assert setup.graph.count_services("/ask") == 1
        caller = setup.node.create_client("std_srvs/srv/Trigger", "/ask")
        caller.call_async(caller.srv_type.Request())
        request = await second.next()
        await first.send("service_response", id=request["id"], service="/ask", result=True)
        assert "has not been advertised" in (await first.until("status"))["msg"]


# --- actions ---------------------------------------------------------------------------------------------------------


def add_fibonacci(setup, execute, **options):
    return ActionServer(setup.node, FIBONACCI, "/fibonacci", execute, **options)


async def test_client_sends_a_goal_and_receives_feedback_and_result():
    async def execute(goal):
        goal.publish_feedback(goal._server.action_type.Feedback(sequence=[0, 1]))
        goal.succeed()
        return goal._server.action_type.Result(sequence=[0, 1, 1])

    async with rosbridge_setup() as setup, setup.client() as client:
        add_fibonacci(setup, execute)
        goal = {"action": "/fibonacci", "action_type": "example_interfaces/Fibonacci", "id": "g"}
        await client.send("send_action_goal", **goal, args={"order": 3}, feedback=True)
        assert await client.next() == {
            "op": "action_feedback",
            "action": "/fibonacci",
            "id": "g",
            "values": {"sequence": [0, 1]},
        }
        assert await client.next() == {
            "op": "action_result",
            "action": "/fibonacci",
            "id": "g",
            "values": {"sequence": [0, 1, 1]},
            "status": int(GoalStatus.SUCCEEDED),
            "result": True,
        }


async def test_client_cancels_a_goal():
    running = asyncio.Event()

    async def execute(goal):
        running.set()
        await eventually(lambda: goal.is_cancel_requested)
        goal.canceled()
        return goal._server.action_type.Result()

    async with rosbridge_setup() as setup, setup.client() as client:
        add_fibonacci(setup, execute, cancel_callback=lambda _: CancelResponse.ACCEPT)
        goal = {"action": "/fibonacci", "action_type": FIBONACCI, "id": "g"}
        await client.send("send_action_goal", **goal, args=[3])
        await running.wait()
        await client.send("cancel_action_goal", action="/fibonacci", id="g")
        result = await client.until("action_result")
        assert (result["status"], result["result"]) == (int(GoalStatus.CANCELED), True)
        await client.send("cancel_action_goal", action="/fibonacci", id="g")
        assert "no goal with the id g" in (await client.until("status"))["msg"]


async def test_goal_that_cannot_be_reached_has_a_reason(monkeypatch):
    monkeypatch.setattr(actions, "_SERVER_TIMEOUT_S", 0.2)
    async with rosbridge_setup() as setup, setup.client() as client:
        add_fibonacci(setup, lambda _: None, goal_callback=lambda _: GoalResponse.REJECT)
        reasons = {"/fibonacci": "Action goal was rejected", "/none": "Action /none does not exist"}
        for action, reason in reasons.items():
            await client.send("send_action_goal", action=action, action_type=FIBONACCI)
            result = await client.until("action_result")
            assert (result["values"], result["result"], result["status"]) == (reason, False, 0)


async def test_action_is_found_although_the_match_of_its_topics_is_not_announced(monkeypatch):
    async def execute(goal):
        goal.succeed()
        return goal._server.action_type.Result()

    answers = iter([False] * 3)
    is_ready = ActionClient.server_is_ready
    monkeypatch.setattr(ActionClient, "server_is_ready", lambda client: next(answers, True) and is_ready(client))
    async with rosbridge_setup() as setup, setup.client() as client:
        add_fibonacci(setup, execute)
        await client.send("send_action_goal", action="/fibonacci", action_type=FIBONACCI)
        assert (await client.until("action_result"))["result"] is True


async def test_client_offers_an_action():
    async with rosbridge_setup() as setup, setup.client() as client:
        await client.send("advertise_action", action="/count", type="example_interfaces/Fibonacci")
        caller = ActionClient(setup.node, FIBONACCI, "/count")
        await eventually(caller.server_is_ready)
        feedback = []
        sent = caller.send_goal_async(caller._action_type.Goal(order=2), feedback_callback=feedback.append)
        goal = await client.next()
        assert (goal["op"], goal["args"], goal["feedback"]) == ("send_action_goal", {"order": 2}, True)
        await eventually(sent.done)
        reference = {"action": "/count", "id": goal["id"]}
        await client.send("action_feedback", **reference, values={"sequence": [0]})
        await eventually(lambda: feedback)
        assert list(feedback[0].feedback.sequence) == [0]
        await client.send("action_result", **reference, values={"sequence": [0, 1]}, status=4, result=True)
        result = sent.result().get_result_async()
        await eventually(result.done)
        assert (result.result().status, list(result.result().result.sequence)) == (4, [0, 1])


async def test_client_is_asked_to_cancel_a_goal_of_its_action():
    async with rosbridge_setup() as setup, setup.client() as client:
        await client.send("advertise_action", action="/count", type="example_interfaces/Fibonacci")
        caller = ActionClient(setup.node, FIBONACCI, "/count")
        await eventually(caller.server_is_ready)
        sent = caller.send_goal_async(caller._action_type.Goal(order=2))
        goal = await client.next()
        await eventually(sent.done)
        sent.result().cancel_goal_async()
        assert await client.next() == {"op": "cancel_action_goal", "id": goal["id"], "action": "/count"}
        await client.send("action_result", action="/count", id=goal["id"], values={}, status=5, result=True)
        result = sent.result().get_result_async()
        await eventually(result.done)
        assert result.result().status == int(GoalStatus.CANCELED)


async def test_goals_of_an_offered_action_are_aborted_when_the_client_goes():
    async with rosbridge_setup() as setup:
        async with setup.client() as client:
            await client.send("advertise_action", action="/count", type="example_interfaces/Fibonacci")
            caller = ActionClient(setup.node, FIBONACCI, "/count")
            await eventually(caller.server_is_ready)
            sent = caller.send_goal_async(caller._action_type.Goal(order=2))
            await client.next()
            await eventually(sent.done)
            result = sent.result().get_result_async()
            await client.send("unknown")
            await client.until("status")
        await eventually(result.done)
        assert result.result().status == int(GoalStatus.ABORTED)
