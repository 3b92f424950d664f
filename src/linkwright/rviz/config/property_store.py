"""The property values of a display, stored in its section of the .rviz file."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.graph import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from linkwright.page.protocol.configuration import Property, PropertyChanged, PropertyValue, TopicOffer
from linkwright.rviz.config.former_names import FormerKey
from linkwright.rviz.config.schema import (
    Path,
    PropertySpec,
    Schema,
    accept_value,
    fallback_value,
    value_from_text,
    value_to_text,
)
from linkwright.rviz.config.yaml_tree import NewSection, SavedEntry, Scalar, Section, make_section, remove_unchanged

_MIN_INDEXED_PROPERTIES = 30
"""The minimum number of sibling properties for which a lookup by name uses an index."""


def property_id(owner: str, path: Iterable[str]) -> str:
    """Return the ID of the property at a path, as the page protocol uses it.

    The path starts below a display or ``global``.
    """
    return "/".join((owner, *(name.replace("%", "%25").replace("/", "%2F") for name in path)))


class PropertyStore:
    """Property values by path: the value that was set, the value in the file, or the default.

    Args:
        owner: the display's ID, or ``global``.
        section: the file, or the display's section of it; values that are set are written to it immediately.
        schema: returns the current specs; they change when rows of the display appear or disappear.
        report: called with a finding about a value in the file that cannot be used; the default is used instead.
        base: the keys from the section to the mapping with the values, which is created only when a value is set.
        frames: returns the frame names that properties of kind ``frame`` offer.
        former: the RViz 1 keys, for a section that RViz 1 wrote.
    """

    def __init__(
        self,
        owner: str,
        section: Section,
        schema: Callable[[], Schema],
        report: Callable[[Diagnostic], None],
        base: Path = (),
        frames: Callable[[], list[str]] = list,
        former: Mapping[Path, FormerKey] | None = None,
    ) -> None:
        self._owner = owner
        self._section = section
        self._get_schema = schema
        self._index: tuple[Schema, dict[str, PropertySpec]] = ((), {})
        self._report = report
        self._base = base
        self._get_frames = frames
        self._former_keys = former or {}
        self._recorded_entries: list[SavedEntry] | None = None
        self._new_sections: list[NewSection] = []
        self._values: dict[Path, PropertyValue] = {}

    def get(self, *path: str) -> PropertyValue:
        """Return the value of the property at a path of names.

        Raises:
            KeyError: when the schema has no such property.
        """
        return self._get_value(path, self._get_spec(path))

    def flag(self, *path: str) -> bool:
        """Return the value of a ``bool`` property."""
        return bool(self.get(*path))

    def number(self, *path: str) -> float:
        """Return the value of an ``int`` or ``float`` property."""
        value = self.get(*path)
        assert isinstance(value, (int, float))
        return float(value)

    def text(self, *path: str) -> str:
        """Return the value of a ``string``, ``enum``, ``frame``, ``color`` or ``topic`` property."""
        return str(self.get(*path))

    def check(self, path: Path, value: object) -> None:
        """Validate a value as `set` does, without storing it."""
        accept_value(self._get_spec(path), value)

    def set(self, path: Path, value: object) -> PropertyValue:
        """Store a value, and return the stored value, which may have been converted or clamped.

        Raises:
            KeyError: when the schema has no such property.
            ValueError: when the property does not accept the value.
        """
        spec = self._get_spec(path)
        accepted_value = accept_value(spec, value)
        if accepted_value != self._get_value(path, spec):
            self._values[path] = accepted_value
            self._write(path, spec, value_to_text(spec, accepted_value))
        return accepted_value

    def set_read_only(self, path: Path, value: PropertyValue) -> bool:
        """Set a value without storing it in the file, such as the value of a read-only property.

        Return whether the value changed.

        Raises:
            KeyError: when the schema has no such property.
        """
        spec = self._get_spec(path)
        if self._get_value(path, spec) == value:
            return False
        self._values[path] = value
        return True

    @contextmanager
    def recording(self) -> Iterator[list[SavedEntry]]:
        """Collect the previous entries of the keys that are set inside the block, for `restore`."""
        saved_entries: list[SavedEntry] = []
        self._recorded_entries = saved_entries
        try:
            yield saved_entries
        finally:
            self._recorded_entries = None

    def current_entries(self, saved_entries: Iterable[SavedEntry]) -> list[SavedEntry]:
        """Return the current entries of the keys that the given entries have, for `restore`."""
        return [self._find_values_section().copy_entry(saved_entry.key) for saved_entry in saved_entries]

    def restore(self, saved_entries: Iterable[SavedEntry]) -> list[Path]:
        """Restore previous entries of the file, and return the paths of changed properties."""
        keys = {saved_entry.key for saved_entry in saved_entries}
        section = self._find_values_section()
        for saved_entry in saved_entries:
            section.restore(saved_entry)
        self._new_sections = remove_unchanged(self._new_sections)
        previous_values = {
            path: value
            for path, value in self._values.items()
            if self._find_key(path) in keys and self._is_stored(path)
        }
        for path in previous_values:
            del self._values[path]
        return [path for path, value in previous_values.items() if self.get(*path) != value]

    def find(self, identity: str) -> Path | None:
        """Return the path of the property with an ID, or None if there is no such property."""
        specs = self._get_schema()
        owner, *names = identity.split("/")
        path = tuple(name.replace("%2F", "/").replace("%25", "%") for name in names)
        if owner != self._owner or not path:
            return None
        for name in path:
            spec = next((spec for spec in specs if spec.name == name), None)
            if spec is None:
                return None
            specs = spec.children
        return path

    def identity(self, path: Path) -> str:
        """Return the ID of the property at a path."""
        return property_id(self._owner, path)

    def rows(self) -> list[Property]:
        """Return the rows that the page shows.

        Properties that are hidden, or whose condition is not met, have no row.
        """
        return [self._make_row(spec, ()) for spec in self._get_schema() if self._is_shown(spec)]

    def is_condition(self, path: Path) -> bool:
        """Return whether other rows are shown or hidden depending on the value at a path."""
        return any(_depends_on(spec, path) for spec in self._get_schema())

    def frame_changes(self) -> list[PropertyChanged]:
        """Return a `PropertyChanged` with the current frame names for each ``frame`` property."""
        return [
            PropertyChanged(self.identity((spec.name,)), self.get(spec.name), self._get_frames())
            for spec in self._get_schema()
            if spec.kind == "frame"
        ]

    def offer_frames(self, frames: Callable[[], list[str]]) -> None:
        """Set the function that returns the frame names offered for properties of kind ``frame``."""
        self._get_frames = frames

    def _make_row(self, spec: PropertySpec, parent_path: Path) -> Property:
        path = (*parent_path, spec.name)
        return Property(
            id=property_id(self._owner, path),
            name=spec.name,
            kind=spec.kind,
            value=None if spec.kind == "group" else self._get_value(path, spec),
            description=spec.description,
            options=self._get_frames() if spec.kind == "frame" else list(spec.options),
            minimum=spec.minimum,
            maximum=spec.maximum,
            read_only=spec.read_only,
            expanded=spec.expanded,
            children=[self._make_row(child, path) for child in spec.children if self._is_shown(child)],
            details=spec.details,
            topics=TopicOffer(list(spec.messages), list(spec.name_words)) if spec.messages else None,
        )

    def _is_shown(self, spec: PropertySpec) -> bool:
        return not spec.hidden and self._condition_holds(spec)

    def _condition_holds(self, spec: PropertySpec) -> bool:
        if spec.when is None:
            return True
        path, value = spec.when
        return self.get(*path) == value and self._condition_holds(self._get_spec(path))

    def _get_value(self, path: Path, spec: PropertySpec) -> PropertyValue:
        try:
            return self._values[path]
        except KeyError:
            value = self._values[path] = self._read_value(path, spec)
            return value

    def _read_value(self, path: Path, spec: PropertySpec) -> PropertyValue:
        scalar = None if spec.read_only else self._find_scalar(path)
        if scalar is None or spec.kind == "group":
            return spec.default
        if spec.kind in ("enum", "frame") and not scalar.text:
            return spec.default  # RViz writes an empty value if there were no options
        try:
            return value_from_text(spec, scalar.text)
        except ValueError as error:
            value = fallback_value(spec)
            message = phrase(
                "'{name}': {error}; {value} is used instead", name=spec.name, error=error, value=repr(value)
            )
            self._report(Diagnostic("RVIZ201", message, scalar.span, Severity.WARNING, source=self._section.source))
            return value

    def _find_scalar(self, path: Path) -> Scalar | None:
        scalar = self._section.scalar(*self._base, *path)
        former_key = self._former_keys.get(path)
        if scalar is None and former_key is not None:
            scalar = self._section.scalar(*self._base, former_key.key)
            return scalar and Scalar(former_key.read(scalar.text), scalar.span)
        return scalar

    def _write(self, path: Path, spec: PropertySpec, text: str) -> None:
        former_key = self._find_former_key(path)
        is_string = spec.kind in ("string", "frame", "enum", "color", "topic")
        is_nested = spec.nested or bool(spec.children)
        if former_key is not None:
            path, text, is_nested = (former_key.key,), former_key.write(text), False
            is_string = is_string and text not in (
                "true",
                "false",
            )  # `Unreliable` is a boolean in RViz 1, a policy in RViz 2
        if self._recorded_entries is not None and path[0] not in (
            saved_entry.key for saved_entry in self._recorded_entries
        ):
            self._recorded_entries.append(self._find_values_section().copy_entry(path[0]))
        self._find_values_section().put(path, text, string=is_string, nested=is_nested)

    def _find_former_key(self, path: Path) -> FormerKey | None:
        """Return the RViz 1 key of a property, or None.

        None means that the property has no such key, or that the file contains the current key.
        """
        return self._former_keys.get(path) if self._section.scalar(*self._base, *path) is None else None

    def _find_values_section(self) -> Section:
        """Return the mapping that contains the values, creating it if it is missing."""
        section, new_sections = make_section(self._section, *self._base)
        self._new_sections += new_sections
        return section

    def _find_key(self, path: Path) -> str:
        former_key = self._find_former_key(path)
        return former_key.key if former_key else path[0]

    def _is_stored(self, path: Path) -> bool:
        """Return whether the schema has the property and the property is not read-only."""
        try:
            return not self._get_spec(path).read_only
        except KeyError:
            return False

    def _find_spec(self, specs: Schema, name: str) -> PropertySpec | None:
        """Return the first property with a name, or None.

        Long lists are searched with an index.
        """
        if len(specs) < _MIN_INDEXED_PROPERTIES:
            return next((spec for spec in specs if spec.name == name), None)
        if self._index[0] is not specs:
            self._index = specs, {spec.name: spec for spec in reversed(specs)}
        return self._index[1].get(name)

    def _get_spec(self, path: Path) -> PropertySpec:
        specs = self._get_schema()
        spec: PropertySpec | None = None
        for name in path:
            spec = self._find_spec(specs, name)
            if spec is None:
                raise KeyError(f"no property {' > '.join(path)} in {self._owner}")
            specs = spec.children
        if spec is None:
            raise KeyError(f"no property named in {self._owner}")
        return spec


def _depends_on(spec: PropertySpec, path: Path) -> bool:
    is_condition = spec.when is not None and spec.when[0] == path
    return is_condition or any(_depends_on(child, path) for child in spec.children)


def qos_from_properties(
    properties: PropertyStore, name: str = "Topic", *, transient_local: bool | None = None
) -> QoSProfile:
    """Return the QoS profile that a topic property and its child properties describe.

    Args:
        properties: the display's properties.
        name: the name of the topic property.
        transient_local: whether the durability is transient local, with which earlier messages are also received;
            None to use the durability of the property.
    """
    get = properties.text
    keep_all = get(name, "History Policy") == "Keep All"
    best_effort = get(name, "Reliability Policy") == "Best Effort"
    if transient_local is None:
        transient_local = get(name, "Durability Policy") == "Transient Local"
    return QoSProfile(
        depth=int(properties.number(name, "Depth")),
        history=HistoryPolicy.KEEP_ALL if keep_all else HistoryPolicy.KEEP_LAST,
        reliability=ReliabilityPolicy.BEST_EFFORT if best_effort else ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if transient_local else DurabilityPolicy.VOLATILE,
    )
