"""The views of a .rviz file: the current one and the saved ones."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.viewer.config.former_names import modern_class
from linkwright.viewer.config.property_store import Path, PropertyStore, Schema
from linkwright.viewer.config.schema import MAXIMUM_TEXT
from linkwright.viewer.config.view_classes import CURRENT_NAME, ORBIT, STAND_INS, VIEW_SCHEMAS, value_paths
from linkwright.viewer.config.yaml_tree import (
    Memory,
    Section,
    ensure_section,
    insert_section,
    new_section,
    remove_section,
)
from linkwright.viewer.protocol.views import View

_MANAGER = "Visualization Manager"
_VIEWS = "Views"
_SAVED = "Saved"

MAXIMUM_SAVED = 1000
"""Most saved views; a page may add no more."""

Report = Callable[[Diagnostic], None]


class ViewEntry:
    """One view of the file. What this program does not know of it is kept.

    A view of another class than those in `VIEW_SCHEMAS` is shown as an Orbit, or as what stands in for it, and stays as
    it is in the file until a value is set.

    Args:
        section: the file, or the view's part of it.
        base: keys from the section to the view.
        report: told of another class (RVIZ203) and of values that cannot be used (RVIZ201).
    """

    def __init__(self, section: Section, base: Path, report: Report) -> None:
        self._section = section
        self._base = base
        self._report = report
        self._cls = self._known_class()
        self._store = self._make_store(self._cls)
        self._view = self._read()

    @property
    def view(self) -> View:
        """The view as it is now; a copy."""
        return View(self._view.cls, self._view.name, dict(self._view.values))

    def set(self, view: View) -> None:
        """Write a view; values that are equal stay as they are spelt.

        Raises:
            ValueError: it is of an unknown class, or a value is none that its class has.
        """
        if view == self._view:
            return
        if len(view.name) > MAXIMUM_TEXT:
            raise ValueError(f"the name of a view has at most {MAXIMUM_TEXT} characters")
        if view.cls not in VIEW_SCHEMAS:
            raise ValueError(f"no view is of the class {view.cls!r}")
        paths = value_paths(VIEW_SCHEMAS[view.cls])
        store = self._store if view.cls == self._cls else self._make_store(view.cls)
        for name, value in view.values.items():
            if name not in paths:
                raise ValueError(f"a view of the class {view.cls!r} has no value {name!r}")
            store.check(paths[name], value)
        self._write_class(view.cls)
        if self._name() != view.name:
            self._section.put((*self._base, "Name"), view.name, string=True)
        for name, value in view.values.items():
            store.set(paths[name], value)
        self._store, self._cls = store, view.cls
        self._view = self._read()

    def _write_class(self, cls: str) -> None:
        """Another class: keys that only the one before has go."""
        scalar = self._section.scalar(*self._base, "Class")
        written = modern_class(scalar.text) if scalar else ""
        if cls in (written, STAND_INS.get(written)):
            return
        section = ensure_section(self._section, *self._base)
        known = {spec.name for spec in VIEW_SCHEMAS[cls]}
        for spec in VIEW_SCHEMAS[self._cls]:
            if spec.name not in known:
                section.recall(Memory(spec.name, None))
        section.put(("Class",), cls, string=True)
        section.put(("Name",), self._name(), string=True)
        package, _, name = cls.partition("/")
        section.put(("Value",), f"{name} ({package})", string=True)

    def _read(self) -> View:
        paths = value_paths(VIEW_SCHEMAS[self._cls])
        return View(self._cls, self._name(), {name: self._store.get(*path) for name, path in paths.items()})

    def _name(self) -> str:
        scalar = self._section.scalar(*self._base, "Name")
        return scalar.text if scalar else CURRENT_NAME

    def _make_store(self, cls: str) -> PropertyStore:
        schema: Schema = VIEW_SCHEMAS[cls]
        return PropertyStore("view", self._section, lambda: schema, self._report, base=self._base)

    def _known_class(self) -> str:
        scalar = self._section.scalar(*self._base, "Class")
        if scalar is None:
            return ORBIT
        cls = modern_class(scalar.text)
        if cls in VIEW_SCHEMAS:
            return cls
        shown = STAND_INS.get(cls, ORBIT)
        message = phrase(
            "the view '{text}' is shown as an {rpartition} view", text=scalar.text, rpartition=shown.rpartition("/")[2]
        )
        self._report(Diagnostic("RVIZ203", message, scalar.span, Severity.WARNING, source=self._section.source))
        return shown


class ViewsConfig:
    """``Views`` of a file.

    Args:
        document: the file.
        report: called with what cannot be used.
    """

    def __init__(self, document: Section, report: Report) -> None:
        self._document = document
        self._current = ViewEntry(document, (_MANAGER, _VIEWS, "Current"), report)
        self._saved: dict[str, tuple[Section, ViewEntry]] = {}
        self._count = 0
        for section in document.sections(_MANAGER, _VIEWS, _SAVED):
            if section.scalar("Class") is not None:  # RViz passes over what has none
                self._remember(section, ViewEntry(section, (), report))

    @property
    def current(self) -> View:
        """The current view."""
        return self._current.view

    @current.setter
    def current(self, view: View) -> None:
        """Raises ValueError for a view that is not valid."""
        self._current.set(view)

    @property
    def saved(self) -> dict[str, View]:
        """The saved views by ids that are stable while the file is open, in the order of the file."""
        return {identity: entry.view for identity, (_, entry) in self._saved.items()}

    def save(self, view: View) -> str:
        """Add a view to the saved ones, and return its id.

        Raises:
            ValueError: the view is not valid, or there are too many.
        """
        if len(self._saved) >= MAXIMUM_SAVED:
            raise ValueError(f"there are {MAXIMUM_SAVED} saved views already")
        section = new_section(self._document.source)
        entry = ViewEntry(section, (), _unheard)
        entry.set(view)
        insert_section(ensure_section(self._document, _MANAGER, _VIEWS), _SAVED, section)
        return self._remember(section, entry)

    def change(self, identity: str, view: View) -> None:
        """Give a saved view another name or other values.

        Raises:
            KeyError: there is no such saved view.
            ValueError: the view is not valid.
        """
        self._saved[identity][1].set(view)

    def remove(self, identity: str) -> None:
        """Take a saved view away.

        Raises:
            KeyError: there is no such saved view.
        """
        section, _ = self._saved.pop(identity)
        remove_section(ensure_section(self._document, _MANAGER, _VIEWS), _SAVED, section)

    def _remember(self, section: Section, entry: ViewEntry) -> str:
        self._count += 1
        identity = f"view-{self._count}"
        self._saved[identity] = (section, entry)
        return identity


def _unheard(diagnostic: Diagnostic) -> None:
    """A report that is ignored: what was just written is valid."""
