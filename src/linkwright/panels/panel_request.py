"""The request of a program such as ``rqt_plot`` to open a panel of the page."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class PanelRequest:
    """A panel to open, and its settings.

    Attributes:
        panel: the name of the panel in the page, see `linkwright.page.protocol.requested_panels.RequestedPanelName`.
        display_class: the class of the display that the panel needs; empty if it needs none.
        topic: the topic of the display, or of the velocities that the Teleop panel publishes; empty if not given.
        fields: the fields to plot, such as ``/odom/twist/twist/linear/x``.
        node: the node whose parameters are shown; empty if not given.
        stamped: whether the velocities have a stamp; None if not given.
        linear: the maximum linear velocity, m/s; None if not given.
        angular: the maximum angular velocity, rad/s; None if not given.
    """

    panel: str
    display_class: str = ""
    topic: str = ""
    fields: tuple[str, ...] = ()
    node: str = ""
    stamped: bool | None = None
    linear: float | None = None
    angular: float | None = None
