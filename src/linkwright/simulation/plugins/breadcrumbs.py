"""Models that a model deploys where it is: ``gz-sim-breadcrumbs-system``.

Source: gz-sim (parameters, defaults, topics, names of the deployed models). The dynamics of deployed models remain
enabled, and deployed models are not performers.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from linkwright.diagnostics import LinkwrightError, has_errors, phrase
from linkwright.geometry.single import compose
from linkwright.messages import get_message
from linkwright.sdf.frames import transform_of
from linkwright.sdf.includes import resolve_includes
from linkwright.sdf.models import Model
from linkwright.sdf.reader import read_element
from linkwright.sdf.report import SdfReport
from linkwright.sdf.worlds import SDF, Sdf
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_COUNT_TYPE = "std_msgs/msg/Int32"


@dataclass(frozen=True, kw_only=True)
class BreadcrumbsParameters:
    """Parameters of ``gz-sim-breadcrumbs-system``; a negative number of deployments sets no limit."""

    topic: str = ""
    max_deployments: int = -1
    allow_renaming: bool = False


class GzBreadcrumbs(SimulatedPlugin[BreadcrumbsParameters]):
    """The substitute for ``gz-sim-breadcrumbs-system``.

    Each ``std_msgs/msg/Empty`` on the topic adds a model at the pose of the plugin's model.
    """

    PARAMETERS = BreadcrumbsParameters
    IGNORED = ("breadcrumb", "disable_physics_time", "performer_volume", "topic_statistics")
    CARRIED = ("_count",)

    def start(self) -> None:
        """Read the model to deploy, and create the topics.

        Raises:
            LinkwrightError: SIM160, the plugin has no valid model.
        """
        self._count = 0
        parameters, node = self.parameters, self.node
        if parameters.max_deployments == 0:
            return
        self._breadcrumb = self._read_model()
        topic = parameters.topic or f"/model/{self.context.path}/breadcrumbs/{self._breadcrumb.name}/deploy"
        self._remaining = node.publisher(_COUNT_TYPE, f"{topic}/remaining")
        node.subscribe("std_msgs/msg/Empty", topic, self._deploy)

    def _read_model(self) -> Model:
        """Return the model in ``<breadcrumb><sdf>``, with its includes resolved."""
        element = self.context.element
        parent = None if element is None else element.first("breadcrumb")
        root = None if parent is None else parent.first("sdf")
        report = SdfReport()
        sdf: Sdf | None = None if root is None else read_element(root, SDF, report)
        if sdf is not None:
            included = resolve_includes(sdf, Path.cwd() / self.context.name, self.simulation.finder)
            findings = (*report.in_order(), *included.diagnostics)
            if included.sdf.models:
                return included.sdf.models[0]
            if has_errors(findings):
                raise LinkwrightError(*findings)
        message = phrase("plugin '{plugin}': <breadcrumb> needs an <sdf> with a <model>", plugin=self.context.name)
        raise self.parameter_error(message, parent)

    def _deploy(self, _: Any) -> None:
        """Add a model, unless the limit is reached or the name is in use."""
        limit = self.parameters.max_deployments
        if limit < 0 or self._count < limit:
            name = f"{self._breadcrumb.name}_{self._count}"
            models = self.simulation.scene.models
            if name in models:
                if not self.parameters.allow_renaming:
                    message = phrase(
                        "plugin '{plugin}': nothing is deployed, because a model '{name}' exists and <allow_renaming> "
                        "is false",
                        plugin=self.context.name,
                        name=name,
                    )
                    self.node.logger.warning(message)
                    return
                number = 1
                while f"{name}_{number}" in models:
                    number += 1
                name = f"{name}_{number}"
            pose = compose(self.simulation.model_pose(self.context.path), transform_of(self._breadcrumb.pose.pose))
            self.spawn(replace(self._breadcrumb, name=name), name, pose)
            self._count += 1
        self._remaining.publish(get_message(_COUNT_TYPE)(data=limit - self._count))
