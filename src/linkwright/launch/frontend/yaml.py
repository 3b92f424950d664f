"""YAML launch files (``launch_yaml``)."""

from __future__ import annotations

from typing import Any

import yaml

from linkwright.diagnostics import Diagnostic, LinkwrightError, SourceText, foreign, joined, phrase
from linkwright.launch.errors.exceptions import as_ros_error
from linkwright.launch.errors.locations import MarkupLocation, SourceLocation, error_at
from linkwright.launch.frontend.markup_entity import MarkupEntity
from linkwright.launch.frontend.parser import Parser as AnyParser
from linkwright.launch.frontend.parser import read_file
from linkwright.launch.model.markup.entity import Entity as AnyEntity
from linkwright.launch.model.markup.entity import LocatedText, is_list_of_entities, location_of
from linkwright.launch.model.markup.values import is_instance_of

_CHILDREN_KEY = "children"

_SINGLE_VALUE_ATTRIBUTES = {"include": "file"}
"""Maps tags to the attribute for a single value, as in ``- include: other.launch.py``."""


class Entity(MarkupEntity):
    """An action in a YAML launch file: a mapping of attributes, or a list of actions.

    Args:
        element: the mapping or list.
        type_name: the tag of the entity.
        parent: the enclosing entity.
    """

    def __init__(self, element: Any, type_name: str = "", *, parent: AnyEntity | None = None) -> None:
        super().__init__(type_name, location_of(type_name) or getattr(element, "source_location", None), parent)
        self._element = element
        self._are_children_read = False

    @property
    def children(self) -> list[AnyEntity]:
        """The child entities: the items of the list, or of the mapping's ``children``.

        Raises:
            TypeError: LAUNCH118, the element is neither a list nor a mapping.
            ValueError: LAUNCH117, the mapping has no ``children``.
            RuntimeError: LAUNCH118, an item is not a mapping with one key.
        """
        self._are_children_read = True
        children = self._element
        if isinstance(children, dict):
            self._read_names[_CHILDREN_KEY] = None
            if _CHILDREN_KEY not in children:
                text = (
                    f"Expected entity `{self.type_name}` to have children entities."
                    f"That can be a list of subentities or a dictionary with a `children` list element"
                )
                message = phrase(
                    "'{type_name}' needs actions: write a list, or a key 'children' with a list",
                    type_name=self.type_name,
                )
                raise error_at(self.source_location, "LAUNCH117", message, ros_error=ValueError(text))
            children = children[_CHILDREN_KEY]
        if not isinstance(children, list):
            text = f"Expected a dict or list, got {type(children)}:\n---\n{children}\n---"
            message = phrase("'{type_name}' needs a list of actions", type_name=self.type_name)
            raise error_at(self.source_location, "LAUNCH118", message, ros_error=TypeError(text))
        return [self._create_child(item) for item in children]

    def _create_child(self, item: Any) -> AnyEntity:
        if not isinstance(item, dict) or len(item) != 1:
            text = "Subentities must be a dictionary with only one key, which is the entity type"
            message = phrase(
                "an action in '{type_name}' must be a mapping with one key, its tag", type_name=self.type_name
            )
            hint = phrase("indent its attributes further than the tag") if isinstance(item, dict) and item else None
            location = getattr(item, "source_location", None) or location_of(item) or self.source_location
            raise error_at(location, "LAUNCH118", message, hint, ros_error=RuntimeError(text))
        [(name, element)] = item.items()
        if isinstance(element, str) and name in _SINGLE_VALUE_ATTRIBUTES:
            mapping = LocatedMapping({_SINGLE_VALUE_ATTRIBUTES[name]: element})
            mapping.source_location = location_of(element)
            element = mapping
        return Entity({} if element is None else element, name, parent=self)

    def assert_entity_completely_parsed(self) -> None:
        """Raise an error if some keys have not been read.

        Raises:
            ValueError: LAUNCH116, a key was not read.
        """
        if isinstance(self._element, dict):
            self._check_all_read(self._element, "key", "Unexpected key(s) found in")
        elif isinstance(self._element, list) and not self._are_children_read:
            text = f"Unexpected nested entity(ies) found in `{self.type_name}`: {self._element}"
            message = phrase("'{type_name}' does not accept a list of actions", type_name=self.type_name)
            raise error_at(self.source_location, "LAUNCH116", message, ros_error=ValueError(text))

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """Return the value of an attribute, or the child entities with a given name.

        The value must have the type according to YAML. As in newer ROS versions, a number or boolean is also accepted
        as a string. See `linkwright.launch.model.markup.entity.Entity`.
        """
        self._read_names[name] = None
        if not isinstance(self._element, (dict, list)):
            message = phrase("'{type_name}' must be a mapping of attributes", type_name=self.type_name)
            raise error_at(self.source_location, "LAUNCH118", message, ros_error=TypeError(message))
        if name not in self._element:
            if optional:
                return None
            attributes = self._element if isinstance(self._element, dict) else {}
            self._fail_missing(name, attributes, f"Can not find attribute '{name}' in Entity '{self.type_name}'")
        value: Any = dict(self._element)[name]
        if is_list_of_entities(data_type):
            if isinstance(value, list) and value and all(isinstance(item, dict) for item in value):
                return [
                    Entity(item, LocatedText(name, getattr(item, "source_location", None)), parent=self)
                    for item in value
                ]
            text = f"Attribute '{name}' of Entity '{self.type_name}' expected to be a list of dictionaries."
            message = phrase(
                "key '{name}' of '{type_name}' must be a list of mappings", name=name, type_name=self.type_name
            )
            raise error_at(self._locate_part(name), "LAUNCH118", message, ros_error=TypeError(text))
        if data_type is str and isinstance(value, (bool, int, float)):
            return LocatedText(_format_scalar(value), self._locate_part(name))
        if not is_instance_of(value, data_type, can_be_str=can_be_str):
            text = (
                f"Attribute '{name}' of Entity '{self.type_name}' expected to be of type '{data_type}', "
                f"got '{type(value)}'"
            )
            self._fail_wrong_type(name, value, data_type, text)
        return value

    def _locate_part(self, name: str) -> SourceLocation | None:
        for key, value in self._element.items() if isinstance(self._element, dict) else ():
            if key == name:
                return (
                    (location_of(value) if name in self._read_names else None)
                    or location_of(key)
                    or self.source_location
                )
        return self.source_location


def _format_scalar(value: bool | float) -> str:
    """Format a YAML boolean or number so that a parameter parses the string as the same value."""
    return str(value).lower() if isinstance(value, bool) else str(value)


class Parser(AnyParser):
    """A parser that reads YAML launch files."""

    @classmethod
    def load(cls, file: Any) -> tuple[AnyEntity, AnyParser]:
        """Return the root entity of a path or open file, and a parser for it.

        Raises:
            LinkwrightError: LAUNCH108, the file is not valid YAML; LAUNCH109, it is not a mapping with one key.
        """
        name, text = read_file(file)
        tree = load(text, name)
        if not isinstance(tree, dict) or len(tree) != 1:
            source = SourceText(name, text)
            message = phrase("a YAML launch file must be a mapping with the single key 'launch'")
            location = getattr(tree, "source_location", None) or MarkupLocation(source, 0, 0)
            raise error_at(location, "LAUNCH109", message, ros_error=RuntimeError("Expected only one root"))
        [(root, element)] = tree.items()
        return Entity(element, root), cls()

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        """Return the file name extensions of YAML launch files, without the leading dot."""
        return {"launch.yaml", "launch.yml"}


# --- YAML with locations --------------------------------------------------------------------------------------


class LocatedMapping(dict[Any, Any]):
    """A mapping that records its location."""

    source_location: SourceLocation | None = None


class _Loader(yaml.SafeLoader):
    """A YAML loader of plain values, which records the locations of strings and mappings.

    Attributes:
        launch_text: the text of the file.
    """

    launch_text: SourceText

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self._open_anchors: list[str | None] = []

    def compose_node(self, parent: yaml.Node | None, index: Any) -> yaml.Node | None:
        """Compose a node, and reject an alias to an enclosing node.

        Such an alias would cause an endless recursion.
        """
        event: Any = self.peek_event()  # type: ignore[no-untyped-call]  # of PyYAML
        anchor = getattr(event, "anchor", None)
        if isinstance(event, yaml.AliasEvent) and anchor in self._open_anchors:
            mark: Any = event.start_mark
            raise yaml.composer.ComposerError(None, None, f"alias '{anchor}' refers to a node that contains it", mark)
        self._open_anchors.append(anchor)
        try:
            return super().compose_node(parent, index)
        finally:
            self._open_anchors.pop()

    def location_of_node(self, node: yaml.Node) -> SourceLocation:
        return MarkupLocation(self.launch_text, node.start_mark.index, node.end_mark.index)


def _construct_text(loader: _Loader, node: yaml.ScalarNode) -> LocatedText:
    start, end = node.start_mark.index, node.end_mark.index
    if node.style in ("'", '"'):
        start, end = start + 1, end - 1
    return LocatedText(loader.construct_scalar(node), MarkupLocation(loader.launch_text, start, end))


def _construct_mapping(loader: _Loader, node: yaml.MappingNode) -> Any:
    mapping = LocatedMapping()
    mapping.source_location = loader.location_of_node(node.value[0][0] if node.value else node)
    yield mapping
    mapping.update(loader.construct_mapping(node))


_Loader.add_constructor("tag:yaml.org,2002:str", _construct_text)
_Loader.add_constructor("tag:yaml.org,2002:map", _construct_mapping)


def load(text: str, name: str) -> Any:
    """Load the data of a YAML text.

    In the data, each string is a `LocatedText`, and each mapping is a `LocatedMapping`.

    Raises:
        LinkwrightError: LAUNCH108, the text is not valid YAML.
    """
    source = SourceText(name, text)
    loader = _Loader(text)
    loader.launch_text = source
    try:
        return loader.get_single_data()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        span = source.span(mark.index) if mark else None
        problem = joined(foreign(message) for message in (error.problem, error.context) if message)
        hint = phrase("indent with spaces") if mark and source.text[mark.index : mark.index + 1] == "\t" else None
        diagnostic = Diagnostic(
            "LAUNCH108",
            phrase("the launch file is not valid YAML: {problem}", problem=problem),
            span,
            hint=hint,
            source=source,
        )
        raise as_ros_error(error, diagnostic) from error
    except yaml.YAMLError as error:
        raise LinkwrightError(
            Diagnostic(
                "LAUNCH108",
                phrase("launch file '{name}' is not valid YAML: {error}", name=name, error=foreign(error)),
            )
        ) from error
    finally:
        loader.dispose()
