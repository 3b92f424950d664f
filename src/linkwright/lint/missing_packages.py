"""The severity of missing packages: a declared dependency is only missing on this machine."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.diagnostics.phrase import as_phrase
from linkwright.lint.package import PackageContext, find_package
from linkwright.packages.manifest import MANIFEST

_MISSING_PACKAGE_CODE = "PKG101"


def with_package_severity(diagnostics: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield the diagnostics, with missing packages that are declared dependencies as warnings.

    Either the package that uses the missing package or a neighboring package must declare the dependency.
    """
    packages: dict[Path, PackageContext | None] = {}
    for diagnostic in diagnostics:
        if diagnostic.code != _MISSING_PACKAGE_CODE or diagnostic.span is None:
            yield diagnostic
            continue
        folder = Path(diagnostic.span.file).parent
        if folder not in packages:
            packages[folder] = find_package(folder)
        package = packages[folder]
        name = str(as_phrase(diagnostic.message).arguments.get("name", ""))
        if package is None or not is_declared(package, name):
            yield diagnostic
            continue
        hint = phrase(
            "install '{name}', or check it together with this package; the parts that need it are left out", name=name
        )
        yield diagnostic.with_changes(severity=Severity.WARNING, hint=hint)


def is_missing_here(diagnostic: Diagnostic) -> bool:
    """Return whether a finding is about a declared dependency that this computer lacks."""
    return diagnostic.code == _MISSING_PACKAGE_CODE and diagnostic.severity is Severity.WARNING


def is_declared(package: PackageContext, name: str) -> bool:
    """Return whether a package or a neighbor in its workspace declares a dependency."""
    neighbors = (PackageContext(manifest.parent) for manifest in sorted(package.folder.parent.glob(f"*/{MANIFEST}")))
    manifests = (package_context.manifest for package_context in (package, *neighbors))
    return any(manifest is not None and manifest.declares(name) for manifest in manifests)
