"""The values of one display's properties: read from its part of the .rviz file, written back there."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from linkwright.diagnostics import Diagnostic, Severity
from linkwright.viewer.protocol import Property, PropertyChanged, PropertyValue
from linkwright.viewer.schema import PropertySpec, accept, from_text, to_text
from linkwright.viewer.yaml_tree import Section

Path = tuple[str, ...]
Schema = tuple[PropertySpec, ...]


def property_id(owner: str, path: Iterable[str]) -> str:
    """The id of the property at a path of names below a display (or ``global``), as `protocol` describes it."""
    return "/".join((owner, *(name.replace("%", "%25").replace("/", "%2F") for name in path)))


class PropertyStore:
    """Values by path of names, over the file's and over the defaults.

    Args:
        owner: the display's id, or ``global``.
        section: the file, or the display's part of it; values set are written into it at once.
        schema: gives the specs as they are now; a display whose rows come and go gives others later.
        report: told of a value in the file that cannot be used; its default stands then.
        base: keys from the section to the mapping with the values; made only when a value is set.
        frames: gives the names offered for a ``frame``.
    """

    def __init__(
        self,
        owner: str,
        section: Section,
        schema: Callable[[], Schema],
        report: Callable[[Diagnostic], None],
        base: Path = (),
        frames: Callable[[], list[str]] = list,
    ) -> None:
        self._owner = owner
        self._section = section
        self._schema = schema
        self._report = report
        self._base = base
        self._frames = frames
        self._values: dict[Path, PropertyValue] = {}

    def get(self, *path: str) -> PropertyValue:
        """The value of the property at a path of names.

        Raises:
            KeyError: when the schema has no such property.
        """
        return self._value(path, self._spec(path))

    def flag(self, *path: str) -> bool:
        """The value of a ``bool``."""
        return bool(self.get(*path))

    def number(self, *path: str) -> float:
        """The value of an ``int`` or ``float``."""
        value = self.get(*path)
        assert isinstance(value, (int, float))
        return float(value)

    def text(self, *path: str) -> str:
        """The value of a ``string``, ``enum``, ``frame`` or ``color``."""
        return str(self.get(*path))

    def check(self, path: Path, value: object) -> None:
        """Raise what `set` would raise, and store nothing."""
        accept(self._spec(path), value)

    def set(self, path: Path, value: object) -> PropertyValue:
        """Store a value and return it as stored.

        Raises:
            KeyError: when the schema has no such property.
            ValueError: when the property takes no such value.
        """
        spec = self._spec(path)
        taken = accept(spec, value)
        if taken != self._value(path, spec):
            self._values[path] = taken
            string = spec.kind in ("string", "frame", "enum", "color")
            self._section.put(
                (*self._base, *path), to_text(spec, taken), string=string, nested=spec.nested or bool(spec.children)
            )
        return taken

    def find(self, identity: str) -> Path | None:
        """The path of the property with an id, or None."""
        specs = self._schema()
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
        """The id of the property at a path."""
        return property_id(self._owner, path)

    def rows(self) -> list[Property]:
        """The rows for the page."""
        return [self._row(spec, ()) for spec in self._schema() if self._shown(spec)]

    def is_condition(self, path: Path) -> bool:
        """Whether rows come or go with the value at a path."""
        return any(_depends(spec, path) for spec in self._schema())

    def frame_changes(self) -> list[PropertyChanged]:
        """The properties whose value is the name of a frame, with the frames offered now."""
        return [
            PropertyChanged(self.identity((spec.name,)), self.get(spec.name), self._frames())
            for spec in self._schema()
            if spec.kind == "frame"
        ]

    def offer_frames(self, frames: Callable[[], list[str]]) -> None:
        """Say where the names offered for a ``frame`` come from."""
        self._frames = frames

    def _row(self, spec: PropertySpec, above: Path) -> Property:
        path = (*above, spec.name)
        return Property(
            id=property_id(self._owner, path),
            name=spec.name,
            kind=spec.kind,
            value=None if spec.kind == "group" else self._value(path, spec),
            description=spec.description,
            options=self._frames() if spec.kind == "frame" else list(spec.options),
            minimum=spec.minimum,
            maximum=spec.maximum,
            expanded=spec.expanded,
            children=[self._row(child, path) for child in spec.children if self._shown(child)],
        )

    def _shown(self, spec: PropertySpec) -> bool:
        return spec.when is None or self.get(*spec.when[0]) == spec.when[1]

    def _value(self, path: Path, spec: PropertySpec) -> PropertyValue:
        try:
            return self._values[path]
        except KeyError:
            value = self._values[path] = self._from_file(path, spec)
            return value

    def _from_file(self, path: Path, spec: PropertySpec) -> PropertyValue:
        scalar = self._section.scalar(*self._base, *path)
        if scalar is None or spec.kind == "group":
            return spec.default
        try:
            return from_text(spec, scalar.text)
        except ValueError as error:
            message = f"'{spec.name}': {error}; {spec.default!r} is used"
            self._report(Diagnostic("RVIZ201", message, scalar.span, Severity.WARNING, source=self._section.source))
            return spec.default

    def _spec(self, path: Path) -> PropertySpec:
        specs = self._schema()
        found: PropertySpec | None = None
        for name in path:
            found = next((spec for spec in specs if spec.name == name), None)
            if found is None:
                raise KeyError(f"no property {' > '.join(path)} in {self._owner}")
            specs = found.children
        if found is None:
            raise KeyError(f"no property named in {self._owner}")
        return found


def _depends(spec: PropertySpec, path: Path) -> bool:
    condition = spec.when is not None and spec.when[0] == path
    return condition or any(_depends(child, path) for child in spec.children)
