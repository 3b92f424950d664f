"""How trouble with the network is told: one finding with its code, and what it means for the process."""

from __future__ import annotations

from linkwright.diagnostics import LinkwrightError, render
from linkwright.graph.log.logger import Logger


def tell(logger: Logger, error: LinkwrightError) -> None:
    """Log why a domain is not joined."""
    findings = "\n".join(render(each) for each in error.diagnostics)
    logger.error(f"{findings}\nThis process goes on by itself: nobody outside sees its nodes.")
