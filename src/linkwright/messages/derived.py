"""The structures and services that rosidl makes of a service or an action beside those the file names."""

from __future__ import annotations

from linkwright.messages.definition import Action, Container, Definition, Field, FieldType, Service, Structure

_GOAL_ID = Field("goal_id", FieldType("unique_identifier_msgs/msg/UUID"))


def event_of(service: Service) -> Structure:
    """What a service's introspection topic carries (REP 2012)."""
    return Structure(
        service.type_name + "_Event",
        (
            Field("info", FieldType("service_msgs/msg/ServiceEventInfo")),
            Field("request", FieldType(service.request.type_name, container=Container.SEQUENCE, size=1)),
            Field("response", FieldType(service.response.type_name, container=Container.SEQUENCE, size=1)),
        ),
    )


def send_goal_of(action: Action) -> Service:
    """The service that asks an action server to take a goal."""
    name = action.type_name + "_SendGoal"
    return Service(
        name,
        Structure(name + "_Request", (_GOAL_ID, Field("goal", FieldType(action.goal.type_name)))),
        Structure(
            name + "_Response",
            (Field("accepted", FieldType("bool")), Field("stamp", FieldType("builtin_interfaces/msg/Time"))),
        ),
    )


def get_result_of(action: Action) -> Service:
    """The service that answers with a goal's status and result once it has come to its end."""
    name = action.type_name + "_GetResult"
    return Service(
        name,
        Structure(name + "_Request", (_GOAL_ID,)),
        Structure(
            name + "_Response",
            (Field("status", FieldType("int8")), Field("result", FieldType(action.result.type_name))),
        ),
    )


def feedback_message_of(action: Action) -> Structure:
    """What the feedback topic carries: the feedback, and which goal it is of."""
    return Structure(
        action.type_name + "_FeedbackMessage", (_GOAL_ID, Field("feedback", FieldType(action.feedback.type_name)))
    )


def parts_of(definition: Definition) -> dict[str, Definition]:
    """Everything rosidl makes of an interface file: type name -> definition, itself included."""
    parts: dict[str, Definition] = {definition.type_name: definition}
    if isinstance(definition, Service):
        for structure in (definition.request, definition.response, event_of(definition)):
            parts[structure.type_name] = structure
    elif isinstance(definition, Action):
        for structure in (definition.goal, definition.result, definition.feedback, feedback_message_of(definition)):
            parts[structure.type_name] = structure
        for service in (send_goal_of(definition), get_result_of(definition)):
            parts |= parts_of(service)
    return parts
