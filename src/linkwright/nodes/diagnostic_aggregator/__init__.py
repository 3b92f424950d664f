"""The node of ``diagnostic_aggregator``, which sorts diagnostics into groups."""
