"""Diagnostics of nodes on ``/diagnostics`` (API of ``diagnostic_updater``)."""
