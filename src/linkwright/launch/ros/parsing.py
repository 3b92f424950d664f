"""Parser for the tags of nodes in XML and YAML launch files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import LinkwrightError, Phrase, phrase
from linkwright.launch.errors.locations import error_at, reading_markup_at
from linkwright.launch.model.markup.entity import Entity, parse_attributes
from linkwright.launch.ros.parameter_files import ParameterFile
from linkwright.launch.ros.parameter_values import ParameterValue

if TYPE_CHECKING:
    from linkwright.launch.model.markup.entity import Parser

Entities = list[Entity]


def parse_node(entity: Entity, parser: Parser, kwargs: dict[str, Any], cls: Any) -> dict[str, Any]:
    """Add a node's keyword arguments to the keyword arguments of its process, and return all.

    Args:
        entity: the tag.
        parser: parses the substitutions in the tag.
        kwargs: the keyword arguments of the process; changed by this function.
        cls: the class of the action; its methods parse command lines and parameters.
    """
    for attribute, keyword in (("args", "arguments"), ("ros_args", "ros_arguments")):
        command_line = entity.get_attr(attribute, optional=True)
        if command_line is not None:
            kwargs[keyword] = cls._parse_cmdline(command_line, parser)
    kwargs.pop("name", None)  # the base class has read the process's name from the same attribute
    kwargs.update(
        parse_attributes(entity, parser, name="name", exec_name="exec_name", package="pkg", namespace="namespace")
    )
    kwargs["executable"] = parser.parse_substitution(entity.get_attr("exec"))
    kwargs.update(parse_remappings(entity, parser))
    parameters = entity.get_attr("param", data_type=Entities, optional=True)
    if parameters is not None:
        kwargs["parameters"] = cls.parse_nested_parameters(parameters, parser)
    return kwargs


def parse_remappings(entity: Entity, parser: Parser) -> dict[str, Any]:
    """Return the keyword argument ``remappings`` for the ``remap`` tags inside a tag.

    The result is empty if there are no such tags.
    """
    tags = entity.get_attr("remap", data_type=Entities, optional=True)
    if tags is None:
        return {}
    rules = []
    for tag in tags:
        source, target = tag.get_attr("from"), tag.get_attr("to")
        rules.append((parser.parse_substitution(source), parser.parse_substitution(target)))
        tag.assert_entity_completely_parsed()
    return {"remappings": rules}


def parse_parameters(tags: list[Entity], parser: Parser) -> list[Any]:
    """Return the parameters in ``param`` tags as values for a node's ``parameters``.

    Raises:
        RuntimeError: LAUNCH118, a tag has conflicting or missing attributes.
    """
    parameters: list[Any] = []
    for tag in tags:
        path = tag.get_attr("from", optional=True)
        allow_substs = tag.get_attr("allow_substs", data_type=bool, optional=True)
        name = tag.get_attr("name", optional=True)
        if path is not None and name is not None:
            raise _tag_error(tag, phrase("the attributes 'name' and 'from' cannot be used together"))
        if path is not None:
            allow_substs = (
                parser.parse_substitution(allow_substs) if isinstance(allow_substs, str) else bool(allow_substs)
            )
            tag.assert_entity_completely_parsed()
            parameters.append(ParameterFile(parser.parse_substitution(path), allow_substs=allow_substs))
        elif name is not None:
            if allow_substs is not None:
                raise _tag_error(tag, phrase("the attribute 'allow_substs' needs the attribute 'from'"))
            parameters.append(_parse_nested([tag], parser))
        else:
            raise _tag_error(tag, phrase("the attribute 'name' or 'from' is missing"), ValueError)
    return parameters


def _parse_nested(tags: list[Entity], parser: Parser) -> dict[Any, Any]:
    from linkwright.launch.model.markup.values import get_data_type_from_identifier

    values: dict[Any, Any] = {}
    for tag in tags:
        name = tuple(parser.parse_substitution(tag.get_attr("name")))
        identifier = tag.get_attr("type", data_type=None, optional=True)
        data_type = None if identifier is None else get_data_type_from_identifier(identifier)
        value = tag.get_attr("value", data_type=data_type, optional=True)
        children = tag.get_attr("param", data_type=Entities, optional=True)
        tag.assert_entity_completely_parsed()
        if value is not None and children:
            raise _tag_error(tag, phrase("nested parameters and the attribute 'value' cannot be used together"))
        if data_type is not None and children:
            raise _tag_error(tag, phrase("nested parameters and the attribute 'type' cannot be used together"))
        if value is not None:
            try:
                with reading_markup_at(tag.source_location):
                    values[name] = ParameterValue(parser.parse_if_substitutions(value), value_type=data_type)
            except (TypeError, ValueError) as error:
                raise _type_error(tag, value, identifier, error) from error
        elif children:
            values[name] = _parse_nested(children, parser)
        else:
            raise _tag_error(tag, phrase("the attribute 'value' or nested parameters are missing"))
    return values


def _type_error(tag: Entity, value: Any, identifier: str | None, error: Exception) -> Exception:
    """Return the error for a ``param`` tag whose value does not have the declared type.

    A LinkwrightError with another code than LAUNCH132 is returned unchanged.
    """
    if isinstance(error, LinkwrightError) and error.diagnostics[0].code != "LAUNCH132":
        return error
    name, value = tag.get_attr("name"), repr(value)
    message = (
        phrase("parameter '{name}' is {value}, whose items have different types", name=name, value=value)
        if identifier is None
        else phrase(
            "parameter '{name}' is {value}, which is not of type '{type}'", name=name, value=value, type=identifier
        )
    )
    return error_at(tag.source_location, "LAUNCH132", message, ros_error=error)


def _tag_error(tag: Entity, text: Phrase, kind: type[Exception] = RuntimeError) -> Exception:
    return error_at(
        tag.source_location,
        "LAUNCH118",
        phrase("'{type_name}': {text}", type_name=tag.type_name, text=text),
        ros_error=kind(str(text)),
    )
