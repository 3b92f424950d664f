"""Rules about the parameter files that launch files give to nodes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from linkwright.diagnostics import Diagnostic, phrase, quoted_names
from linkwright.lint.given_parameter_files import GivenFile, find_given_files, read_sections
from linkwright.lint.rules.package_manifest import PackageRule
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.lint.package import PackageContext


class ParameterFileOfAnotherNode(PackageRule):
    """A launch file gives a node a parameter file that has no section for this node.

    ## Why

    The node ignores all values of the file without a message, and starts with its defaults. Only nodes with a constant
    name are reported, and only if the file has no section for all nodes (`/**`) and none for another node to which the
    package gives the file. Programs that contain several nodes, such as a component container, are not reported.

    ## Example

    ```python
    Node(package='my_robot', executable='driver', name='arm_driver',
         parameters=[os.path.join(get_package_share_directory('my_robot'), 'config', 'driver.yaml')])
    ```

    with this `config/driver.yaml`:

    ```yaml
    driver:
      ros__parameters:
        rate: 50
    ```

    ## Use instead

    ```yaml
    arm_driver:
      ros__parameters:
        rate: 50
    ```
    """

    code = "LW850"
    name = "parameter-file-of-another-node"

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding for each node of a package whose parameter file has no section for it."""
        groups: dict[Path, list[GivenFile]] = {}
        for given in find_given_files(package):
            groups.setdefault(given.file, []).append(given)
        for file, nodes in groups.items():
            names = [given.node for given in nodes if given.node is not None]
            sections = read_sections(file) if len(names) == len(nodes) else None
            if sections is None or not set(names).isdisjoint(sections):
                continue
            for given in nodes:
                message = phrase(
                    "'{file}' has no section for the node '{name}', only for {names}",
                    file=file.relative_to(package.folder).as_posix(),
                    name=given.node,
                    names=quoted_names(sorted(set(sections))),
                )
                hint = phrase("rename the section to '{name}', or use '/**' for any node", name=given.node)
                yield self.report(message, span=given.span, source=given.source, hint=hint)
