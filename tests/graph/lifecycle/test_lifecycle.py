"""Managed nodes: transitions, callbacks, errors and lifecycle publishers."""

from __future__ import annotations

import pytest

from linkwright.graph.faults import RclError
from linkwright.graph.lifecycle.entities import ManagedEntity, SimpleManagedEntity
from linkwright.graph.lifecycle.managed_node import LifecycleNodeMixin, LifecycleTransitionError
from linkwright.graph.lifecycle.states import TransitionCallbackReturn
from linkwright.graph.node import Node
from linkwright.messages import String, get_message, get_service

SUCCESS, FAILURE, ERROR = TransitionCallbackReturn


class ManagedNode(LifecycleNodeMixin):
    """A managed node around a node of the graph; the test sets the results of its callbacks."""

    def __init__(self, node: Node, answers: dict[str, object]) -> None:
        self.node = node
        self.answers = answers
        self.calls: list[tuple[str, str]] = []
        LifecycleNodeMixin.__init__(self)

    def __getattr__(self, name):
        return getattr(self.node, name)

    def _answer(self, name, state, default):
        self.calls.append((name, state.label))
        answer = self.answers.get(name)
        if isinstance(answer, Exception):
            raise answer
        return default(state) if answer is None else answer

    def on_configure(self, state):
        return self._answer("configure", state, super().on_configure)

    def on_activate(self, state):
        return self._answer("activate", state, super().on_activate)

    def on_deactivate(self, state):
        return self._answer("deactivate", state, super().on_deactivate)

    def on_cleanup(self, state):
        return self._answer("cleanup", state, super().on_cleanup)

    def on_shutdown(self, state):
        return self._answer("shutdown", state, super().on_shutdown)

    def on_error(self, state):
        return self._answer("error", state, super().on_error)


@pytest.fixture
def managed(graph):
    return ManagedNode(graph.create_node("managed"), {})


async def test_lifecycle_node_goes_through_all_states(managed):
    assert managed.lifecycle_state.label == "unconfigured"
    states = []
    for trigger in ("configure", "activate", "deactivate", "cleanup", "configure", "activate", "shutdown"):
        assert getattr(managed, f"trigger_{trigger}")() is SUCCESS
        states.append(managed.lifecycle_state)
    assert [state.label for state in states] == [
        *("inactive", "active", "inactive", "unconfigured", "inactive", "active", "finalized"),
    ]
    assert [state.state_id for state in states] == [2, 3, 2, 1, 2, 3, 4]
    assert managed.calls[:3] == [("configure", "unconfigured"), ("activate", "inactive"), ("deactivate", "active")]
    with pytest.raises(LifecycleTransitionError, match="No transition matching shutdown found"):
        managed.trigger_shutdown()


async def test_invalid_transition_is_rejected_with_hint(managed):
    with pytest.raises(RclError, match="No transition matching activate found for current state") as raised:
        managed.trigger_activate()
    assert "Transition is not registered" in str(raised.value)
    assert raised.value.diagnostics[0].hint == "the transitions from this state are configure, shutdown"
    assert isinstance(raised.value, RuntimeError)


@pytest.mark.parametrize(
    ("answers", "verdict", "state"),
    [
        ({"configure": FAILURE}, FAILURE, "unconfigured"),
        ({"configure": ERROR}, ERROR, "unconfigured"),
        ({"configure": ERROR, "error": FAILURE}, ERROR, "finalized"),
        ({"configure": ERROR, "error": ERROR}, ERROR, "finalized"),
        ({"configure": KeyError("x"), "error": ValueError("y")}, ERROR, "finalized"),
        ({"configure": True}, ERROR, "unconfigured"),
    ],
)
async def test_callback_failures_and_errors_set_state(managed, log, answers, verdict, state):
    managed.answers = answers
    assert managed.trigger_configure() is verdict
    assert managed.lifecycle_state.label == state
    errors = [record.text for record in log]
    assert len(errors) == sum(not isinstance(answer, TransitionCallbackReturn) for answer in answers.values())
    if answers["configure"] is True:
        assert errors == [
            "on_configure returned True; it must return TransitionCallbackReturn.SUCCESS, FAILURE or ERROR"
        ]


@pytest.mark.parametrize(("answer", "state"), [(FAILURE, "finalized"), (ERROR, "unconfigured")])
async def test_failed_shutdown_sets_state(managed, answer, state):
    managed.answers = {"shutdown": answer}
    assert managed.trigger_shutdown() is answer
    assert managed.lifecycle_state.label == state


async def test_lifecycle_publisher_is_silent_unless_active(graph, managed):
    messages = []
    graph.create_node("listener").create_subscription(
        String, "/words", lambda message: messages.append(message.data), 10
    )
    publisher = managed.create_lifecycle_publisher(String, "/words", 10)

    async def say(text):
        publisher.publish(String(data=text))
        await graph.settle()

    await say("too early")
    managed.trigger_configure()
    await say("still too early")
    assert not publisher.is_activated
    managed.trigger_activate()
    assert publisher.is_activated
    await say("now")
    managed.trigger_deactivate()
    await say("too late")
    assert messages == ["now"]
    managed.destroy_lifecycle_publisher(publisher)
    with pytest.raises(TypeError, match="unexpected keyword argument 'publisher_class'"):
        managed.create_lifecycle_publisher(String, "/words", 10, publisher_class=object)


async def test_managed_entities_are_notified_until_one_fails(managed):
    class Stubborn(ManagedEntity):
        def on_configure(self, state):
            return FAILURE

    labels = []

    class Counting(SimpleManagedEntity):
        def on_configure(self, state):
            labels.append(state.label)
            return SUCCESS

        @SimpleManagedEntity.when_enabled
        def work(self):
            return "worked"

        @SimpleManagedEntity.when_enabled(when_not_enabled=lambda: "rested")
        def rest(self):
            return "worked"

    counting = Counting()
    managed.add_managed_entity(counting)
    managed.add_managed_entity(counting)
    assert managed.trigger_configure() is SUCCESS
    assert (counting.work(), counting.rest()) == (None, "rested")
    managed.trigger_activate()
    assert (counting.work(), counting.rest()) == ("worked", "worked")
    managed.trigger_deactivate()
    managed.trigger_cleanup()
    managed.add_managed_entity(Stubborn())
    assert managed.trigger_configure() is FAILURE
    assert labels == ["unconfigured", "unconfigured"]


async def test_lifecycle_services_change_state(graph, managed, log):
    asking = graph.create_node("asking")
    events = []
    asking.create_subscription(
        get_message("lifecycle_msgs/msg/TransitionEvent"), "/managed/transition_event", events.append, 10
    )

    async def ask(service, kind, **fields):
        client = asking.create_client(get_service(f"lifecycle_msgs/srv/{kind}"), f"/managed/{service}")
        request = client.srv_type.Request()
        for name, value in fields.items():
            setattr(request.transition, name, value)
        future = client.call_async(request)
        await graph.settle()
        return future.result()

    assert (await ask("get_state", "GetState")).current_state.label == "unconfigured"
    assert (await ask("change_state", "ChangeState", id=1)).success
    assert (await ask("get_state", "GetState")).current_state.id == 2
    assert (await ask("change_state", "ChangeState", label="activate")).success
    assert not (await ask("change_state", "ChangeState", label="activate")).success
    assert not (await ask("change_state", "ChangeState", id=77)).success
    assert [record.text for record in log] == [
        "Transition is not registered: No transition matching activate found for current state active",
        "Transition is not registered: No transition matching 77 found for current state active",
    ]
    states = (await ask("get_available_states", "GetAvailableStates")).available_states
    assert [(state.id, state.label) for state in states] == [
        *((0, "unknown"), (1, "unconfigured"), (2, "inactive"), (3, "active"), (4, "finalized")),
        *((10, "configuring"), (11, "cleaningup"), (12, "shuttingdown"), (13, "activating"), (14, "deactivating")),
        (15, "errorprocessing"),
    ]
    available = (await ask("get_available_transitions", "GetAvailableTransitions")).available_transitions
    assert [
        (description.transition.id, description.transition.label, description.goal_state.label)
        for description in available
    ] == [
        (4, "deactivate", "deactivating"),
        (7, "shutdown", "shuttingdown"),
    ]
    transitions = (await ask("get_transition_graph", "GetAvailableTransitions")).available_transitions
    assert [description.transition.id for description in transitions] == [
        *(1, 10, 11, 12, 2, 20, 21, 22, 3, 30, 31, 32, 4, 40, 41, 42, 5, 6, 7, 50, 51, 52, 60, 61, 62),
    ]
    assert [(event.start_state.label, event.goal_state.label) for event in events] == [
        ("unconfigured", "configuring"),
        ("configuring", "inactive"),
        ("inactive", "activating"),
        ("activating", "active"),
    ]


async def test_transition_ids_match_lifecycle_msgs(managed):
    message = get_message("lifecycle_msgs/msg/Transition")
    assert [message.TRANSITION_CALLBACK_SUCCESS, message.TRANSITION_CALLBACK_FAILURE] == [SUCCESS, FAILURE]
    assert message.TRANSITION_ON_ACTIVATE_ERROR == 32
    assert message.TRANSITION_ACTIVE_SHUTDOWN == 7
    assert [answer.to_label() for answer in TransitionCallbackReturn] == [
        *("transition_success", "transition_failure", "transition_error"),
    ]


async def test_lifecycle_services_can_be_disabled(graph):
    node = graph.create_node("quiet")

    class Quiet(ManagedNode):
        def __init__(self):
            self.node, self.answers, self.calls = node, {}, []
            LifecycleNodeMixin.__init__(self, enable_communication_interface=False)

    before = len(node.get_service_names_and_types_by_node("quiet", "/"))
    assert Quiet().trigger_configure() is SUCCESS
    assert len(node.get_service_names_and_types_by_node("quiet", "/")) == before
